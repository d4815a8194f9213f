// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/model/driven_motion.h"
#include "engine/model/table_curve.h"

namespace engine {

/// Velocities at instants. The position is their exact integral.
class VelocityTable {
 public:
  /// @param t, v   one point or more, t rising, [s] and [rad/s] or [m/s]
  /// @param start  position at t = 0, [rad] or [m]
  VelocityTable(const std::vector<double>& t, const std::vector<double>& v, TableInterpolation interpolation,
                double start)
      : curve_(t, v, interpolation), start_(start) {}

  [[nodiscard]] DrivenMotion calc(double t) const;
  [[nodiscard]] double next_point(double t) const { return curve_.next_point(t); }
  [[nodiscard]] double next_jump(double t) const { return curve_.next_kink(t); }  ///< of the acceleration
  [[nodiscard]] double time_scale(double t) const;

 private:
  TableCurve curve_;
  double start_;
};

}  // namespace engine
