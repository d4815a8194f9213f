// SPDX-License-Identifier: Apache-2.0
#include "server/commands/numerics.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "engine/dynamics/dynamics_kernel.h"
#include "jobs/base/provenance.h"

namespace server::commands {

void add_numerics_option(CLI::App& command, std::string& numerics) {
  command
      .add_option("--numerics", numerics,
                  "Mathematical functions. native: those that suit this processor best; portable: those that "
                  "every x86-64 processor has, so that results are the same bytes on all of them")
      ->check(CLI::IsMember({"native", "portable"}))
      ->capture_default_str()
      ->envname("RPSUP_NUMERICS");
}

void check_processor() {
  if (!engine::instruction_sets().empty()) return;
  throw std::runtime_error(
      "this program was built for the processor of another machine, whose instructions this one does not "
      "have; build it here, or there with script/build, which serves every x86-64");
}

void enter_numerics(const std::string& numerics, char** arguments) {
  if (numerics != "portable" || jobs::has_portable_numerics()) return;
  // The C library looks at this once, before main().
  ::setenv("GLIBC_TUNABLES", jobs::portable_tunables().c_str(), 1);
  ::execv("/proc/self/exe", arguments);
  throw std::runtime_error(std::string("the program cannot start itself again with portable numerics: ") +
                           std::strerror(errno));
}

}  // namespace server::commands
