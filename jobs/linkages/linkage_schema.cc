// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "jobs/linkages/linkage_fields.h"
#include "jobs/linkages/linkage_json.h"

namespace jobs {
namespace {

using nlohmann::json;

void take_properties(const json& from, json& to) {
  for (const auto& [key, value] : from.at("properties").items()) to["properties"][key] = value;
}

json named(json entry, std::string_view what) {
  return {{"type", "object"}, {"description", what}, {"minProperties", 1},
          {"propertyNames", {{"pattern", "^[A-Za-z][A-Za-z0-9_]{0,31}$"}}},
          {"additionalProperties", std::move(entry)}};
}

json schema_of_drive(engine::Motion motion) {
  json schema = drive_schema(motion);
  schema["description"] = "The law by which the coordinate moves; without it it is free";
  return schema;
}

json schema_of_freedom(engine::Motion motion) {
  json schema = schema_of_fields(freedom_fields(motion));
  schema["properties"]["drive"] = schema_of_drive(motion);
  return schema;
}

json schema_of_body() {
  json schema = schema_of_fields(body_fields());
  json beam = schema_of_fields(beam_fields());
  beam["description"] = schema["properties"]["beam"]["description"];
  schema["properties"]["beam"] = std::move(beam);
  return schema;
}

/// The keys of all kinds of joint; refusals tell which of them a kind does not have.
json schema_of_joint() {
  json schema = schema_of_fields(joint_fields());
  const json turn = schema_of_freedom(engine::Motion::kRotation);
  const json slide = schema_of_freedom(engine::Motion::kTranslation);
  take_properties(slide, schema);
  take_properties(turn, schema);
  schema["properties"]["drive"] = {
      {"anyOf", {schema_of_drive(engine::Motion::kRotation), schema_of_drive(engine::Motion::kTranslation)}}};
  json clearance = schema_of_fields(clearance_fields());
  clearance["description"] = schema["properties"]["clearance"]["description"];
  schema["properties"]["clearance"] = std::move(clearance);
  json& freedoms = schema["properties"]["freedoms"];
  freedoms["additionalProperties"] = false;
  freedoms["properties"] = {{"slide", slide}};
  for (const char* const name : {"turn", "first", "second", "turn_z", "turn_y", "turn_x"})
    freedoms["properties"][name] = turn;
  for (const char* const name : {"x", "y", "z"}) freedoms["properties"][name] = {{"anyOf", {slide, turn}}};
  return schema;
}

}  // namespace

json drive_schema(engine::Motion motion) {
  json any = json::array();
  for (const std::string_view law : kLaws) {
    json schema = schema_of_fields(drive_fields(motion, law));
    schema["properties"]["law"] = {{"const", law}};
    if (law == "polynomial") {
      const auto [key, former_key] = coefficient_keys(motion);
      schema["required"] = {"law"};
      schema["oneOf"] = {{{"required", {key}}}, {{"required", {former_key}}}};
    }
    any.push_back(std::move(schema));
  }
  return {{"oneOf", std::move(any)}};
}

json linkage_schema() {
  json described = schema_of_fields(linkage_fields());
  described["properties"]["bodies"] = named(schema_of_body(), "The bodies by their names");
  described["properties"]["joints"] = named(schema_of_joint(), "The joints by their names");
  described["properties"]["springs"] = named(
      schema_of_fields(spring_fields()), "Springs and dampers between points of two bodies, by their names");
  return {{"description", "The linkage: \"rpsup\", or a description of any other"}, {"default", kRpsupName},
          {"x-default-source", "chosen"},
          {"oneOf", {{{"const", kRpsupName}}, std::move(described)}}};
}

}  // namespace jobs
