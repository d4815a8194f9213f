// SPDX-License-Identifier: Apache-2.0
#include "server/messages/query.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "server/messages/json_text.h"

namespace server {

namespace {

std::string joined(std::span<const std::string_view> words) {
  std::string text;
  for (const auto word : words) text += (text.empty() ? "" : ", ") + std::string(word);
  return text.empty() ? "none" : text;
}

template <typename Number>
std::optional<Number> whole_text_as(const std::string& text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

}  // namespace

Query::Query(const Request& request, std::initializer_list<std::string_view> allowed)
    : Query(request, allowed, Others::kRefused) {}

Query::Query(const Request& request, std::initializer_list<std::string_view> allowed, Others others)
    : request_(request) {
  std::set<std::string_view> seen;
  for (const auto& [key, value] : request.query) {
    const bool known = std::find(allowed.begin(), allowed.end(), key) != allowed.end();
    if (!known && others == Others::kRefused) {
      add_fault(key, "unknown query parameter; allowed: " + joined({allowed.begin(), allowed.size()}));
    } else if (!seen.insert(key).second) {
      add_fault(key, "given more than once");
    } else if (!known) {
      others_.emplace_back(key, value);
    }
  }
}

std::optional<std::string> Query::text(std::string_view key) const {
  for (const auto& [name, value] : request_.query) {
    if (name == key) return value;
  }
  return std::nullopt;
}

std::vector<std::string> Query::list(std::string_view key) const {
  const auto value = text(key);
  if (!value) return {};
  std::vector<std::string> items;
  std::size_t start = 0;
  for (;;) {
    const std::size_t comma = value->find(',', start);
    items.push_back(value->substr(start, comma == std::string::npos ? comma : comma - start));
    if (comma == std::string::npos) return items;
    start = comma + 1;
  }
}

std::string Query::names(std::string_view key) {
  const auto value = text(key);
  if (value && value->empty()) add_fault(key, "must be a list of names separated by commas");
  return value.value_or("");
}

nlohmann::ordered_json Query::object(std::string_view key) {
  const auto value = text(key);
  if (!value) return nlohmann::ordered_json::object();
  try {
    nlohmann::ordered_json object = parse_json(*value);
    if (object.is_object()) return object;
    add_fault(key, "must be an object in JSON");
  } catch (const BadJson& bad) {
    add_fault(key, std::string("must be an object in JSON: ") + bad.what());
  }
  return nlohmann::ordered_json::object();
}

std::optional<double> Query::number(std::string_view key) {
  const auto value = text(key);
  if (!value) return std::nullopt;
  const auto result = whole_text_as<double>(*value);
  if (result && std::isfinite(*result)) return result;
  add_fault(key, "must be a number");
  return std::nullopt;
}

std::optional<double> Query::number_in(std::string_view key, const jobs::Range& range) {
  const auto result = number(key);
  if (result && !range.contains(*result)) add_fault(key, "must be a number " + range.text());
  return result && range.contains(*result) ? result : std::nullopt;
}

std::optional<std::size_t> Query::count(std::string_view key) {
  const auto value = text(key);
  if (!value) return std::nullopt;
  const auto result = whole_text_as<std::size_t>(*value);
  if (!result) add_fault(key, "must be a whole number, not negative");
  return result;
}

std::optional<std::size_t> Query::count_in(std::string_view key, const jobs::Range& range) {
  const auto result = count(key);
  if (!result || range.contains(static_cast<double>(*result))) return result;
  add_fault(key, "must be a whole number " + range.text());
  return std::nullopt;
}

std::optional<std::string> Query::word(std::string_view key, std::span<const std::string_view> words) {
  auto value = text(key);
  if (!value || std::find(words.begin(), words.end(), *value) != words.end()) return value;
  add_fault(key, "must be one of: " + joined(words));
  return std::nullopt;
}

void Query::check() const {
  if (!faults_.empty()) throw jobs::InvalidRequest(faults_);
}

void Query::add_fault(std::string_view key, const std::string& detail) {
  faults_.push_back({"/" + std::string(key), detail});
}

}  // namespace server
