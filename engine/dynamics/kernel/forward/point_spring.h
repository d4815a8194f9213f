// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/dynamics/cut_joint_motion.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/dual.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Force of a spring between two points, all in W.
template <typename T>
struct PointSpringForce {
  Vec3<T> from, to;   ///< its ends, [m]
  Vec3<T> force;      ///< on the second end; the opposite on the first, [N]
  T loss{};           ///< power that the damper dissipates, [W]
};

/// f = -(k (L - L_0) + d L') e, with e the unit vector from the first end to the second one. Where the ends
/// meet, e has no direction, and f = 0. Without free length and damper f = -k L e is smooth there, too.
/// @param from_body, to_body  frames of the bodies that the ends are on
template <typename T>
[[nodiscard]] RPSUP_INLINE PointSpringForce<T> calc_point_spring_force(const TreeSpring& spring,
                                                                       const Frame<T, T>& from_body,
                                                                       const Frame<T, T>& to_body) {
  const Frame<T, T> from = placed_frame(spring.from, from_body, false);
  const Frame<T, T> to = placed_frame(spring.to, to_body, false);
  PointSpringForce<T> result{from.p, to.p, {}, {}};
  const Vec3<T> displacement = to.p - from.p;
  const T length = sqrt(dot(displacement, displacement));
  T per_length = spring.stiffness;
  if (value_of(length) > 0.0) {
    const T rate = dot(displacement, to.v - from.v) / length;
    per_length -= (spring.stiffness * spring.free_length - spring.damping * rate) / length;
    result.loss = spring.damping * (rate * rate);
  }
  result.force = -per_length * displacement;
  return result;
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
