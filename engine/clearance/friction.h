// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "engine/clearance/contact_law.h"

namespace engine {

/// Result of a friction law at one contact: force per normal force, and the bristle's rate. Both in the
/// tangent frame (t, axial).
struct BristleForce {
  Eigen::Vector2d force_ratio;   ///< sigma_0 z + sigma_1 zd + sigma_2 v, [1]; it acts against v
  Eigen::Vector2d bristle_rate;  ///< zd, [m/s]
};

/// Friction at one contact; LuGre with a vector bristle z, Eqs. (11.2) and (13.1): zd = v - sigma_0 |v| z /
/// g(|v|).
/// @param v  tangential velocity of the journal's material point relative to the bearing's, [m/s]
/// @param z  bristle deflection, [m]
[[nodiscard]] inline BristleForce calc_bristle_force(const FrictionParameters& p, const Eigen::Vector2d& v,
                                                     const Eigen::Vector2d& z) {
  const FrictionForce<double> friction = calc_friction(p, v[0], v[1], z[0], z[1]);
  return {{friction.along_t.force_ratio, friction.along_z.force_ratio},
          {friction.along_t.rate, friction.along_z.rate}};
}

}  // namespace engine
