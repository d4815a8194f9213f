// SPDX-License-Identifier: Apache-2.0
#include "jobs/parameters/parameter_value.h"

#include <algorithm>
#include <cmath>

#include "jobs/parameters/nearest_name.h"

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
  if (const auto nearest = find_nearest_name(key, known))
    return "unknown key; did you mean " + std::string(*nearest) + "?";
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
