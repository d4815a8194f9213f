// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/model/drive_law.h"
#include "engine/model/mechanism.h"
#include "engine/model/rpsup_parameters.h"
#include "jobs/base/errors.h"

namespace jobs {

/// The faults of a drive: a law by which a coordinate moves, or an actuator.
void check_drive(const nlohmann::json& drive, engine::Motion motion, const std::string& pointer,
                 std::vector<Fault>& faults);

/// The faults of a table: its variable rises, with one value for each. @param variable, values  keys of lists
void check_table(const nlohmann::json& table, const std::string& variable, std::string_view values,
                 const std::string& pointer, std::vector<Fault>& faults);

/// Fault of the time of a run-up that no step resolves; empty if there is none. @param time_s  at least 0
[[nodiscard]] std::string describe_run_up_fault(double time_s);

/// A drive without faults in the one form in which it is stored: numbers as doubles, present names of keys,
/// and the default interpolation.
[[nodiscard]] nlohmann::json canonical_drive(const nlohmann::json& drive, engine::Motion motion);

/// @param drive  a law without faults
[[nodiscard]] engine::DriveLaw read_drive(const nlohmann::json& drive, engine::Motion motion,
                                          const engine::RpsupParameters& defaults);

}  // namespace jobs
