// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>

#include "engine/analysis/step_quadratic.h"

namespace engine {

/// Least and largest value of a quantity since the last sample. Values count at samples, at the ends of steps
/// and where a step's curve has its extremum, if the curve is known: the values of which a metric's peak is
/// the largest.
class SampleExtremes {
 public:
  void take_step(double start, double end) {
    start_ = start;
    end_ = end;
    curve_.reset();
  }

  /// The quantity inside the last step.
  void take_curve(const StepQuadratic& curve) { curve_ = curve; }

  /// Takes a part of the last step, given by fractions of the step.
  void take_part(double from, double to) {
    if (from <= 0.0) take(start_);
    if (to >= 1.0) take(end_);
    if (!curve_) return;
    const double s = curve_->find_extremum(from, to);
    if (s > from) take(curve_->value(s));
  }

  void take(double value) {
    least_ = std::min(least_, value);
    largest_ = std::max(largest_, value);
  }

  /// Begins anew at a sample.
  void restart(double value) { least_ = largest_ = value; }

  [[nodiscard]] double least() const { return least_; }
  [[nodiscard]] double largest() const { return largest_; }

 private:
  double least_ = 0.0, largest_ = 0.0;
  double start_ = 0.0, end_ = 0.0;
  std::optional<StepQuadratic> curve_;
};

}  // namespace engine
