#pragma once

#include <cmath>

#include <Eigen/Core>

#include "engine/clearance/clearance_parameters.h"

namespace engine {

/// What LuGre's law gives at one contact: force per normal force, and the bristle's rate. Both in the tangent frame (t, axial).
struct BristleForce {
  Eigen::Vector2d force_ratio;   ///< sigma_0 z + sigma_1 zd + sigma_2 v, [1]; it acts against v
  Eigen::Vector2d bristle_rate;  ///< zd, [m/s]
};

/// Stribeck's curve g(|v|) = mu_k + (mu_s - mu_k) exp(-(v / v_s)^2). Beyond (v / v_s)^2 = 40 the exponential is below rounding.
[[nodiscard]] inline double calc_stribeck(const LuGreParameters& p, double speed) {
  const double ratio = speed / p.v_s;
  const double squared = ratio * ratio;
  return squared > 40.0 ? p.mu_k : p.mu_k + (p.mu_s - p.mu_k) * std::exp(-squared);
}

/// LuGre friction with a vector bristle z, Eqs. (11.2) and (13.1): zd = v - sigma_0 |v| z / g(|v|).
/// @param v  tangential velocity of the journal's material point relative to the bearing's, [m/s]
/// @param z  bristle deflection, [m]
[[nodiscard]] inline BristleForce calc_bristle_force(const LuGreParameters& p, const Eigen::Vector2d& v, const Eigen::Vector2d& z) {
  const double speed = v.norm();
  const Eigen::Vector2d rate = v - (p.sigma_0 * speed / calc_stribeck(p, speed)) * z;
  return {p.sigma_0 * z + p.sigma_1 * rate + p.sigma_2 * v, rate};
}

}  // namespace engine
