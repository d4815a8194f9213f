// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/model/actuator.h"
#include "engine/model/linkage.h"
#include "engine/model/mechanism.h"
#include "engine/model/rpsup_parameters.h"
#include "jobs/base/errors.h"

namespace jobs {

/// The faults of an actuator that moves a coordinate.
void check_actuator(const nlohmann::json& actuator, engine::Motion motion, const std::string& pointer,
                    std::vector<Fault>& faults);

/// An actuator without faults in the one form in which it is stored. @param actuator  numbers as doubles
[[nodiscard]] nlohmann::json canonical_actuator(nlohmann::json actuator, engine::Motion motion);

/// @param actuator  without faults
[[nodiscard]] engine::Actuator read_actuator(const nlohmann::json& actuator, engine::Motion motion,
                                             const engine::RpsupParameters& defaults);

/// The load of a freedom: a force or torque, by a number or by a law.
void check_load(const nlohmann::json& load, engine::Motion motion, const std::string& pointer,
                std::vector<Fault>& faults);
/// @param load  without faults
[[nodiscard]] engine::ForceLaw read_load(const nlohmann::json& load, engine::Motion motion);

/// A load on a body: the faults of its own keys.
void check_body_load(const nlohmann::json& load, const std::string& pointer, std::vector<Fault>& faults);
/// @param load  without faults
[[nodiscard]] engine::LinkageLoad read_body_load(const std::string& name, const nlohmann::json& load);

void check_ground_acceleration(const nlohmann::json& acceleration, const std::string& pointer,
                               std::vector<Fault>& faults);
/// @param acceleration  of one axis, without faults
[[nodiscard]] engine::Signal read_acceleration(const nlohmann::json& acceleration);

/// The friction of a freedom.
void check_friction(const nlohmann::json& friction, engine::Motion motion,
                    const engine::RpsupParameters& defaults, const std::string& pointer,
                    std::vector<Fault>& faults);
/// @param friction  without faults  @returns empty: its law is "none"
[[nodiscard]] std::optional<engine::JointFriction> read_friction(const nlohmann::json& friction,
                                                                 engine::Motion motion,
                                                                 const engine::RpsupParameters& defaults);

}  // namespace jobs
