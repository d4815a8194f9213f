// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/requests/axis.h"
#include "jobs/requests/design.h"

namespace jobs {

/// Keys of a request.
inline constexpr std::array<std::string_view, 10> kSweepRequestKeys{
    "name", "parameters", "sweep", "design", "cases", "replicates", "keep", "reuse", "priority", "executor"};

inline constexpr std::size_t kLongestName = 200;  ///< bytes
inline constexpr Range kPerturbationRange{.minimum = 0.0, .maximum = 0.1, .lower = Bound::kExclusive};
inline constexpr Range kToleranceFactorRange{.minimum = 0.0, .maximum = 1.0, .lower = Bound::kExclusive};
inline constexpr Range kPriorityRange{.minimum = -100, .maximum = 100};

/// Replicates of each point of a sweep, with slightly different contact stiffness, and tighter tolerances if
/// asked for.
struct Replicates {
  bool requested = false;       ///< whether rows carry `replicate`
  std::uint64_t count = 1;
  /// Lists of values by their paths: other points are run once; empty: none are
  nlohmann::json only = nlohmann::json::object();
  double perturbation = 1e-6;   ///< relative, of contact_stiffness_scale
  std::uint64_t seed = 1;
  double tolerance_factor = 1.0;  ///< of both tolerances, in all but the first
};

/// A sweep as it was asked for, checked as far as that can be done value by value.
struct SweepRequest {
  std::string name;
  nlohmann::json parameters = nlohmann::json::object();  ///< of all points
  std::vector<nlohmann::json> cases;                     ///< empty: none were given, which counts as one
  std::vector<Axis> axes;
  Design design;
  /// Paths that differ from job to job: the design's, the axes', those of the cases
  std::vector<std::string> swept;
  Replicates replicates;
  bool reuse = true;
  std::int64_t priority = 0;
  std::string executor;                                  ///< empty: none was named
};

/// Reads {"name", "parameters", "sweep", "design", "cases", "replicates", "keep", "reuse", "priority",
/// "executor"}; all are optional. "keep" is that of the parameters. The number of jobs is counted before
/// anything of that size is made.
/// @throws InvalidRequest with every fault; with that of the size only, if there are more than max_jobs
[[nodiscard]] SweepRequest parse_sweep_request(const nlohmann::ordered_json& request, std::size_t max_jobs);

/// Reads {"executor": name}, and returns the name. @throws InvalidRequest with every fault
[[nodiscard]] std::string parse_move_request(const nlohmann::json& request);

}  // namespace jobs
