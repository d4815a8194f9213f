// SPDX-License-Identifier: Apache-2.0
#include "server/messages/terminal_text.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <utility>

namespace server {

namespace {

/// Code point at the beginning of a text.
struct CodePoint {
  std::uint32_t value = 0;
  std::size_t bytes = 0;  ///< 0: the text begins with no UTF-8
};

/// The Unicode Standard, table 3-7: no overlong form, no surrogate, nothing above U+10FFFF.
CodePoint first_code_point(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return {byte(0), 1};
  if (byte(0) < 0xc2 || byte(0) > 0xf4) return {};
  const std::size_t bytes = byte(0) < 0xe0 ? 2 : byte(0) < 0xf0 ? 3 : 4;
  if (text.size() < bytes) return {};
  std::uint32_t value = byte(0) & (0x7fU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return {};
    value = value << 6U | (byte(i) & 0x3fU);
  }
  constexpr std::array<std::uint32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = value >= 0xd800 && value <= 0xdfff;
  if (value < kLeast[bytes] || value > 0x10ffff || surrogate) return {};
  return {value, bytes};
}

/// @returns whether a terminal obeys a character, or shows a text with it as another one: general categories
/// Cc, Cf, Zl and Zp, save what is needed within words (U+200C, U+200D and the marks of some scripts)
bool is_control(std::uint32_t value) {
  constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 13> kRanges{
      {{0x00, 0x1f}, {0x7f, 0x9f}, {0xad, 0xad}, {0x61c, 0x61c}, {0x180e, 0x180e}, {0x200b, 0x200b},
       {0x200e, 0x200f}, {0x2028, 0x202e}, {0x2060, 0x206f}, {0xfeff, 0xfeff}, {0xfff9, 0xfffb},
       {0x1d173, 0x1d17a}, {0xe0000, 0xe007f}}};
  return std::ranges::any_of(
      kRanges, [&](const auto& range) { return value >= range.first && value <= range.second; });
}

/// "\x1b" of a byte that is ASCII or no UTF-8, "\u{202e}" of another character.
std::string escape_code_point(const CodePoint& point, char first) {
  std::array<char, 16> escaped{};
  const bool one_byte = point.bytes <= 1;
  const std::uint32_t value = one_byte ? static_cast<unsigned char>(first) : point.value;
  std::snprintf(escaped.data(), escaped.size(), one_byte ? "\\x%02x" : "\\u{%04x}", value);
  return escaped.data();
}

}  // namespace

std::string terminal_text(std::string_view text, LineEnds line_ends) {
  std::string shown;
  while (!text.empty()) {
    const CodePoint point = first_code_point(text);
    const std::size_t bytes = std::max<std::size_t>(point.bytes, 1);
    const bool kept = line_ends == LineEnds::kKept && (text[0] == '\n' || text[0] == '\t');
    const bool is_shown = point.bytes > 0 && (kept || !is_control(point.value));
    shown += is_shown ? std::string(text.substr(0, bytes)) : escape_code_point(point, text[0]);
    text.remove_prefix(bytes);
  }
  return shown;
}

}  // namespace server
