// SPDX-License-Identifier: Apache-2.0
#include "jobs/parameters/parameter_value.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace jobs {
namespace {

std::string allowed_text(std::string_view noun, const Range& range, std::string_view unit) {
  std::string text = "must be " + std::string(noun) + " " + range.text();
  if (!unit.empty()) text.append(" ").append(unit);
  return text;
}

bool is_whole(const nlohmann::json& value) {
  return value.is_number_integer() ||
         (value.is_number_float() && std::trunc(value.get<double>()) == value.get<double>());
}

std::string describe_choice_fault(const ParameterInfo& info, const nlohmann::json& value) {
  if (value.is_string() && std::find(info.choices.begin(), info.choices.end(),
                                     value.get_ref<const std::string&>()) != info.choices.end())
    return "";
  std::string text = "must be ";
  for (std::size_t i = 0; i < info.choices.size(); ++i) {
    if (i > 0) text += i + 1 == info.choices.size() ? " or " : ", ";
    text.append("\"").append(info.choices[i]).append("\"");
  }
  return text;
}

/// Levenshtein's distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

/// Edit distance of a key from a known one; empty if too far to be a slip of the pen. A key that is right but
/// for its unit ("clearance") is as near as can be.
std::optional<std::size_t> key_distance(std::string_view given, std::string_view known) {
  if (!given.empty() && known.size() > given.size() && known.starts_with(given) && known[given.size()] == '_')
    return 0;
  const std::size_t furthest = std::max<std::size_t>(1, known.size() / 4);
  // The difference of the lengths is a lower bound, and costs nothing.
  if (given.size() > known.size() + furthest || known.size() > given.size() + furthest) return std::nullopt;
  const std::size_t distance = edit_distance(given, known);
  return distance <= furthest ? std::optional(distance) : std::nullopt;
}

}  // namespace

std::string describe_number_fault(const Range& range, std::string_view unit, const nlohmann::json& value) {
  if (value.is_number() && range.contains(value.get<double>())) return "";
  return allowed_text("a number", range, unit);
}

std::string describe_integer_fault(const Range& range, const nlohmann::json& value) {
  if (value.is_number() && is_whole(value) && range.contains(value.get<double>())) return "";
  return allowed_text("an integer", range, "");
}

std::string describe_fault(const ParameterInfo& info, const nlohmann::json& value) {
  switch (info.kind) {
    case ParameterKind::kNumber: return describe_number_fault(info.range, info.unit, value);
    case ParameterKind::kInteger: return describe_integer_fault(info.range, value);
    case ParameterKind::kChoice: return describe_choice_fault(info, value);
  }
  return "";
}

nlohmann::json canonical_value(const ParameterInfo& info, const nlohmann::json& value) {
  switch (info.kind) {
    case ParameterKind::kNumber: return value.get<double>() + 0.0;  // -0 + 0 is +0
    case ParameterKind::kInteger: return value.get<int>();
    case ParameterKind::kChoice: return value;
  }
  return nullptr;
}

std::string describe_unknown_key(std::string_view key, std::span<const std::string_view> known,
                                 std::string_view listed) {
  constexpr std::size_t kFew = 12;  // that a user reads through, if they are listed elsewhere
  std::string_view nearest;
  std::optional<std::size_t> least;
  for (const std::string_view candidate : known) {
    const auto distance = key_distance(key, candidate);
    if (!distance || (least && *distance >= *least)) continue;
    least = distance;
    nearest = candidate;
  }
  if (least) return "unknown key; did you mean " + std::string(nearest) + "?";
  if (known.size() > kFew && !listed.empty()) return "unknown key; all are listed at " + std::string(listed);
  std::string text = "unknown key; allowed:";
  for (std::size_t i = 0; i < known.size(); ++i) text.append(i == 0 ? " " : ", ").append(known[i]);
  return text;
}

std::string pointer_token(std::string_view key) {
  std::string token = "/";
  for (const char c : key) {
    if (c == '~') token += "~0";
    else if (c == '/') token += "~1";
    else token += c;
  }
  return token;
}

}  // namespace jobs
