// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace server::commands {

/// Makes the log go to standard error, since standard output holds the one line that scripts read.
/// A message is one line of it, whatever text of a user it holds: see escape_for_log().
/// @param level  "debug", "info", "warning" or "error"
void start_log(const std::string& level);

/// The text with every byte that is no visible ASCII character or blank as \xNN: no line can be made up, and
/// no terminal can be told to do something, by a name or a path.
[[nodiscard]] std::string escape_for_log(std::string_view text);

}  // namespace server::commands
