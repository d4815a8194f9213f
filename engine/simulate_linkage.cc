// SPDX-License-Identifier: Apache-2.0
#include "engine/simulate_linkage.h"

#include "engine/analysis/linkage_quantities.h"
#include "engine/analysis/run_observer.h"
#include "engine/integrate/sample_times.h"
#include "engine/simulate.h"

namespace engine {

LinkageTables linkage_tables(const Linkage& linkage) {
  const BuiltLinkage built = build_linkage(linkage);
  const LinkageQuantities quantities(linkage, built, 0.0);
  return {quantities.channel_table(), quantities.metric_table()};
}

RunResult simulate_linkage(const Linkage& linkage, const RunOptions& options, double steady_from,
                           const StopQuery& stop_requested) {
  const BuiltLinkage built = check_linkage(linkage, options.integrator);
  LinkageQuantities quantities(linkage, built, steady_from);
  RunObserver observer(RunMetrics(quantities.measured()),
                       RunChannels(quantities.channels(), built.mechanism.links, quantities.prepare()),
                       stop_requested, quantities.sliding_work());
  observer.channels.reserve(SampleTimes(options.output_rate, options.duration).count());
  const RunOutcome outcome = simulate(built.mechanism, options, observer);
  RunResult result{.status = outcome.status, .t_end = outcome.t, .detail = outcome.detail};
  if (outcome.status == RunStatus::kSucceeded)
    result.metrics = quantities.calc_metrics(observer.metrics, outcome);
  result.trajectory = observer.channels.finish(0.0);
  return result;
}

}  // namespace engine
