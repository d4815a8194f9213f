#include "jobs/parameter_path.h"

#include <algorithm>

#include "jobs/link_parameters.h"
#include "jobs/parameter_table.h"
#include "jobs/parameter_value.h"
#include "jobs/linkage_json.h"

namespace jobs {
#include "jobs/wear/wear_depth.h"
namespace {

std::vector<std::string> make_known_paths() {
  std::vector<std::string> paths;
  for (const ParameterInfo& info : parameter_table()) paths.emplace_back(info.key);
  for (const std::string_view link : kLinkNames) {
    for (const std::string_view part : {kMassKey, kInertiaKey}) paths.push_back("links." + std::string(link) + "." + std::string(part));
  }
  return paths;
}

}  // namespace

const std::vector<std::string>& known_paths() {
  static const std::vector<std::string> paths = make_known_paths();
  return paths;
}

std::vector<std::string> paths_of(const nlohmann::ordered_json& parameters) {
  std::vector<std::string> paths;
  for (const auto& [key, value] : parameters.items()) {
    if (find_parameter(key) != nullptr || key == kLinkageKey || key == kWearKey) paths.push_back(key);
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

bool is_linkage_path(std::string_view path) { return path.starts_with("linkage."); }

std::string describe_linkage_path_fault(const nlohmann::json& parameters, std::string_view path) {
  const nlohmann::json::json_pointer pointer(pointer_of_path(path));
  if (parameters.contains(pointer)) return parameters.at(pointer).is_number() ? "" : "is no number of the linkage described";
  // What is left out has a default, and may be swept as well.
  const bool has_place = parameters.contains(pointer.parent_pointer()) && parameters.at(pointer.parent_pointer()).is_object();
  return has_place ? "" : "there is no such place in the linkage described";
}

std::string pointer_of_path(std::string_view path) {
  std::string pointer;
  for (std::size_t start = 0; start <= path.size();) {
    const std::size_t dot = std::min(path.find('.', start), path.size());
    pointer += pointer_token(path.substr(start, dot - start));
    start = dot + 1;
  }
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
  parameters[nlohmann::json::json_pointer(pointer_of_path(path))] = value;
}

const nlohmann::json& value_at_path(const nlohmann::json& completed, std::string_view path) {
  static const nlohmann::json kNone;
  const nlohmann::json::json_pointer pointer(pointer_of_path(path));
  return completed.contains(pointer) ? completed.at(pointer) : kNone;
}

}  // namespace jobs
