// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/parameters/range.h"

namespace jobs {

// A path names one value of a parameter set in one word: "clearance_mm", "links.1,3.mass_kg".

/// Every path that an axis may have.
[[nodiscard]] const std::vector<std::string>& known_paths();

/// @returns whether a key's value is an object or lists of lists, which only the cases of a sweep vary
[[nodiscard]] bool is_varied_by_cases(std::string_view key);

/// The paths that a parameter set gives values to, in its order. A key that is no parameter has none.
[[nodiscard]] std::vector<std::string> paths_of(const nlohmann::ordered_json& parameters);

/// @returns whether a path names a number inside the description of a linkage or of a drive:
/// "linkage.bodies.rod.mass_kg", "crank_drive.voltage_v"
[[nodiscard]] bool is_path_in_description(std::string_view path);

/// Range of a path whose values are whole numbers, of a parameter or in a description; empty: they need not
/// be.
[[nodiscard]] std::optional<Range> find_whole_range(std::string_view path);

/// Fault of a path that names no number of a description in a parameter set; empty if there is none.
[[nodiscard]] std::string describe_description_path_fault(const nlohmann::json& parameters,
                                                      std::string_view path);

/// "links.1,3.mass_kg" -> "/links/1,3/mass_kg".
[[nodiscard]] std::string pointer_of_path(std::string_view path);

/// The path of the value at or around that pointer: "/links/1,3/inertia_kg_m2/0" ->
/// "links.1,3.inertia_kg_m2".
[[nodiscard]] std::string path_of_pointer(std::string_view pointer);

/// Writes a value; objects around it are made where there are none. @param path of lists only places that
/// they have
void set_at_path(nlohmann::json& parameters, std::string_view path, const nlohmann::json& value);

/// Writes a value into a case of a sweep, where a number of a description is a key: its path.
void set_in_case(nlohmann::ordered_json& one_case, const std::string& path, const nlohmann::json& value);

/// The path of the value of a case at or around a pointer: "/cases/3/links/1,3/mass_kg" ->
/// "links.1,3.mass_kg". @returns empty for the whole case and for any other place
[[nodiscard]] std::string path_in_case(std::string_view pointer);

/// Parameters of a case of a sweep: the case's own replace common ones, and its numbers inside a description
/// ("linkage.bodies.rod.mass_kg") are set there.
/// @param one_case  its paths have no fault that describe_description_path_fault() finds
[[nodiscard]] nlohmann::json parameters_of_case(const nlohmann::json& common, const nlohmann::json& one_case);

/// The same without the numbers inside a description.
[[nodiscard]] nlohmann::json whole_parameters_of(const nlohmann::json& common,
                                                 const nlohmann::json& one_case);

/// @param completed  all parameters  @returns null if the linkage of the set has no such value
[[nodiscard]] const nlohmann::json& value_at_path(const nlohmann::json& completed, std::string_view path);

}  // namespace jobs
