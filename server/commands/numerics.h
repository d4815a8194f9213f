// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace server::commands {

/// Declares --numerics to the parser.
void add_numerics_option(CLI::App& command, std::string& numerics);

/// @throws std::runtime_error if this program was compiled for processors that have more than this one
/// (script/build --own)
void check_processor();

/// Starts this program again, with the same arguments, if it is to compute with other numerics than it was
/// started with. Returns if all is well.
/// @throws std::runtime_error
void enter_numerics(const std::string& numerics, char** arguments);

}  // namespace server::commands
