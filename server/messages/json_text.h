// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace server {

/// Text that is no JSON, or JSON that no request of ours looks like.
class BadJson : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Levels of nesting that are read: copying and writing a value recurses, so depth is stack.
inline constexpr std::size_t kMaxJsonDepth = 32;
/// Keys of one object that are read: an object that keeps its order is searched from its front.
inline constexpr std::size_t kMaxObjectKeys = 1024;
/// Values of a request that are read: each takes some 50 bytes, however short its text.
inline constexpr std::size_t kMaxJsonValues = 500'000;

/// Reads JSON text, keeping the order of keys (the axes of a sweep multiply in the order in which they are
/// given). NaN and Infinity, which are no JSON but which many programs write, are read as null.
/// @throws BadJson with the position in bytes for text that is no JSON; also for a number that no double
/// holds,
///         a key that an object has twice, more than kMaxJsonDepth levels, more than kMaxObjectKeys keys in
///         an object, more than most_values values.
[[nodiscard]] nlohmann::ordered_json parse_json(std::string_view text,
                                                std::size_t most_values = kMaxJsonValues);

/// JSON text of a value; bytes that are no UTF-8 become U+FFFD.
template <typename Json>
[[nodiscard]] std::string to_text(const Json& value, int indent = -1) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace server
