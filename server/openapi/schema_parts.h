// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "jobs/parameters/range.h"

namespace server::openapi {

using Json = nlohmann::ordered_json;

// Schemas of values that stand alone.
inline const Json kText{{"type", "string"}};
inline const Json kNumber{{"type", "number"}};
inline const Json kCount{{"type", "integer"}, {"minimum", 0}};

/// A schema of the document, by its name.
[[nodiscard]] inline Json ref(std::string_view schema) {
  return {{"$ref", "#/components/schemas/" + std::string(schema)}};
}

/// An object of exactly these properties, all of which are there unless `optional` names them.
[[nodiscard]] Json object_of(Json properties, std::initializer_list<std::string_view> optional = {});

/// An object of exactly these texts.
[[nodiscard]] Json texts_of(std::initializer_list<std::string_view> names);

/// An object of these properties and no others, none of which needs to be there.
[[nodiscard]] Json options_of(Json properties);

[[nodiscard]] Json list_of(Json items);

[[nodiscard]] Json described(Json schema, std::string_view description);

/// An integer in a range.
[[nodiscard]] Json integer_between(const jobs::Range& range, std::string_view description);

/// The property of the schema of a sweep's request.
[[nodiscard]] Json as_in_sweep(std::string_view property);

/// Schema that allows null beside the values of another one.
[[nodiscard]] Json or_null(Json schema);

/// The schema of the value of a parameter, by its path: "clearance_mm", "links.1,3.mass_kg".
[[nodiscard]] Json parameter_ref(std::string_view path);

/// Adds what a row tells of its job's parameters, where they vary: null where the job has no such parameter.
void add_parameters_of_row(Json& properties);

}  // namespace server::openapi
