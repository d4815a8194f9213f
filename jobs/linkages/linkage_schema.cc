// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "jobs/linkages/actuator_fields.h"
#include "jobs/linkages/linkage_clearance.h"
#include "jobs/linkages/linkage_fields.h"
#include "jobs/linkages/linkage_json.h"

namespace jobs {
namespace {

using nlohmann::json;

void take_properties(const json& from, json& to) {
  for (const auto& [key, value] : from.at("properties").items()) to["properties"][key] = value;
}

/// Gives a property a schema of its own, with the description that it has.
void replace_property(const char* key, json of_key, json& schema) {
  json& property = schema["properties"][key];
  of_key["description"] = property["description"];
  property = std::move(of_key);
}

json named(json entry, std::string_view what) {
  return {{"type", "object"}, {"description", what}, {"minProperties", 1},
          {"propertyNames", {{"pattern", "^[A-Za-z][A-Za-z0-9_]{0,31}$"}}},
          {"additionalProperties", std::move(entry)}};
}

json schema_of_drive(engine::Motion motion) {
  json schema = drive_schema(motion);
  schema["description"] =
      "The law by which the coordinate moves, or the actuator that moves it; without it it is free";
  return schema;
}

/// Requires the variable of a table: the times, or one of those that it may have.
void require_variable(engine::Motion motion, EffortVariables variables, json& table) {
  const TableVariables of = table_variables(motion);
  if (variables == EffortVariables::kTime) {
    table["required"].push_back(of.times);
    return;
  }
  for (const std::string_view key : {of.times, of.positions, of.velocities})
    table["oneOf"].push_back({{"required", json::array({key})}});
}

/// Schema of a number or a law under a key of `fields`.
json schema_of_effort(const LinkageField& field, const EffortKeys& effort, engine::Motion motion,
                      EffortVariables variables) {
  json any = json::array();
  any.push_back(schema_of_fields({field})["properties"][field.key]["anyOf"][0]);
  for (const std::string_view law : kEffortLaws) {
    json schema = schema_of_fields(effort_fields(effort, law, motion, variables));
    schema["properties"]["law"] = {{"const", law}};
    if (law == "table") require_variable(motion, variables, schema);
    any.push_back(std::move(schema));
  }
  return {{"description", field.help}, {"x-unit", field.unit}, {"anyOf", std::move(any)}};
}

/// Schemas of a controller, one for each controlled quantity. @param beside  further fields
std::vector<json> schemas_of_controller(const EffortKeys& effort, engine::Motion motion,
                                        const LinkageFields& beside) {
  std::vector<json> schemas;
  for (const std::string_view controlled : kControlled) {
    LinkageFields fields = controller_fields(effort, controlled, motion);
    fields.insert(fields.end(), beside.begin(), beside.end());
    json schema = schema_of_fields(fields);
    schema["properties"]["controlled"] = {{"const", controlled}};
    schema["properties"]["target"] = law_schema(motion);
    schema["anyOf"] = {{{"required", {"proportional"}}}, {{"required", {"integral"}}}};
    if (controlled == "position") schema["anyOf"].push_back({{"required", {"derivative"}}});
    schemas.push_back(std::move(schema));
  }
  return schemas;
}

json schema_of_motor(engine::Motion motion) {
  LinkageFields fields = motor_fields(motion);
  fields.push_back(actuator_field(motion));
  json schema = schema_of_fields(fields);
  json& voltages = schema["properties"]["voltage_v"];
  voltages = schema_of_effort(fields.front(), voltage(), motion, EffortVariables::kTime);
  schema["properties"]["controller"] = {{"description", schema["properties"]["controller"]["description"]},
                                        {"oneOf", schemas_of_controller(voltage(), motion, {})}};
  schema["oneOf"] = {{{"required", {"voltage_v"}}}, {{"required", {"controller"}}}};
  return schema;
}

/// Adds the schemas of all actuators.
void add_actuator_schemas(engine::Motion motion, json& any) {
  const EffortKeys& effort = force_or_torque(motion);
  const LinkageField field = effort_field(effort, "Number, or a law", true);
  const auto words = actuator_words(motion);
  const auto add = [&](json schema, std::string_view word) {
    schema["properties"]["actuator"] = {{"const", word}};
    any.push_back(std::move(schema));
  };
  json of_effort = schema_of_fields({actuator_field(motion), field});
  of_effort["properties"][field.key] = schema_of_effort(field, effort, motion, EffortVariables::kAny);
  add(std::move(of_effort), words[0]);
  for (json& schema : schemas_of_controller(effort, motion, {actuator_field(motion)}))
    add(std::move(schema), words[1]);
  add(schema_of_motor(motion), words[2]);
}

json schema_of_freedom(engine::Motion motion) {
  json schema = schema_of_fields(freedom_fields(motion));
  schema["properties"]["drive"] = schema_of_drive(motion);
  const LinkageFields fields = freedom_fields(motion);
  const auto load = std::ranges::find(fields, FieldKind::kEffort, &LinkageField::kind);
  schema["properties"][load->key] =
      schema_of_effort(*load, force_or_torque(motion), motion, EffortVariables::kAny);
  replace_property("friction", schema_of_fields(friction_fields(motion)), schema);
  return schema;
}

json schema_of_body() {
  json schema = schema_of_fields(body_fields());
  replace_property("beam", schema_of_fields(beam_fields()), schema);
  return schema;
}

/// The keys of all kinds of joint that can have clearance.
json schema_of_clearance() {
  LinkageFields fields = clearance_fields();
  for (LinkageField field : block_fields()) {
    field.required = false;
    fields.push_back(std::move(field));
  }
  return schema_of_fields(fields);
}

/// The freedoms of all kinds of joint, by their names.
void add_named_freedoms(const json& slide, const json& turn, json& freedoms) {
  freedoms["additionalProperties"] = false;
  freedoms["properties"] = json::object();
  for (const char* const name : {"slide", "slide_x", "slide_y", "slide_z"})
    freedoms["properties"][name] = slide;
  for (const char* const name : {"turn", "first", "second", "turn_z", "turn_y", "turn_x"})
    freedoms["properties"][name] = turn;
  for (const char* const name : {"x", "y", "z"}) freedoms["properties"][name] = {{"anyOf", {slide, turn}}};
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
  schema["properties"]["friction"] = {
      {"anyOf", {turn["properties"]["friction"], slide["properties"]["friction"]}}};
  replace_property("clearance", schema_of_clearance(), schema);
  replace_property("cross", schema_of_fields(cross_fields()), schema);
  add_named_freedoms(slide, turn, schema["properties"]["freedoms"]);
  return schema;
}

json schema_of_body_load() {
  const LinkageFields fields = load_fields();
  json schema = schema_of_fields(fields);
  schema["oneOf"] = json::array();
  for (const engine::Motion motion : {engine::Motion::kTranslation, engine::Motion::kRotation}) {
    const EffortKeys& effort = force_or_torque(motion);
    const auto field = std::ranges::find(fields, effort.key, &LinkageField::key);
    schema["properties"][effort.key] = schema_of_effort(*field, effort, motion, EffortVariables::kTime);
    schema["oneOf"].push_back({{"required", json::array({effort.key})}});
  }
  return schema;
}

json schema_of_ground_acceleration(const json& described) {
  json schema = schema_of_fields(ground_acceleration_fields());
  for (const LinkageField& field : ground_acceleration_fields())
    schema["properties"][field.key] =
        schema_of_effort(field, acceleration(), engine::Motion::kRotation, EffortVariables::kTime);
  schema["description"] = described.at("description");
  return schema;
}

}  // namespace

json drive_schema(engine::Motion motion) {
  json schema = law_schema(motion);
  add_actuator_schemas(motion, schema["oneOf"]);
  return schema;
}

json law_schema(engine::Motion motion) {
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
  described["properties"]["loads"] =
      named(schema_of_body_load(), "Forces and moments on bodies, by their names");
  described["properties"]["accelerometers"] =
      named(schema_of_fields(accelerometer_fields()), "Accelerometers on bodies, by their names");
  json& ground = described["properties"]["ground_acceleration_m_s2"];
  ground = schema_of_ground_acceleration(ground);
  return {{"description", "The linkage: \"rpsup\", or a description of any other"}, {"default", kRpsupName},
          {"x-default-source", "chosen"},
          {"oneOf", {{{"const", kRpsupName}}, std::move(described)}}};
}

}  // namespace jobs
