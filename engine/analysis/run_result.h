// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/analysis/quantities.h"
#include "engine/model/run_options.h"

namespace engine {

/// Result of a run.
struct RunResult {
  RunStatus status = RunStatus::kSucceeded;
  double t_end = 0.0;           ///< time reached, [s]
  std::string detail;           ///< of a failure: what happened, for the user
  /// One for each of the linkage's metrics (metric_table() of RPSUP's); NaN: does not apply to this run.
  /// Empty on failure.
  std::vector<double> metrics = {};
  Trajectory trajectory = {};
};

/// Asked now and then (every 256 steps) with the simulated time; true ends the run with kStopped.
using StopQuery = std::function<bool(double t)>;

}  // namespace engine
