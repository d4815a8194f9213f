// SPDX-License-Identifier: Apache-2.0
#include "server/commands/validate.h"

#include <unistd.h>

#include <filesystem>

#include "server/commands/command.h"

namespace server::commands {

void run_validate(const std::vector<std::string>& arguments) {
  const std::string program =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "rpsup-validate";
  std::vector<const char*> argv{program.c_str()};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  argv.push_back(nullptr);
  execv(program.c_str(), const_cast<char* const*>(argv.data()));
  throw BadInput(program +
                 " is not there: packages bring it, and script/build release rpsup-validate builds it");
}

}  // namespace server::commands
