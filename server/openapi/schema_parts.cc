// SPDX-License-Identifier: Apache-2.0
#include "server/openapi/schema_parts.h"

#include <algorithm>
#include <cstdint>

#include "jobs/parameters/rpsup_drives.h"
#include "jobs/parameters/wear_depth.h"
#include "jobs/requests/parameter_path.h"

namespace server::openapi {

Json object_of(Json properties, std::initializer_list<std::string_view> optional) {
  Json required = Json::array();
  for (const auto& [key, schema] : properties.items()) {
    if (std::ranges::find(optional, key) == optional.end()) required.push_back(key);
  }
  return {{"type", "object"},
          {"additionalProperties", false},
          {"required", std::move(required)},
          {"properties", std::move(properties)}};
}

Json texts_of(std::initializer_list<std::string_view> names) {
  Json properties = Json::object();
  for (const std::string_view name : names) properties[std::string(name)] = kText;
  return object_of(std::move(properties));
}

Json options_of(Json properties) {
  return {{"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties)}};
}

Json list_of(Json items) { return {{"type", "array"}, {"items", std::move(items)}}; }

Json described(Json schema, std::string_view description) {
  schema["description"] = description;
  return schema;
}

Json or_null(Json schema) { return {{"anyOf", Json::array({std::move(schema), {{"type", "null"}}})}}; }

Json parameter_ref(std::string_view path) {
  std::string pointer = jobs::pointer_of_path(path);
  for (std::size_t slash = 0; (slash = pointer.find('/', slash)) != std::string::npos;
       slash += sizeof "/properties")
    pointer.insert(slash, "/properties");
  return {{"$ref", "#/components/schemas/Parameters" + pointer}};
}

void add_parameters_of_row(Json& properties) {
  for (const std::string& path : jobs::known_paths()) properties[path] = or_null(parameter_ref(path));
  properties["linkage"] = described(
      kText, "of a described one its name, with a number if another one of the sweep has that name");
  for (const jobs::RpsupDrive& drive : jobs::rpsup_drives())
    properties[std::string(drive.key)] =
        described(or_null(kText), "the law or actuator, with a number if another drive of the sweep has it");
  properties[std::string(jobs::kWearKey)] = described(or_null(kNumber), "the largest depth, in um");
}

Json as_in_sweep(std::string_view property) {
  return {{"$ref", "#/components/schemas/SweepRequest/properties/" + std::string(property)}};
}

Json integer_between(const jobs::Range& range, std::string_view description) {
  return described({{"type", "integer"},
                    {"minimum", static_cast<std::int64_t>(range.minimum)},
                    {"maximum", static_cast<std::int64_t>(range.maximum)}},
                   description);
}

}  // namespace server::openapi
