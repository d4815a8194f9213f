// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/analysis/quantities.h"
#include "jobs/base/errors.h"
#include "jobs/parameters/job_spec.h"

namespace jobs {

/// All parameters of a job with their defaults filled in.
/// @param pointer  where `given` stands in the request, for the faults
/// @throws InvalidRequest with every fault
[[nodiscard]] nlohmann::json complete_parameters(const nlohmann::json& given, const std::string& pointer);

/// The engine's view of completed parameters: their units become SI on this way only.
[[nodiscard]] JobSpec to_job_spec(const nlohmann::json& completed_parameters);

/// Metrics of a job. @param given  parameters whose values have no faults
[[nodiscard]] std::vector<engine::QuantityInfo> metric_table(const nlohmann::json& given);

/// The channels of the job's trajectory.
[[nodiscard]] std::vector<engine::QuantityInfo> channel_table(const JobSpec& spec);

// The three steps of complete_parameters, for those who have many parameter sets made of the same values.
// Pointers of the faults start at the parameter set: "/clearance_mm".

/// The faults that the given values have each by itself: unknown key, wrong type, out of range.
/// @param beside  parameters without faults that a described linkage is judged with, beside the given ones
[[nodiscard]] std::vector<Fault> find_value_faults(const nlohmann::json& given,
                                                   const nlohmann::json& beside = nlohmann::json::object());

/// The faults of the value of one path by itself. A number inside a described linkage that need not be whole
/// is judged with the whole description.
[[nodiscard]] std::vector<Fault> find_path_faults(const std::string& path, const nlohmann::json& value);

/// The given values and all defaults, in canonical form. @param given  an object whose values have no faults
[[nodiscard]] nlohmann::json fill_in_defaults(const nlohmann::json& given);

/// The faults that values have together: limits that depend on each other, and what the engine refuses.
/// @param completed  from fill_in_defaults
[[nodiscard]] std::vector<Fault> find_combination_faults(const nlohmann::json& completed);

/// @returns whether the job's trajectory has more channels than `most`. Of jobs of "rpsup" they are only
/// counted where some of those might have more.
[[nodiscard]] bool has_more_channels(const JobSpec& spec, double most);

}  // namespace jobs
