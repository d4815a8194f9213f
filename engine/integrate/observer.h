// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/dynamics/evaluation.h"

namespace engine {

/// What a run reports to whoever wants its results.
class Observer {
 public:
  virtual ~Observer() = default;

  /// After each accepted step, with everything known at its two ends.
  virtual void on_step(const Evaluation& start, const Evaluation& end) = 0;
  /// Asked after on_step(): whether what is in the step's middle should be told too, by on_middle(). Costs an evaluation.
  /// Left out where an interpolated state cannot be evaluated.
  [[nodiscard]] virtual bool wants_middle() { return false; }
  virtual void on_middle(const Evaluation&) {}
  /// At t = 0, at each multiple of the sample interval and at the end. Samples inside a step follow its on_step().
  virtual void on_sample(const Evaluation& at) = 0;
  /// Rings that came into contact in the step just reported.
  virtual void on_onsets(int count) = 0;
  /// Asked now and then; true ends the run.
  [[nodiscard]] virtual bool stop_requested(double t) = 0;
};

}  // namespace engine
