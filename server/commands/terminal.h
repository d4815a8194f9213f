// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace server::commands {

struct TerminalSize {
  std::size_t columns = 80, rows = 24;
};

/// Size of the terminal at standard error; a usual one if there is none.
[[nodiscard]] TerminalSize terminal_size();

/// The beginning of a line that fits into a terminal, with "..." where it is cut; no part of a character.
[[nodiscard]] std::string clipped(const std::string& line, std::size_t columns);

}  // namespace server::commands
