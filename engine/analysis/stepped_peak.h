// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/analysis/step_quadratic.h"

namespace engine {

/// Largest magnitude of a quantity that is known at the ends of steps, and in a step's middle where that is
/// asked for. Read at the ends alone, an impact's peak would be up to 1 % low.
class SteppedPeak {
 public:
  /// Takes a step's ends. Steps follow each other.
  /// @returns true if the peak so far may be less than what is inside: the middle should be taken
  bool take_step(double start, double end, double t0, double t1) {
    const double slope = (end - start) / (t1 - t0);
    const bool has_extremum = steps_++ == 0 || may_have_extremum(end, slope, t1 - t0);
    peak_.take(start, t0);
    peak_.take(end, t1);
    start_ = start;
    end_ = end;
    t0_ = t0;
    dt_ = t1 - t0;
    slope_ = slope;
    curve_.reset();
    return has_extremum && std::max(std::abs(start), std::abs(end)) > kNear * peak_.magnitude;
  }

  /// Takes the value in the middle of the last step: what lies between is on the parabola through the three.
  void take_middle(double middle) {
    const double mean = (start_ + 4.0 * middle + end_) / 6.0;
    curve_ = StepQuadratic(start_, end_, mean * dt_, dt_);
    peak_.take(*curve_, 0.0, 1.0, t0_, dt_);
  }

  [[nodiscard]] const Peak& peak() const { return peak_; }
  /// Values at the ends of the last step.
  [[nodiscard]] double start() const { return start_; }
  [[nodiscard]] double end() const { return end_; }
  /// The quantity inside the last step, if the middle was taken.
  [[nodiscard]] const std::optional<StepQuadratic>& curve() const { return curve_; }

 private:
  static constexpr double kNear = 0.9;    ///< of the peak: an end this large may be the foot of a larger one
  /// Largest distance beyond the step, as a fraction of the step, of a guess of an extreme inside.
  static constexpr double kMargin = 0.5;

  /// @returns whether the parabola through the end of this step and the ends of the one before has its
  /// extreme in this step, or kMargin of it beyond. From the middle of the step on, its slope is 0 after the
  /// time -slope / (2 bend).
  [[nodiscard]] bool may_have_extremum(double end, double slope, double dt) const {
    const double sign = end < 0.0 ? -1.0 : 1.0;
    const double bend = sign * (slope - slope_) / (dt + dt_);  // half the second derivative
    return bend < 0.0 && std::abs(slope) < -2.0 * bend * (0.5 + kMargin) * dt;
  }

  Peak peak_;
  long steps_ = 0;
  double start_ = 0.0, end_ = 0.0, t0_ = 0.0, dt_ = 0.0, slope_ = 0.0;  ///< of the last step
  std::optional<StepQuadratic> curve_;
};

}  // namespace engine
