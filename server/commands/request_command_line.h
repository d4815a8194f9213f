// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/commands/remote_command_line.h"

namespace server::commands {

/// The commands that compute a request, with a store or by a running service: sweep, search, wear, optimise,
/// fit.
/// @param argv  of the program, for what stands on the command line itself
[[nodiscard]] std::vector<Command> add_request_commands(CLI::App& app, char** argv);

}  // namespace server::commands
