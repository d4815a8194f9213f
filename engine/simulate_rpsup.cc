#include "engine/simulate_rpsup.h"

#include <optional>

#include "engine/analysis/ideal_peak.h"
#include "engine/analysis/rpsup_quantities.h"
#include "engine/analysis/run_observer.h"
#include "engine/model/rpsup.h"
#include "engine/simulate.h"

namespace engine {

RunResult simulate_rpsup(const RpsupParameters& parameters, const RunOptions& options, const StopQuery& stop_requested) {
  check_parameters(parameters, options);
  const Rpsup rpsup = build_rpsup(parameters);
  RunObserver observer(RunMetrics(rpsup_measured(parameters, rpsup.layout)), RunChannels(rpsup_channels(parameters, rpsup), rpsup.mechanism.links),
                       stop_requested);
  const RunEnd end = simulate(rpsup.mechanism, options, observer);
  RunResult result{.status = end.status, .t_end = end.t, .detail = end.detail, .metrics = {}, .trajectory = {}};
  if (end.status == RunStatus::kSucceeded) {
    const std::optional<Peak> ideal = find_ideal_peak(parameters, parameters.run_up, options.duration, stop_requested);
    if (stop_requested && stop_requested(end.t)) {
      result.status = RunStatus::kStopped;
      result.detail = "stopped on request";
    } else {
      result.metrics = calc_rpsup_metrics(parameters, observer.metrics, end, ideal);
    }
  }
  result.trajectory = observer.channels.finish(observer.metrics.work_turned_over());
  return result;
}

}  // namespace engine
