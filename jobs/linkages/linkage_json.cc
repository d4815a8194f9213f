// SPDX-License-Identifier: Apache-2.0
#include "jobs/linkages/linkage_json.h"

#include <algorithm>
#include <string>

#include "jobs/linkages/check_linkage.h"
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

}  // namespace

bool describes_linkage(const json& parameters) {
  const auto found = parameters.find(kLinkageKey);
  return found != parameters.end() && found->is_object();
}

std::optional<engine::Linkage> read_linkage(const json& description, const engine::RpsupParameters& defaults,
                                            std::vector<Fault>& faults) {
  const auto order = check_linkage_json(description, defaults, faults);
  return order ? std::optional(make_linkage(description, defaults, *order)) : std::nullopt;
}

std::string pointer_of_linkage_field(std::string_view field) {
  std::string pointer = "/linkage";
  for (std::size_t start = 0; start <= field.size();) {
    const std::size_t dot = std::min(field.find('.', start), field.size());
    const std::string_view part = field.substr(start, dot - start);
    if (!part.empty())
      pointer += pointer_token(part == "mass" ? "mass_kg" : part == "inertia" ? "inertia_kg_m2" : part);
    start = dot + 1;
  }
  return pointer;
}

json canonical_description(const json& description) { return with_doubles(description); }

}  // namespace jobs
