// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/parameter_schema.h"

#include "jobs/linkages/linkage_json.h"
#include "jobs/parameters/kept_results.h"
#include "jobs/parameters/link_parameters.h"
#include "jobs/parameters/parameter_table.h"
#include "jobs/parameters/rpsup_drives.h"
#include "jobs/parameters/wear_depth.h"

namespace jobs {
namespace {

using nlohmann::json;

void add_range(const Range& range, json& schema) {
  schema[range.lower == Bound::kInclusive ? "minimum" : "exclusiveMinimum"] = range.minimum;
  schema[range.upper == Bound::kInclusive ? "maximum" : "exclusiveMaximum"] = range.maximum;
}

json schema_of(const ParameterInfo& info) {
  json schema{{"description", info.help}, {"default", default_value(info)},
              {"x-default-source", source_name(info.source)}};
  if (!info.unit.empty()) schema["x-unit"] = info.unit;
  switch (info.kind) {
    case ParameterKind::kNumber: schema["type"] = "number"; break;
    case ParameterKind::kInteger: schema["type"] = "integer"; break;
    case ParameterKind::kChoice: schema["type"] = "string"; break;
  }
  if (info.kind == ParameterKind::kChoice) {
    schema["enum"] = info.choices;
  } else {
    add_range(info.range, schema);
  }
  return schema;
}

/// @param source  where the default moments come from: the paper's rows of links (2,1) and (2,2) are those
///     of no body
json schema_of_moments(const Eigen::Vector3d& moments, DefaultSource source) {
  json moment{{"type", "number"}};
  add_range(kInertiaRange, moment);
  return {{"type", "array"},
          {"minItems", 3},
          {"maxItems", 3},
          {"items", moment},
          {"x-unit", "kg m^2"},
          {"description",
           "Moments (I_x, I_y, I_z) about the link's frame origin. A default scales with the link's mass, "
           "length and diameter as a uniform rod's"},
          {"default", {moments.x(), moments.y(), moments.z()}},
          {"x-default-source", source_name(source)}};
}

/// @param moments  where the default moments come from
json schema_of_link(const engine::LinkInertia& link, DefaultSource moments) {
  json mass{{"type", "number"}, {"description", "Mass of the link"}, {"default", link.mass}, {"x-unit", "kg"},
            {"x-default-source", source_name(DefaultSource::kPaper)}};
  add_range(kMassRange, mass);
  return {{"type", "object"},
          {"additionalProperties", false},
          {"properties", {{kMassKey, mass}, {kInertiaKey, schema_of_moments(link.inertia, moments)}}}};
}

json schema_of_links() {
  json links{{"type", "object"}, {"additionalProperties", false},
             {"description", "Mass properties of the links"}, {"properties", json::object()}};
  const engine::RpsupParameters defaults;
  for (std::size_t i = 0; i < kLinkNames.size(); ++i) {
    const DefaultSource moments =
        kLinkNames[i].starts_with("1") ? DefaultSource::kPaper : DefaultSource::kDeduced;
    links["properties"][kLinkNames[i]] = schema_of_link(defaults.links[i], moments);
  }
  return links;
}

json schema_of_kept_results() {
  return {{"type", "string"}, {"enum", kKeepWords}, {"default", kKeepAll}, {"description", kKeepHelp}};
}

}  // namespace

json parameter_schema() {
  json properties{{kLinkageKey, linkage_schema()},
                  {"links", schema_of_links()},
                  {kWearKey, wear_schema()},
                  {kKeepKey, schema_of_kept_results()}};
  for (const RpsupDrive& drive : rpsup_drives()) {
    properties[drive.key] = drive_schema(drive.motion);
    properties[drive.key]["description"] = drive.help;
  }
  for (const ParameterInfo& info : parameter_table()) properties[info.key] = schema_of(info);
  return {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
          {"title", "Parameters of a job"},
          {"type", "object"},
          {"additionalProperties", false},
          {"properties", properties}};
}

}  // namespace jobs
