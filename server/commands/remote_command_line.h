// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace server::commands {

/// A command of the program: how it is written, and what it does.
struct Command {
  CLI::App* line;
  std::function<int()> run;  ///< returns an exit code
};

struct RemoteOptions;

/// Adds --url, --token-file and --token.
void add_remote_options(CLI::App& command, RemoteOptions& options);

/// The commands that speak to a running service: submit, measure, and those of kIdCommands.
[[nodiscard]] std::vector<Command> add_remote_commands(CLI::App& app);

}  // namespace server::commands
