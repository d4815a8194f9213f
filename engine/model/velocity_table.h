// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/model/driven_motion.h"

namespace engine {

/// Interpolation between the points of a table.
enum class TableInterpolation {
  kLinear,         ///< straight: the acceleration of a VelocityTable jumps at the points
  kMonotoneCubic,  ///< piecewise cubic with a continuous slope and no extremes between the points: F. N.
                   ///< Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984), with one-sided slopes of
                   ///< second order at both ends
};

/// Velocities at instants; between them interpolated, and constant before the first and after the last of
/// them. The position is their exact integral.
class VelocityTable {
 public:
  /// @param t, v   one point or more, t rising, [s] and [rad/s] or [m/s]
  /// @param start  position at t = 0, [rad] or [m]
  VelocityTable(const std::vector<double>& t, const std::vector<double>& v, TableInterpolation interpolation,
                double start);

  [[nodiscard]] DrivenMotion calc(double t) const;
  [[nodiscard]] double next_point(double t) const;  ///< infinite behind the last
  [[nodiscard]] double next_jump(double t) const;   ///< of the acceleration; infinite behind the last
  [[nodiscard]] double time_scale(double t) const;

 private:
  /// From its instant to that of the next piece: v + s (a + s (b + s c)) with s the time since.
  struct Piece {
    double t = 0.0;
    double q = 0.0, v = 0.0, a = 0.0, b = 0.0, c = 0.0;
    bool jumps = false;  ///< whether the acceleration jumps where it begins
  };
  [[nodiscard]] const Piece& piece_of(double t) const;

  std::vector<Piece> pieces_;  ///< the first from ever on, the others from a point each
};

}  // namespace engine
