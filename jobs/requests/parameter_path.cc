// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/parameter_path.h"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "jobs/linkages/linkage_fields.h"
#include "jobs/linkages/linkage_json.h"
#include "jobs/parameters/link_parameters.h"
#include "jobs/parameters/parameter_table.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/parameters/rpsup_drives.h"
#include "jobs/parameters/wear_depth.h"

namespace jobs {
namespace {

std::vector<std::string> make_known_paths() {
  std::vector<std::string> paths;
  for (const ParameterInfo& info : parameter_table()) paths.emplace_back(info.key);
  for (const std::string_view link : kLinkNames) {
    for (const std::string_view part : {kMassKey, kInertiaKey})
      paths.push_back("links." + std::string(link) + "." + std::string(part));
  }
  return paths;
}

/// The member or element of that name; null if there is none. Of a list only indices that it has are known:
/// JSON pointers would make others.
const nlohmann::json* find_part(const nlohmann::json& whole, const std::string& part) {
  if (whole.is_object()) {
    const auto found = whole.find(part);
    return found == whole.end() ? nullptr : &*found;
  }
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  const bool is_index =
      error == std::errc() && std::to_string(index) == part && whole.is_array() && index < whole.size();
  return is_index ? &whole[index] : nullptr;
}

/// Value at a path; null if there is none.
const nlohmann::json* find_at(const nlohmann::json& parameters, std::string_view path) {
  const nlohmann::json* found = &parameters;
  for (const std::string& part : parts_of_path(path)) {
    found = find_part(*found, part);
    if (found == nullptr) break;
  }
  return found;
}

}  // namespace

const std::vector<std::string>& known_paths() {
  static const std::vector<std::string> paths = make_known_paths();
  return paths;
}

bool is_varied_by_cases(std::string_view key) {
  return key == kLinkageKey || key == kWearKey || find_rpsup_drive(key) != nullptr;
}

std::vector<std::string> paths_of(const nlohmann::ordered_json& parameters) {
  std::vector<std::string> paths;
  for (const auto& [key, value] : parameters.items()) {
    if (find_parameter(key) != nullptr || is_varied_by_cases(key) || is_path_in_description(key))
      paths.push_back(key);
    if (key != "links" || !value.is_object()) continue;
    for (const auto& [link, parts] : value.items()) {
      if (std::ranges::find(kLinkNames, link) == kLinkNames.end() || !parts.is_object()) continue;
      for (const auto& [part, ignored] : parts.items()) {
        if (part == kMassKey || part == kInertiaKey) paths.push_back(key + "." + link + "." + part);
      }
    }
  }
  return paths;
}

bool is_path_in_description(std::string_view path) {
  const std::string_view key = path.substr(0, path.find('.'));
  return key.size() < path.size() && (key == kLinkageKey || find_rpsup_drive(key) != nullptr);
}

std::optional<Range> find_whole_range(std::string_view path) {
  const bool is_inside = is_path_in_description(path);
  const std::string_view key = is_inside ? path.substr(path.rfind('.') + 1) : path;
  if (const ParameterInfo* const info = find_parameter(key))
    return info->kind == ParameterKind::kInteger ? std::optional(info->range) : std::nullopt;
  const auto field = std::ranges::find(beam_fields(), key, &LinkageField::key);
  if (!is_inside || field == beam_fields().end() || field->kind != FieldKind::kInteger) return std::nullopt;
  return field->range;
}

std::string describe_description_path_fault(const nlohmann::json& parameters, std::string_view path) {
  if (const auto* const value = find_at(parameters, path))
    return value->is_number() ? "" : "is no number of the description";
  // A value that is left out has a default, and may be swept as well.
  const auto* const around = find_at(parameters, path.substr(0, path.rfind('.')));
  return around != nullptr && around->is_object() ? ""
                                                  : "there is no such place in a description that is given";
}

std::string pointer_of_path(std::string_view path) {
  std::string pointer;
  for (const std::string& part : parts_of_path(path)) pointer += pointer_token(part);
  return pointer;
}

std::string path_of_pointer(std::string_view pointer) {
  for (const std::string& path : known_paths()) {
    const std::string whole = pointer_of_path(path);
    if (pointer == whole || pointer.starts_with(whole + "/")) return path;
  }
  return "";
}

void set_at_path(nlohmann::json& parameters, std::string_view path, const nlohmann::json& value) {
  nlohmann::json* target = &parameters;
  for (const std::string& part : parts_of_path(path))
    target = target->is_array() ? &target->at(std::stoul(part)) : &(*target)[part];
  *target = value;
}

void set_in_case(nlohmann::ordered_json& one_case, const std::string& path, const nlohmann::json& value) {
  if (is_path_in_description(path)) {
    one_case[path] = value;
    return;
  }
  nlohmann::json alone = nlohmann::json::object();
  set_at_path(alone, path, value);
  one_case.merge_patch(nlohmann::ordered_json(alone));
}

std::string path_in_case(std::string_view pointer) {
  constexpr std::string_view kCases = "/cases/";
  if (!pointer.starts_with(kCases)) return "";
  const auto slash = pointer.find('/', kCases.size());
  if (slash == std::string_view::npos) return "";
  const std::string_view place = pointer.substr(slash);
  if (std::string path = path_of_pointer(place); !path.empty()) return path;
  const std::string_view token = place.substr(1);
  return is_path_in_description(token) ? std::string(token) : "";
}

nlohmann::json whole_parameters_of(const nlohmann::json& common, const nlohmann::json& one_case) {
  nlohmann::json whole = one_case;
  for (const auto& [key, value] : one_case.items())
    if (is_path_in_description(key)) whole.erase(key);
  nlohmann::json made = common;
  made.merge_patch(whole);
  return made;
}

nlohmann::json parameters_of_case(const nlohmann::json& common, const nlohmann::json& one_case) {
  nlohmann::json made = whole_parameters_of(common, one_case);
  for (const auto& [key, value] : one_case.items())
    if (is_path_in_description(key)) set_at_path(made, key, value);
  return made;
}

const nlohmann::json& value_at_path(const nlohmann::json& completed, std::string_view path) {
  static const nlohmann::json kNone;
  const nlohmann::json* const found = find_at(completed, path);
  return found != nullptr ? *found : kNone;
}

}  // namespace jobs
