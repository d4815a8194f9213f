// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace engine {

/// The quartic through five values at s = 0, 1, 2, 3, 4.
class Quartic {
 public:
  Quartic() = default;
  Quartic(double f0, double f1, double f2, double f3, double f4) {
    const double d1 = f1 - f0;
    const double d2 = f2 - 2.0 * f1 + f0;
    const double d3 = f3 - 3.0 * (f2 - f1) - f0;
    const double d4 = f4 - 4.0 * (f3 + f1) + 6.0 * f2 + f0;
    c0_ = f0;
    c1_ = d1 - d2 / 2.0 + d3 / 3.0 - d4 / 4.0;
    c2_ = d2 / 2.0 - d3 / 2.0 + 11.0 * d4 / 24.0;
    c3_ = d3 / 6.0 - d4 / 4.0;
    c4_ = d4 / 24.0;
  }

  [[nodiscard]] double slope(double s) const {
    return c1_ + s * (2.0 * c2_ + s * (3.0 * c3_ + s * 4.0 * c4_));
  }
  /// Integral from 0 to s.
  [[nodiscard]] double integral(double s) const {
    return s * (c0_ + s * (c1_ / 2.0 + s * (c2_ / 3.0 + s * (c3_ / 4.0 + s * c4_ / 5.0))));
  }
  /// Its fourth difference: the fifth value less that of the cubic through the other four.
  [[nodiscard]] double fourth_difference() const { return 24.0 * c4_; }

 private:
  double c0_ = 0.0, c1_ = 0.0, c2_ = 0.0, c3_ = 0.0, c4_ = 0.0;
};

}  // namespace engine
