// SPDX-License-Identifier: Apache-2.0
#include "server/messages/identifiers.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string_view>

#include "server/messages/problem.h"

namespace server {

bool is_alphanumeric_or(unsigned char c, std::string_view signs) {
  return (c < 0x80 && std::isalnum(c) != 0) || signs.find(static_cast<char>(c)) != std::string_view::npos;
}

bool is_id(const std::string& text) {
  return !text.empty() && text.size() <= 64 &&
         std::ranges::all_of(text, [](unsigned char c) { return is_alphanumeric_or(c, "-_"); });
}

std::string find_idempotency_key(const Request& request) {
  constexpr std::size_t kLongest = 255;
  if (!request.idempotency_key) return "";
  std::string_view key = *request.idempotency_key;
  if (key.size() > 2 && key.front() == '"' && key.back() == '"') key = key.substr(1, key.size() - 2);
  const bool visible = std::all_of(key.begin(), key.end(), [](char c) { return c > ' ' && c < '\x7f'; });
  if (key.empty() || key.size() > kLongest || !visible) {
    throw HttpError(400,
                    "Idempotency-Key must be 1 to " + std::to_string(kLongest) + " visible ASCII characters");
  }
  return std::string(key);
}

}  // namespace server
