// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "validation/engine_names.h"

namespace validation {

/// H = integral of r r^T dm over a body, r = (x, y, z, 1): the paper's pseudo-inertia matrix, Eq. (4).
/// @param com      centre of mass in the body's frame, [m]
/// @param inertia  about the frame's origin, [kg m^2]
[[nodiscard]] inline Eigen::Matrix4d calc_pseudo_inertia(double mass, const Eigen::Vector3d& com,
                                                         const Eigen::Matrix3d& inertia) {
  Eigen::Matrix4d H;
  H.topLeftCorner<3, 3>() = 0.5 * inertia.trace() * Eigen::Matrix3d::Identity() - inertia;
  H.topRightCorner<3, 1>() = mass * com;
  H.bottomLeftCorner<1, 3>() = (mass * com).transpose();
  H(3, 3) = mass;
  return H;
}

}  // namespace validation
