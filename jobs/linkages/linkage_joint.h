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

/// @param joint  of a known kind
[[nodiscard]] std::size_t count_freedoms(const nlohmann::json& joint);

[[nodiscard]] bool closes_loop(const nlohmann::json& joint);

/// Parameters of a joint with clearance. @param defaults  the job's, for those that the joint does not give
[[nodiscard]] engine::RpsupParameters clearance_parameters(const nlohmann::json& clearance,
                                                           engine::RpsupParameters defaults);

}  // namespace jobs
