// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace engine {

/// Moments of a uniform rod along x about its end: I_y = I_z = m l^2 / 3 + I_x / 2, [kg m^2].
[[nodiscard]] inline Eigen::Vector3d calc_rod_inertia(double mass, double length, double I_x) {
  const double transverse = mass * length * length / 3.0 + 0.5 * I_x;
  return {I_x, transverse, transverse};
}

}  // namespace engine
