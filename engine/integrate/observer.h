// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/dynamics/evaluation.h"

namespace engine {

/// Receives the results of a run.
class Observer {
 public:
  virtual ~Observer() = default;

  /// After each accepted step, with everything known at its two ends.
  virtual void on_step(const Evaluation& start, const Evaluation& end) = 0;
  /// Asked after on_step(): whether on_middle() should report the step's middle. Costs an evaluation. Left
  /// out where the interpolated state cannot be evaluated.
  [[nodiscard]] virtual bool wants_middle() { return false; }
  virtual void on_middle(const Evaluation&) {}
  /// At t = 0, at each multiple of the sample interval and at the end. Samples inside a step follow its
  /// on_step().
  virtual void on_sample(const Evaluation& at) = 0;
  /// Rings and faces that came into contact in the step just reported.
  virtual void on_onsets(int rings, int faces) = 0;
  /// Asked now and then; true ends the run.
  [[nodiscard]] virtual bool stop_requested(double t) = 0;
};

}  // namespace engine
