// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/model/drive_law.h"
#include "engine/model/mechanism.h"
#include "engine/model/rpsup_parameters.h"
#include "jobs/base/errors.h"

namespace jobs {

/// The faults of the law by which a coordinate moves.
void check_drive(const nlohmann::json& drive, engine::Motion motion, const std::string& pointer,
                 std::vector<Fault>& faults);

/// @param drive  without faults
[[nodiscard]] engine::DriveLaw read_drive(const nlohmann::json& drive, engine::Motion motion,
                                          const engine::RpsupParameters& defaults);

}  // namespace jobs
