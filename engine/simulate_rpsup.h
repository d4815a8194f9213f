#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/analysis/quantities.h"
#include "engine/model/rpsup_parameters.h"
#include "engine/model/run_options.h"

namespace engine {

/// What a run leaves behind.
struct RunResult {
  RunStatus status = RunStatus::kSucceeded;
  double t_end = 0.0;           ///< time reached, [s]
  std::string detail;           ///< of a failure: what happened, for the user
  std::vector<double> metrics;  ///< one for each of metric_table(); NaN: does not apply to this run. Empty on failure
  Trajectory trajectory;
};

/// Refuses parameters that are no linkage: values out of bounds, an inertia no body can have, a guide out of reach
/// of the coupler somewhere in the motion.
/// @throws InvalidInput for the first fault; its field is the name of the member, "links.1,3.inertia" for a link's, "reach" where
///         no single one is at fault.
void check_parameters(const RpsupParameters& parameters, const RunOptions& options);

/// Asked now and then (some hundred times a second of computing) with the simulated time; true ends the run with kStopped.
using StopQuery = std::function<bool(double t)>;

/// Simulates one linkage from rest in its assembled position.
/// The same parameters give the same bytes, whatever else the process does.
/// @throws InvalidInput as check_parameters does.
[[nodiscard]] RunResult simulate_rpsup(const RpsupParameters& parameters, const RunOptions& options,
                                       const StopQuery& stop_requested);

}  // namespace engine
