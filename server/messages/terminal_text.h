// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace server {

enum class LineEnds { kEscaped, kKept };

/// Text of users as a terminal may show it. Control characters of ASCII and of Unicode, among them those that
/// end a line or turn the direction of writing, appear as \xNN or \u{NNNN}, and bytes that are no UTF-8 as
/// \xNN: no name can forge a row or tell the terminal to do something. Letters of all scripts stay.
/// @param line_ends  kKept: line feeds and tabs stay, too
[[nodiscard]] std::string terminal_text(std::string_view text, LineEnds line_ends = LineEnds::kEscaped);

}  // namespace server
