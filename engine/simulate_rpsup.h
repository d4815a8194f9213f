#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/rpsup_parameters.h"
#include "engine/run_options.h"

namespace engine {

/// One column of a trajectory or one metric: its key ends in its unit.
struct QuantityInfo {
  std::string key;
  std::string help;
  bool integer = false;           ///< metrics: a count
  bool single_precision = false;  ///< channels: 24 bits are enough to store it (poses that are drawn)
};

/// Samples at k / output_rate, k = 0, 1, ...; a last one at the end of the run if that falls between two.
struct Trajectory {
  std::vector<QuantityInfo> channels;        ///< the first one is t_s
  std::vector<std::vector<double>> columns;  ///< one a channel, all of one length
};

/// What a run leaves behind.
struct RunResult {
  RunStatus status = RunStatus::kSucceeded;
  double t_end = 0.0;           ///< time reached, [s]
  std::string detail;           ///< of a failure: what happened, for the user
  std::vector<double> metrics;  ///< one for each of metric_table(); NaN: does not apply to this run. Empty on failure
  Trajectory trajectory;
};

/// The metrics that every run yields, in the order of RunResult::metrics.
[[nodiscard]] std::span<const QuantityInfo> metric_table();

/// The channels of a run with these parameters (a flexible coupler has a pose for each of its elements).
[[nodiscard]] std::vector<QuantityInfo> channel_table(const RpsupParameters& parameters);

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
