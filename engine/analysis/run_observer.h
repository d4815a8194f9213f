// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>

#include "engine/analysis/run_channels.h"
#include "engine/analysis/run_metrics.h"
#include "engine/analysis/run_result.h"
#include "engine/analysis/sliding_work.h"
#include "engine/integrate/observer.h"

namespace engine {

/// Gathers channels and metrics of one run.
class RunObserver : public Observer {
 public:
  /// @param sliding_work  what channels and metrics read of it; follows the run
  RunObserver(RunMetrics run_metrics, RunChannels run_channels, const StopQuery& stop_requested,
              std::span<SlidingWork> sliding_work = {})
      : metrics(std::move(run_metrics)),
        channels(std::move(run_channels)),
        stop_requested_(stop_requested),
        sliding_work_(sliding_work) {}

  void on_step(const Evaluation& start, const Evaluation& end) override {
    for (SlidingWork& work : sliding_work_) work.take_step(start, end);
    metrics.take_step(start, end);
    channels.take_step(start, end, metrics.loads());
  }
  [[nodiscard]] bool wants_middle() override { return metrics.wants_middle(); }
  void on_middle(const Evaluation& at) override {
    metrics.take_middle(at);
    channels.take_curves(metrics.loads());
  }
  void on_sample(const Evaluation& at) override { channels.take_sample(at); }
  void on_onsets(int rings, int faces) override { metrics.take_onsets(rings, faces); }
  [[nodiscard]] bool stop_requested(double t) override { return stop_requested_ && stop_requested_(t); }

  RunMetrics metrics;
  RunChannels channels;

 private:
  const StopQuery& stop_requested_;
  std::span<SlidingWork> sliding_work_;
};

}  // namespace engine
