// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/dynamics/cut_joint_motion.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/dual.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// A spring between two points at one instant, all in W.
template <typename T>
struct SpringPull {
  Vec3<T> from, to;   ///< its ends, [m]
  Vec3<T> force;      ///< on the second end; the opposite on the first, [N]
  T loss{};           ///< what the damper takes, [W]
};

/// f = -(k (L - L_0) + d L') e with e from the first end to the second one; where the ends meet, without a direction, 0. Without free
/// length and damper that is -k L e, smooth there as well.
/// @param from_body, to_body  frames of the bodies that the ends are on
template <typename T>
[[nodiscard]] RPSUP_INLINE SpringPull<T> calc_spring_pull(const TreeSpring& spring, const Frame<T, T>& from_body, const Frame<T, T>& to_body) {
  const Frame<T, T> from = place(spring.from, from_body, false);
  const Frame<T, T> to = place(spring.to, to_body, false);
  SpringPull<T> pull{from.p, to.p, {}, {}};
  const Vec3<T> way = to.p - from.p;
  const T length = sqrt(dot(way, way));
  T per_length = spring.stiffness;
  if (value_of(length) > 0.0) {
    const T rate = dot(way, to.v - from.v) / length;
    per_length -= (spring.stiffness * spring.free_length - spring.damping * rate) / length;
    pull.loss = spring.damping * (rate * rate);
  }
  pull.force = -per_length * way;
  return pull;
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
