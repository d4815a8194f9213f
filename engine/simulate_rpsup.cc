// SPDX-License-Identifier: Apache-2.0
#include "engine/simulate_rpsup.h"

#include <optional>
#include <span>

#include "engine/analysis/ideal_peak.h"
#include "engine/analysis/rpsup_quantities.h"
#include "engine/analysis/run_observer.h"
#include "engine/analysis/sliding_work.h"
#include "engine/integrate/sample_times.h"
#include "engine/model/rpsup.h"
#include "engine/simulate.h"

namespace engine {

RunResult simulate_rpsup(const RpsupParameters& parameters, const RunOptions& options,
                         const StopQuery& stop_requested) {
  check_parameters(parameters, options);
  const Rpsup rpsup = build_rpsup(parameters);
  SlidingWork sliding_work(parameters);
  RunObserver observer(RunMetrics(rpsup_measured(parameters, rpsup)),
                       RunChannels(rpsup_channels(parameters, rpsup, sliding_work), rpsup.mechanism.links),
                       stop_requested, std::span(&sliding_work, 1));
  observer.channels.reserve(SampleTimes(options.output_rate, options.duration).count());
  const RunOutcome outcome = simulate(rpsup.mechanism, options, observer);
  RunResult result{.status = outcome.status, .t_end = outcome.t, .detail = outcome.detail};
  if (outcome.status == RunStatus::kSucceeded) {
    const std::optional<Peak> ideal =
        find_ideal_peak(parameters, parameters.run_up, options.duration, stop_requested);
    if (stop_requested && stop_requested(outcome.t)) {
      result.status = RunStatus::kStopped;
      result.detail = "stopped on request";
    } else {
      result.metrics = calc_rpsup_metrics(parameters, observer.metrics, sliding_work, outcome, ideal);
    }
  }
  result.trajectory = observer.channels.finish(observer.metrics.energy_scale());
  return result;
}

}  // namespace engine
