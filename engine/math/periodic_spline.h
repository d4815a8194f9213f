// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace engine {

/// A smooth function of an angle, of period 2 pi: the uniform cubic B-spline whose coefficients are values at
/// equally spaced angles.
///
/// Twice continuously differentiable, within the values it is made of, and of their mean; it does not pass
/// through them but smooths: a cosine of wavelength n spacings comes out smaller by the part (1 - cos(2 pi /
/// n)) / 3.
class PeriodicSpline {
 public:
  /// A value of it and its derivatives by the angle.
  struct Point {
    double value, slope, bend;
  };

  /// @param values  three or more  @param first  angle of the first one, as a part of the spacing
  PeriodicSpline(std::vector<double> values, double first);

  [[nodiscard]] Point at(double angle) const;

 private:
  std::vector<double> values_;
  double first_;
  double spacing_;  ///< [rad]
};

}  // namespace engine
