// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace server::commands {

/// The program: parses its command line, the environment and the configuration file, and runs the command.
/// @param argv  the value of --token is overwritten
/// @returns exit code of the program
int run_command_line(int argc, char** argv);

}  // namespace server::commands
