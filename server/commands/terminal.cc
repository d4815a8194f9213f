// SPDX-License-Identifier: Apache-2.0
#include "server/commands/terminal.h"

#include <string_view>

#include <sys/ioctl.h>
#include <unistd.h>

namespace server::commands {

TerminalSize terminal_size() {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) return {};
  return {.columns = size.ws_col, .rows = size.ws_row};
}

std::string clipped(const std::string& line, std::size_t columns) {
  constexpr std::string_view kCut = "...";
  if (line.size() <= columns) return line;
  std::size_t end = columns > kCut.size() ? columns - kCut.size() : 0;
  while (end > 0 && (static_cast<unsigned char>(line[end]) & 0xc0U) == 0x80U) --end;  // within a character
  return line.substr(0, end) + std::string(kCut.substr(0, columns));
}

}  // namespace server::commands
