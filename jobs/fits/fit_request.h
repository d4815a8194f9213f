// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include <nlohmann/json.hpp>

#include "jobs/fits/fit_problem.h"
#include "jobs/fits/fitted_measurements.h"
#include "jobs/parameters/range.h"

namespace jobs {

/// Keys of a request.
inline constexpr std::array<std::string_view, 14> kFitRequestKeys{
    "name",    "parameters", "over",       "measurements", "basis", "intervals", "replicates",
    "samples", "budget",     "population", "seed",         "reuse", "priority",  "executor"};

inline constexpr std::size_t kMostFitParameters = 20;
inline constexpr Range kFitBudgetRange{.minimum = 20, .maximum = 20'000};
inline constexpr Range kFitPopulationRange{.minimum = 5, .maximum = 1000};
inline constexpr Range kFitReplicatesRange{.minimum = 1, .maximum = 50};
inline constexpr Range kFitSamplesRange{.minimum = 10, .maximum = 20'000};
inline constexpr Range kFitSeedRange{.minimum = 0, .maximum = 4294967295.0};

/// Reads {"name", "parameters", "over": {path: {"from", "to", "scale", "start"}}, "measurements": [{"id",
/// "runs", "held_back_runs", "channels": {channel: {"weight", "noise"}}, "fitted": [[from, to]],
/// "held_back", "time_shift_s"}], "basis", "intervals", "replicates", "samples", "budget", "population",
/// "seed", "reuse", "priority", "executor"}; over and measurements are needed. Where parameters and runs do
/// not say otherwise, jobs last as long as the samples do, and their samples are at the times of evenly
/// spaced measured ones.
/// @throws InvalidRequest with every fault
[[nodiscard]] FitProblem parse_fit_request(const nlohmann::ordered_json& request,
                                           const FindMeasurement& find_measurement, std::size_t max_jobs);

}  // namespace jobs
