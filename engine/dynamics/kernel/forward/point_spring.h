// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "engine/dynamics/cut_joint_motion.h"
#include "engine/dynamics/kernel/forward/applied_loads.h"
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
  T loss{};           ///< power that damper and drag dissipate, [W]
};

/// f = -(k (L - L_0) + d L') e - c v, with e the unit vector from the first end to the second one and v the
/// second one's velocity relative to the first. Where the ends meet, e has no direction, and f = -c v.
/// Without free length and damper f = -k L e - c v is smooth there, too.
/// @param from_body, to_body  frames of the bodies that the ends are on
template <typename T>
[[nodiscard]] RPSUP_INLINE PointSpringForce<T> calc_point_spring_force(const TreeSpring& spring,
                                                                       const Frame<T, T>& from_body,
                                                                       const Frame<T, T>& to_body) {
  const Frame<T, T> from = placed_frame(spring.from, from_body, false);
  const Frame<T, T> to = placed_frame(spring.to, to_body, false);
  PointSpringForce<T> result{from.p, to.p, {}, {}};
  const Vec3<T> displacement = to.p - from.p, velocity = to.v - from.v;
  const T length = sqrt(dot(displacement, displacement));
  T per_length = spring.stiffness;
  if (value_of(length) > 0.0) {
    const T rate = dot(displacement, velocity) / length;
    per_length -= (spring.stiffness * spring.free_length - spring.damping * rate) / length;
    result.loss = spring.damping * (rate * rate);
  }
  result.loss += spring.drag * dot(velocity, velocity);
  result.force = -per_length * displacement - spring.drag * velocity;
  return result;
}

/// Subtracts the springs' forces from the bias forces of their bodies.
/// @param forces  out, one a spring  @param frames, bias_force  one a joint
template <typename Frames, typename SpringForces, typename Forces>
RPSUP_INLINE void subtract_point_springs(const TreeModel& model, const Frame<double, double>& ground,
                                         const Frames& frames, SpringForces& forces, Forces& bias_force) {
  const auto frame_of = [&](int joint)
                            RPSUP_INLINE_LAMBDA -> const Frame<double, double>& {
    return joint < 0 ? ground : frames[joint];
  };
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const TreeSpring& spring = model.springs[k];
    forces[k] = calc_point_spring_force(spring, frame_of(spring.from_joint), frame_of(spring.to_joint));
    subtract_point_force(spring.to_joint, forces[k].to, forces[k].force, frames, bias_force);
    subtract_point_force(spring.from_joint, forces[k].from, -forces[k].force, frames, bias_force);
  }
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
