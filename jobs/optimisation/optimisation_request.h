// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/optimisation/local_search.h"
#include "jobs/optimisation/population_search.h"
#include "jobs/parameters/range.h"
#include "jobs/requests/sweep_request.h"
#include "jobs/requests/variable.h"

namespace jobs {

/// Keys of a request.
inline constexpr std::array<std::string_view, 15> kOptimisationRequestKeys{
    "name",     "parameters", "over",   "objectives", "bounds", "sweep", "replicates", "reuse",
    "priority", "executor",   "budget", "population", "starts", "seed",  "method"};
inline constexpr std::size_t kMostVariables = 50;
inline constexpr std::size_t kMostObjectives = 5;
inline constexpr Range kBudgetRange{.minimum = 5, .maximum = 1e6};
inline constexpr Range kPopulationRange{.minimum = 5, .maximum = 1000};
inline constexpr Range kStartsRange{.minimum = 1, .maximum = 20};
inline constexpr Range kOptimiserSeedRange{.minimum = 0, .maximum = 4294967295.0};

enum class Goal { kMinimise, kMaximise };

/// Part of a candidate's jobs that must be at least as good as the value that counts: the worst one does.
inline constexpr double kAll = 1.0;

/// Metric that is optimised: the value that a part of the jobs of one candidate reaches.
struct Objective {
  std::string metric;
  Goal goal = Goal::kMinimise;
  double quantile = kAll;
};

/// Metric that a part of the jobs of one candidate keeps within bounds.
struct MetricBound {
  std::string metric;
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  double quantile = kAll;
};

/// Request of an optimisation: the values of some parameters for which metrics are least or largest. Each
/// candidate (a value for each variable) is a case of a sweep, with a job for each combination of the axes
/// and each replicate.
struct OptimisationRequest {
  SweepRequest common;  ///< name, parameters, axes, replicates, reuse, priority and executor of all jobs
  std::vector<Variable> variables;
  std::vector<Objective> objectives;
  std::vector<MetricBound> bounds;
  PopulationMethod method = PopulationMethod::kCmaEs;
  std::optional<LocalMethod> local_method{};  ///< in the place of `method`
  std::size_t budget = 0;                     ///< most candidates of all starts together
  std::size_t population = 0;
  std::size_t starts = 1;  ///< searches from different first generations
  std::uint64_t seed = 1;
};

/// Reads {"name", "parameters", "over": {parameter: {"from", "to", "scale", "start"}}, "objectives":
/// [{"metric", "goal", "quantile"}], "bounds": [{"metric", "minimum", "maximum", "quantile"}], "sweep",
/// "replicates", "reuse", "priority", "executor", "method", "budget", "population", "starts", "seed"}; over
/// and objectives are needed. Without a quantile the worst value counts.
/// @throws InvalidRequest with every fault
[[nodiscard]] OptimisationRequest parse_optimisation_request(const nlohmann::ordered_json& request,
                                                             std::size_t max_jobs);

/// "cma_es", "nsga2", "nelder_mead" or "bobyqa".
[[nodiscard]] std::string_view method_name(const OptimisationRequest& request);

/// Number of jobs of one candidate.
[[nodiscard]] std::size_t jobs_of_a_candidate(const OptimisationRequest& request);

/// Values of the variables at a point: the nearest decimals of 12 digits, integers where a variable is one.
[[nodiscard]] std::vector<double> candidate_at(const OptimisationRequest& request, const UnitPoint& point);
/// The unit point of the variables' starts, those without one in the middle; empty if none has one.
[[nodiscard]] std::optional<UnitPoint> start_of(const OptimisationRequest& request);

/// A candidate as a case of a sweep.
[[nodiscard]] nlohmann::ordered_json case_of(const OptimisationRequest& request,
                                             const std::vector<double>& candidate);

/// The sweep of an optimisation without its cases. @param request  as the parser has read it
[[nodiscard]] nlohmann::ordered_json common_sweep_of(const nlohmann::ordered_json& request);

}  // namespace jobs
