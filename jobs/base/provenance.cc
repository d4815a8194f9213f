// SPDX-License-Identifier: Apache-2.0
#include "jobs/base/provenance.h"

#include <cstdlib>

#include <gnu/libc-version.h>

#include "jobs/base/machine.h"
#include "jobs/base/program_info.h"

namespace jobs {
namespace {

/// By these the library would choose other variants than those of baseline x86-64.
constexpr const char* kPortable = "glibc.cpu.hwcaps=-AVX2_Usable,-AVX2,-FMA_Usable,-FMA,-FMA4_Usable,-FMA4";

std::string given_tunables() {
  const char* const given = std::getenv("GLIBC_TUNABLES");
  return given == nullptr ? "" : given;
}

}  // namespace

std::string portable_tunables() {
  const std::string given = given_tunables();
  if (given.find(kPortable) != std::string::npos) return given;
  return given.empty() ? kPortable : given + ":" + kPortable;  // of two settings the last one counts
}

bool has_portable_numerics() {
  static const bool portable = given_tunables().find(kPortable) != std::string::npos;
  return portable;
}

const std::string& engine_version() {
  static const std::string version =
      std::string(kEngineVersion) + (has_portable_numerics() ? "-portable" : "");
  return version;
}

const Provenance& own_provenance() {
  static const Provenance own{.host = host_name(),
                              .cpu = cpu_name(),
                              .libm = std::string("glibc ") + ::gnu_get_libc_version(),
                              .numerics = has_portable_numerics() ? "portable" : "native",
                              .version = std::string(kProgramVersion),
                              .commit = std::string(kProgramCommit),
                              .compiler = std::string(kProgramCompiler),
                              .engine = engine_version()};
  return own;
}

}  // namespace jobs
