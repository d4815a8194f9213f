// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/model/linkage.h"
#include "engine/model/rpsup_parameters.h"

namespace jobs {

/// Kind of a described joint. Empty if it names none of them.
[[nodiscard]] std::optional<engine::JointKind> find_joint_kind(const nlohmann::json& joint);

/// Freedom of a joint: last part of its name, empty if it is the only one, and its motion.
using JointFreedom = std::pair<std::string_view, engine::Motion>;
[[nodiscard]] std::vector<JointFreedom> freedoms_of(engine::JointKind kind);

/// Freedoms that the description of a joint may speak of: with clearance of those of its kind, and all others
/// as well, in the order of engine::freedoms_of(). @param joint  of a known kind
[[nodiscard]] std::vector<JointFreedom> list_freedoms(const nlohmann::json& joint);

/// Axis of a joint without faults. @param otherwise  its letter where the joint names none
[[nodiscard]] engine::Axis read_axis(const nlohmann::json& joint, const char* key, char otherwise);

[[nodiscard]] bool closes_loop(const nlohmann::json& joint);

/// @returns whether a joint is a universal one with clearance, whose cross is a body between revolute joints
[[nodiscard]] bool has_cross(const nlohmann::json& joint);
inline constexpr std::string_view kCrossEnding = "_cross";  ///< of that body's name, behind the joint's
inline constexpr std::string_view kFirstEnding = "_first";  ///< of those revolute joints' names
inline constexpr std::string_view kSecondEnding = "_second";

/// Parameters of a joint with clearance. @param defaults  the job's, for those that the joint does not give
[[nodiscard]] engine::RpsupParameters clearance_parameters(const nlohmann::json& clearance,
                                                           engine::RpsupParameters defaults);

}  // namespace jobs
