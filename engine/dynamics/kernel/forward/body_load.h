// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "engine/dynamics/cut_joint_motion.h"
#include "engine/dynamics/kernel/forward/applied_loads.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/vec3.h"
#include "engine/model/signal.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// A load on a body, all in W.
template <typename T>
struct BodyLoadForce {
  Vec3<T> p;              ///< point of action, [m]
  Vec3<T> force, moment;  ///< [N], [N m] about p
  T power{};              ///< [W]
};

/// @param factor  value of the load's law
template <typename T>
[[nodiscard]] RPSUP_INLINE BodyLoadForce<T> calc_body_load(const TreeBodyLoad& load, const Frame<T, T>& body,
                                                           const T& factor) {
  const Frame<T, T> at = placed_frame(load.at, body, false);
  const auto direct = [&](const std::array<double, 3>& along) RPSUP_INLINE_LAMBDA {
    const Vec3<T> scaled{factor * along[0], factor * along[1], factor * along[2]};
    return load.follows_body ? body.R * scaled : scaled;
  };
  BodyLoadForce<T> result{at.p, direct(load.force), direct(load.moment), {}};
  result.power = dot(result.force, at.v) + dot(result.moment, body.w);
  return result;
}

/// Subtracts the loads from the bias forces of their bodies.
/// @param loads  out  @param frames, bias_force  one a joint
template <typename Frames, typename Loads, typename Forces>
RPSUP_INLINE void subtract_body_loads(const TreeModel& model, const SignalPoint* laws,
                                      const Frame<double, double>& ground, const Frames& frames,
                                      Loads& loads, Forces& bias_force) {
  for (std::size_t k = 0; k < loads.size(); ++k) {
    const int joint = model.body_loads[k].joint;
    loads[k] = calc_body_load(model.body_loads[k], joint < 0 ? ground : frames[joint], laws[k].value);
    subtract_point_force(joint, loads[k].p, loads[k].force, frames, bias_force);
    if (joint >= 0) bias_force[joint].moment -= loads[k].moment;
  }
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
