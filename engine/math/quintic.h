// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace engine {

/// The course of a coordinate over a step as the polynomial of fifth degree with the given values, rates and
/// accelerations at both ends. s is the position in the step, [1]: 0 its start, 1 its end.
class Quintic {
 public:
  Quintic(double dt, double q0, double qd0, double qdd0, double q1, double qd1, double qdd1)
      : dt_(dt), q0_(q0), v0_(dt * qd0), a0_(dt * dt * qdd0) {
    const double v1 = dt * qd1;
    const double a1 = dt * dt * qdd1;
    const double d = q1 - q0 - v0_ - 0.5 * a0_;
    const double dv = v1 - v0_ - a0_;
    const double da = a1 - a0_;
    c3_ = 10.0 * d - 4.0 * dv + 0.5 * da;
    c4_ = -15.0 * d + 7.0 * dv - da;
    c5_ = 6.0 * d - 3.0 * dv + 0.5 * da;
  }

  [[nodiscard]] double value(double s) const {
    return q0_ + s * (v0_ + s * (0.5 * a0_ + s * (c3_ + s * (c4_ + s * c5_))));
  }
  [[nodiscard]] double rate(double s) const {
    return (v0_ + s * (a0_ + s * (3.0 * c3_ + s * (4.0 * c4_ + s * 5.0 * c5_)))) / dt_;
  }
  [[nodiscard]] double acceleration(double s) const {
    return (a0_ + s * (6.0 * c3_ + s * (12.0 * c4_ + s * 20.0 * c5_))) / (dt_ * dt_);
  }

 private:
  double dt_;
  double q0_, v0_, a0_, c3_, c4_, c5_;  ///< of q0 + v0 s + a0 s^2 / 2 + c3 s^3 + c4 s^4 + c5 s^5
};

}  // namespace engine
