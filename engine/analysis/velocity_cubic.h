// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

namespace engine {

/// A velocity inside a step: the cubic through its values and accelerations at both ends.
class VelocityCubic {
 public:
  /// @param dt  [s], > 0
  VelocityCubic(double v0, double a0, double v1, double a1, double dt)
      : v0_(v0),
        b_(dt * a0),
        c_(3.0 * (v1 - v0) - dt * (2.0 * a0 + a1)),
        d_(2.0 * (v0 - v1) + dt * (a0 + a1)) {}

  [[nodiscard]] double value(double s) const { return v0_ + s * (b_ + s * (c_ + s * d_)); }

  /// Integral between two positions, in units of the step.
  [[nodiscard]] double integrate(double from, double to) const { return primitive(to) - primitive(from); }

  /// Both ends of the part from `from` to 1, and its extremes; the ends again where it has none.
  [[nodiscard]] std::array<double, 4> find_candidates(double from) const {
    const double root = std::sqrt(c_ * c_ - 3.0 * b_ * d_);  // not a number without extremes: no
                                                             // comparison holds then
    const double q = -(c_ + std::copysign(root, c_));
    return {from, 1.0, inside(q / (3.0 * d_), from), inside(b_ / q, from)};
  }

 private:
  [[nodiscard]] static double inside(double s, double from) { return s > from && s < 1.0 ? s : from; }
  [[nodiscard]] double primitive(double s) const {
    return s * (v0_ + s * (b_ / 2.0 + s * (c_ / 3.0 + s * d_ / 4.0)));
  }

  double v0_, b_, c_, d_;
};

}  // namespace engine
