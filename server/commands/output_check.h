// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace server::commands {

/// Refuses a command that would write over a file which it reads, or over the store: an output that is the
/// same file as an input, by device and inode, through symbolic and hard links, or the same name where there
/// is no file yet. Standard output and standard error count as outputs, standard input as an input.
/// @param program  parsed; holds --config
/// @param command  command that was parsed
/// @throws BadInput naming both
void check_outputs(const CLI::App& program, const CLI::App& command);

}  // namespace server::commands
