// SPDX-License-Identifier: Apache-2.0
#include "jobs/base/flat_json.h"

#include <charconv>
#include <cstdint>
#include <string>

namespace jobs {
namespace {

bool is_plain(char c) {
  return static_cast<unsigned char>(c) >= ' ' && static_cast<unsigned char>(c) < 0x80 && c != '\\';
}

template <typename T>
std::optional<nlohmann::json> read_as(std::string_view digits) {
  T value{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return nlohmann::json(value);
}

/// Leading zeros are no JSON, and what nlohmann::json writes starts and ends its numbers with a digit.
/// @param digits  digits, signs, '.' and 'e' alone
bool is_plain_number(std::string_view digits) {
  const std::string_view unsigned_digits = digits.starts_with('-') ? digits.substr(1) : digits;
  if (unsigned_digits.empty() || unsigned_digits.back() < '0' || unsigned_digits.front() < '0') return false;
  const bool has_leading_zero =
      unsigned_digits.size() > 1 && unsigned_digits[0] == '0' && unsigned_digits[1] >= '0';
  return !has_leading_zero;
}

}  // namespace

bool FlatJson::take(char c) {
  if (rest_.empty() || rest_.front() != c) return false;
  rest_.remove_prefix(1);
  return true;
}

bool FlatJson::take_word(std::string_view word) {
  if (!rest_.starts_with(word)) return false;
  rest_.remove_prefix(word.size());
  return true;
}

bool FlatJson::take_separator() {
  const bool there = first_ || take(',');
  first_ = false;
  return there;
}

std::optional<std::string_view> FlatJson::string() {
  if (!take('"')) return std::nullopt;
  std::size_t size = 0;
  while (size < rest_.size() && rest_[size] != '"' && is_plain(rest_[size])) ++size;
  const std::string_view text = rest_.substr(0, size);
  rest_.remove_prefix(size);
  return take('"') ? std::optional(text) : std::nullopt;
}

std::optional<nlohmann::json> FlatJson::number() {
  std::size_t size = 0;
  bool integer = true;
  for (; size < rest_.size() && rest_[size] != ',' && rest_[size] != '}' && rest_[size] != ']'; ++size) {
    const char c = rest_[size];
    if (c == '.' || c == 'e') integer = false;
    else if (c != '-' && c != '+' && (c < '0' || c > '9')) return std::nullopt;
  }
  const std::string_view digits = rest_.substr(0, size);
  if (!is_plain_number(digits)) return std::nullopt;
  auto value = !integer                  ? read_as<double>(digits)
               : digits.starts_with('-') ? read_as<std::int64_t>(digits)
                                         : read_as<std::uint64_t>(digits);
  if (value) rest_.remove_prefix(size);
  return value;
}

bool FlatJson::next_key(std::string_view& key) {
  if (rest_.starts_with('}') || !take_separator()) return false;
  const auto text = string();
  const bool there = text && take(':');
  if (there) key = *text;
  else rest_ = {};  // so that close() does not take it for an end
  return there;
}

std::optional<nlohmann::json> FlatJson::value() {
  if (rest_.starts_with('"')) {
    const auto text = string();
    return text ? std::optional<nlohmann::json>(std::string(*text)) : std::nullopt;
  }
  if (take_word("null")) return nlohmann::json();
  if (take_word("true")) return nlohmann::json(true);
  if (take_word("false")) return nlohmann::json(false);
  return number();
}

bool FlatJson::next_value(nlohmann::json& value) {
  if (rest_.starts_with(']') || !take_separator()) return false;
  auto read = this->value();
  if (read) value = std::move(*read);
  else rest_ = {};
  return read.has_value();
}

}  // namespace jobs
