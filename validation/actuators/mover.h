// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "engine/model/linkage.h"
#include "validation/support/linkage_runs.h"

namespace validation {

inline constexpr double kFlywheelInertia = 0.02;  // moment of inertia, [kg m^2]
inline constexpr double kBlockMass = 2.0;         // mass, [kg]

/// A flywheel on a shaft, or a block on a level slide: one freedom "q", which nothing but its actuator and its
/// load moves.
[[nodiscard]] inline Linkage make_mover(JointKind kind, LinkageFreedom freedom) {
  Linkage linkage;
  linkage.bodies = {
      {.name = "body", .mass = kBlockMass, .inertia = kFlywheelInertia * Eigen::Matrix3d::Identity().eval()}};
  linkage.joints = {{.name = "joint",
                     .kind = kind,
                     .from = kGroundName,
                     .to = "body",
                     .placement = {},
                     .freedoms = {std::move(freedom)}}};
  return linkage;
}

}  // namespace validation
