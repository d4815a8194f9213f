// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "engine/kinematics/frame_motion.h"
#include "engine/model/mechanism.h"

namespace engine {

/// A spring between two points at one instant, in W.
struct SpringMotion {
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();  ///< its ends, [m]
  double length = 0.0;                              ///< L, [m]
  double tension = 0.0;  ///< k (L - L_0) + d L', [N]; where the ends meet, without a direction, 0
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< on the second end; the opposite on the first, [N]
};

/// @param frames  one a coordinate
[[nodiscard]] SpringMotion calc_spring_motion(const PointSpring& spring,
                                              const std::vector<FrameMotion>& frames);

}  // namespace engine
