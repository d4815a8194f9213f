// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/model/linkage.h"
#include "engine/model/rpsup_parameters.h"
#include "jobs/base/errors.h"

namespace jobs {

inline constexpr std::string_view kLinkageKey = "linkage";
inline constexpr std::string_view kRpsupName = "rpsup";

/// @returns whether a parameter set describes its linkage, instead of naming the RPSUP linkage
[[nodiscard]] bool describes_linkage(const nlohmann::json& parameters);

/// The engine's view of a described linkage: the only place where its units are converted.
/// @param description  value of the key "linkage"
/// @param defaults     the job's own parameters: of clearance joints, beams, drives and gravity
/// @param faults       gets every fault, pointers from the parameter set; empty if there are faults
[[nodiscard]] std::optional<engine::Linkage> read_linkage(const nlohmann::json& description,
                                                          const engine::RpsupParameters& defaults,
                                                          std::vector<Fault>& faults);

/// "bodies.rod.mass_kg" -> "bodies", "rod", "mass_kg".
[[nodiscard]] std::vector<std::string> parts_of_path(std::string_view path);

/// Pointer into the description for a fault's field of engine::check_linkage: "bodies.rod.mass" ->
/// "/linkage/bodies/rod/mass_kg".
[[nodiscard]] std::string pointer_of_linkage_field(std::string_view field, const nlohmann::json& description);

/// A description, of a linkage or of a drive, in the one form in which it is stored: all numbers as doubles,
/// -0 as 0.
[[nodiscard]] nlohmann::json canonical_description(const nlohmann::json& description);

/// JSON Schema of the key "linkage".
[[nodiscard]] nlohmann::json linkage_schema();
/// JSON Schema of a law by which a coordinate moves.
[[nodiscard]] nlohmann::json law_schema(engine::Motion motion);
/// JSON Schema of a drive of a coordinate: a law or an actuator.
[[nodiscard]] nlohmann::json drive_schema(engine::Motion motion);

}  // namespace jobs
