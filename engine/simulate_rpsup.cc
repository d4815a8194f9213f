#include "engine/simulate_rpsup.h"

#include <optional>

#include "engine/analysis/ideal_peak.h"
#include "engine/analysis/rpsup_channels.h"
#include "engine/analysis/rpsup_metrics.h"
#include "engine/model/rpsup.h"
#include "engine/simulate.h"

namespace engine {

namespace {

class RpsupObserver : public Observer {
 public:
  RpsupObserver(const RpsupParameters& parameters, const Rpsup& rpsup, const StopQuery& stop_requested)
      : metrics(parameters, rpsup.layout), channels(parameters, rpsup), stop_requested_(stop_requested) {}

  void on_step(const Evaluation& start, const Evaluation& end) override {
    metrics.take_step(start, end);
    channels.take_step(start, end);
  }
  [[nodiscard]] bool wants_middle() override { return metrics.wants_middle(); }
  void on_middle(const Evaluation& at) override { metrics.take_middle(at); }
  void on_sample(const Evaluation& at) override { channels.take_sample(at); }
  void on_onsets(int count) override { metrics.take_onsets(count); }
  [[nodiscard]] bool stop_requested(double t) override { return stop_requested_ && stop_requested_(t); }

  RpsupMetrics metrics;
  RpsupChannels channels;

 private:
  const StopQuery& stop_requested_;
};

}  // namespace

RunResult simulate_rpsup(const RpsupParameters& parameters, const RunOptions& options, const StopQuery& stop_requested) {
  check_parameters(parameters, options);
  const Rpsup rpsup = build_rpsup(parameters);
  RpsupObserver observer(parameters, rpsup, stop_requested);
  const RunEnd end = simulate(rpsup.mechanism, options, observer);
  RunResult result{.status = end.status, .t_end = end.t, .detail = end.detail, .metrics = {}, .trajectory = {}};
  if (end.status == RunStatus::kSucceeded) {
    const std::optional<Peak> ideal = find_ideal_peak(parameters, parameters.run_up, options.duration, stop_requested);
    if (stop_requested && stop_requested(end.t)) {
      result.status = RunStatus::kStopped;
      result.detail = "stopped on request";
    } else {
      result.metrics = observer.metrics.calc(end, ideal, observer.channels.sliding_work().total());
    }
  }
  result.trajectory = observer.channels.finish(observer.metrics.work_turned_over());
  return result;
}

}  // namespace engine
