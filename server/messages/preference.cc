// SPDX-License-Identifier: Apache-2.0
#include "server/messages/preference.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "server/messages/trimmed.h"

namespace server {

namespace {

constexpr std::chrono::seconds kLongest{60};

/// @returns whether an item is the preference `wait`; names of preferences ignore case (RFC 7240)
bool names_wait(std::string_view item) {
  return std::ranges::equal(item.substr(0, 4), std::string_view("wait"),
                            [](unsigned char a, unsigned char b) { return std::tolower(a) == b; });
}

}  // namespace

std::optional<std::chrono::seconds> find_wait(std::string_view prefer) {
  while (!prefer.empty()) {
    const auto comma = std::min(prefer.find(','), prefer.size());
    std::string_view item = trimmed(prefer.substr(0, comma));
    prefer.remove_prefix(std::min(comma + 1, prefer.size()));
    if (!names_wait(item)) continue;
    item = trimmed(item.substr(4));
    if (!item.starts_with('=')) continue;
    item = trimmed(item.substr(1));
    unsigned seconds = 0;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), seconds);
    if (error == std::errc{} && end == item.data() + item.size())
      return std::min(kLongest, std::chrono::seconds(seconds));
  }
  return std::nullopt;
}

}  // namespace server
