// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/clearance/clearance_parameters.h"
#include "engine/model/linkage.h"
#include "engine/model/rpsup_parameters.h"
#include "jobs/base/errors.h"
#include "jobs/linkages/linkage_fields.h"

namespace jobs {

/// @returns whether joints of this kind can have clearance
[[nodiscard]] bool can_have_clearance(engine::JointKind kind);

/// Keys of the clearance of such a joint.
[[nodiscard]] LinkageFields clearance_fields_of(engine::JointKind kind);
/// Keys that only a block in its slot has.
[[nodiscard]] const LinkageFields& block_fields();
/// Keys of the cross of a universal joint with clearance.
[[nodiscard]] const LinkageFields& cross_fields();

/// The faults of a joint's clearance, and of the cross between both axes of a universal one.
void check_clearance(const nlohmann::json& joint, engine::JointKind kind,
                     const engine::RpsupParameters& defaults, const std::string& pointer,
                     std::vector<Fault>& faults);

/// @returns whether a joint without faults has clearance: one of 0 is none
/// @param defaults  the job's, for what the joint does not say
[[nodiscard]] bool has_clearance(const nlohmann::json& joint, const engine::RpsupParameters& defaults);

/// @param clearance  without faults  @param kind  of a universal joint kRevolute
[[nodiscard]] engine::ClearanceParameters read_clearance(const nlohmann::json& clearance,
                                                         engine::JointKind kind,
                                                         const engine::RpsupParameters& defaults);

}  // namespace jobs
