// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "engine/analysis/step_quadratic.h"

namespace bench {

/// Largest acceleration of the steady window from the inside of steps, given at their ends: the same measure
/// for every code.
class AccelerationPeak {
 public:
  explicit AccelerationPeak(double from) : from_(from) {}

  void take(double t, double velocity, double acceleration) {
    if (t > from_ && started_) {
      const double dt = t - t_;
      const engine::StepQuadratic a(acceleration_, acceleration, velocity - velocity_, dt);
      peak_.take(a, std::max(0.0, (from_ - t_) / dt), 1.0, t_, dt);
    }
    started_ = true;
    t_ = t;
    velocity_ = velocity;
    acceleration_ = acceleration;
  }

  [[nodiscard]] double magnitude() const { return peak_.magnitude; }

 private:
  double from_;
  engine::Peak peak_;
  bool started_ = false;
  double t_ = 0.0, velocity_ = 0.0, acceleration_ = 0.0;
};

}  // namespace bench
