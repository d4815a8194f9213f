// SPDX-License-Identifier: Apache-2.0
#include "jobs/linkages/linkage_json.h"

#include <algorithm>
#include <string>
#include <vector>

#include "jobs/linkages/check_linkage.h"
#include "jobs/linkages/linkage_joint.h"
#include "jobs/linkages/make_linkage.h"
#include "jobs/parameters/parameter_value.h"

namespace jobs {
namespace {

using nlohmann::json;

json with_doubles(const json& value) {
  if (value.is_number()) return value.get<double>() + 0.0;  // -0 + 0 is +0
  if (!value.is_structured()) return value;
  json made = value;
  for (json& part : made) part = with_doubles(part);
  return made;
}

/// Place of a body or joint of the engine. A universal joint with clearance is two joints and a body there.
std::string pointer_of_part(const std::string& kind, const std::string& name, const json& description) {
  if (description.contains(kind) && description.at(kind).contains(name))
    return pointer_token(kind) + pointer_token(name);
  for (const std::string_view ending : {kFirstEnding, kSecondEnding, kCrossEnding})
    if (name.ends_with(ending))
      return "/joints" + pointer_token(name.substr(0, name.size() - ending.size())) +
             (ending == kCrossEnding ? "/cross" : "");
  return pointer_token(kind) + pointer_token(name);
}

}  // namespace

std::vector<std::string> parts_of_path(std::string_view path) {
  std::vector<std::string> parts;
  for (std::size_t start = 0; start <= path.size();) {
    const std::size_t dot = std::min(path.find('.', start), path.size());
    parts.emplace_back(path.substr(start, dot - start));
    start = dot + 1;
  }
  return parts;
}

bool describes_linkage(const json& parameters) {
  const auto found = parameters.find(kLinkageKey);
  return found != parameters.end() && found->is_object();
}

std::optional<engine::Linkage> read_linkage(const json& description, const engine::RpsupParameters& defaults,
                                            std::vector<Fault>& faults) {
  const auto order = check_linkage_json(description, defaults, faults);
  return order ? std::optional(make_linkage(description, defaults, *order)) : std::nullopt;
}

std::string pointer_of_linkage_field(std::string_view field, const json& description) {
  const std::vector<std::string> parts = parts_of_path(field);
  std::string pointer = "/linkage";
  if (parts.size() < 2) return pointer + (field.empty() ? "" : pointer_token(field));
  pointer += pointer_of_part(parts[0], parts[1], description);
  for (std::size_t k = 2; k < parts.size(); ++k) {
    const json::json_pointer about_origin("/bodies/" + parts[1] + "/inertia_about_origin_kg_m2");
    pointer += parts[k] == "mass"                   ? "/mass_kg"
               : parts[k] != "inertia"              ? pointer_token(parts[k])
               : description.contains(about_origin) ? "/inertia_about_origin_kg_m2"
                                                    : "/inertia_kg_m2";
  }
  return pointer;
}

json canonical_description(const json& description) { return with_doubles(description); }

}  // namespace jobs
