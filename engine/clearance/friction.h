#pragma once

#include <Eigen/Core>

#include "engine/clearance/contact_law.h"

namespace engine {

/// What LuGre's law gives at one contact: force per normal force, and the bristle's rate. Both in the tangent frame (t, axial).
struct BristleForce {
  Eigen::Vector2d force_ratio;   ///< sigma_0 z + sigma_1 zd + sigma_2 v, [1]; it acts against v
  Eigen::Vector2d bristle_rate;  ///< zd, [m/s]
};

/// LuGre friction with a vector bristle z, Eqs. (11.2) and (13.1): zd = v - sigma_0 |v| z / g(|v|).
/// @param v  tangential velocity of the journal's material point relative to the bearing's, [m/s]
/// @param z  bristle deflection, [m]
[[nodiscard]] inline BristleForce calc_bristle_force(const LuGreParameters& p, const Eigen::Vector2d& v, const Eigen::Vector2d& z) {
  const double decay = calc_bristle_decay(p, v.norm());
  const BristleLaw<double> along_t = calc_bristle_law(p, decay, v[0], z[0]);
  const BristleLaw<double> along_z = calc_bristle_law(p, decay, v[1], z[1]);
  return {{along_t.force_ratio, along_z.force_ratio}, {along_t.rate, along_z.rate}};
}

}  // namespace engine
