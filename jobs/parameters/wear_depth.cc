// SPDX-License-Identifier: Apache-2.0
#include "jobs/parameters/wear_depth.h"

#include <algorithm>
#include <cstddef>

#include "jobs/parameters/parameter_value.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr double kUmPerM = 1e6;
constexpr std::size_t kMostRings = 16;  // as many as radial_levels allows

std::string shape_text() {
  return "must be a list for each ring of the journal, each of the same number of depths, " +
         kBoreSectorsRange.text();
}

void collect_ring_faults(const json& ring, const std::string& pointer, std::vector<Fault>& faults) {
  for (std::size_t s = 0; s < ring.size(); ++s) {
    if (std::string detail = describe_number_fault(kWearDepthRange, "um", ring[s]); !detail.empty()) {
      faults.push_back({pointer + "/" + std::to_string(s), std::move(detail)});
    }
  }
}

}  // namespace

std::vector<Fault> find_wear_faults(const json& value) {
  const std::string pointer = pointer_token(kWearKey);
  const auto is_ring = [&](const json& ring) {
    return ring.is_array() && kBoreSectorsRange.contains(static_cast<double>(ring.size())) &&
           ring.size() == value.front().size();
  };
  if (!value.is_array() || value.empty() || value.size() > kMostRings || !std::ranges::all_of(value, is_ring))
    return {{pointer, shape_text()}};
  std::vector<Fault> faults;
  for (std::size_t r = 0; r < value.size(); ++r)
    collect_ring_faults(value[r], pointer + "/" + std::to_string(r), faults);
  return faults;
}

json canonical_wear(const json& value) {
  json rings = json::array();
  for (const json& ring : value) {
    rings.push_back(json::array());
    for (const json& depth : ring) rings.back().push_back(depth.get<double>() + 0.0);  // -0 + 0 is +0
  }
  return rings;
}

double deepest_wear(const json& value) {
  double deepest = 0.0;
  for (const json& ring : value)
    for (const json& depth : ring) deepest = std::max(deepest, depth.get<double>());
  return deepest;
}

engine::WearDepth to_wear_depth(const json& value) {
  auto rings = value.get<engine::WearDepth>();
  for (auto& ring : rings)
    for (double& depth : ring) depth /= kUmPerM;
  return rings;
}

json wear_schema() {
  json depth{{"type", "number"}, {"minimum", kWearDepthRange.minimum}, {"maximum", kWearDepthRange.maximum}};
  json ring{{"type", "array"},
            {"items", std::move(depth)},
            {"minItems", static_cast<int>(kBoreSectorsRange.minimum)},
            {"maxItems", static_cast<int>(kBoreSectorsRange.maximum)}};
  return {{"type", "array"},
          {"items", std::move(ring)},
          {"minItems", 1},
          {"maxItems", kMostRings},
          {"x-unit", "um"},
          {"description",
           std::string(kWearHelp) +
               ". As many lists as radial_levels says, all of the same length, no depth above a tenth of "
               "the bearing's radius. Left out, the bore is round. Of the linkage rpsup only"}};
}

}  // namespace jobs
