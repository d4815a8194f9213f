// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>

#include "engine/model/rpsup_parameters.h"
#include "validation/engine_names.h"
#include "validation/reference/taylor.h"

namespace validation {

/// C(u) = u - sin(2 pi u) / (2 pi), the cycloidal law.
[[nodiscard]] Taylor calc_cycloid(const Taylor& u);
/// Side whose acceleration counts at an instant where that of the rod's drive jumps. At t = 0 there is only
/// the one behind.
enum class Side { kBehind, kBefore };

/// psi^(1,1): from `crank_start` at rest to omega_0 by C in `run_up`, then on at that speed.
[[nodiscard]] Taylor calc_crank_angle(const RpsupParameters& parameters, double t);
/// z^(1,2): rise and return by the parameters' law, a pause, again; in the pause the S joint is `rod_start`
/// away from the crank's axis.
[[nodiscard]] Taylor calc_rod_displacement(const RpsupParameters& parameters, double t,
                                           Side side = Side::kBehind);
/// The slider of the ideal rigid linkage, the coupler's end on the guide:
///
///     z^(2,1) = S . d + W,  W = sqrt(l^2 - |S - (S . d) d|^2),  S = (r cos psi, r sin psi, 0) - (0, y_g,
///     z_g),  r = l_(1,2) + z^(1,2),
///
/// (0, y_g, z_g) the guide's place in the global frame, d = (cos a, 0, sin a) its direction.
[[nodiscard]] Taylor calc_slider(const RpsupParameters& parameters, double t, Side side = Side::kBehind);

/// A link's 4x4 transform into the global frame, and its first and second derivative by time.
struct LinkMotion {
  Eigen::Matrix4d T, T_d, T_dd;
};

/// All links of the ideal rigid linkage at one instant, in the order of `Link`, from geometry alone:
/// x_13 points from the S joint to the bearing, z_13 is the axis of joint R, at right angles to x_13 and to
/// the yoke's axis: the guide, or the slider's y.
[[nodiscard]] std::array<LinkMotion, kLinkCount> calc_ideal_motion(const RpsupParameters& parameters,
                                                                   double t, Side side = Side::kBehind);

/// Forces that make the ideal linkage move so, by Newton's and Euler's laws link after link.
struct IdealForces {
  Eigen::Vector3d reaction_W;   ///< of the coupler on the cross link, [N]
  double crank_torque;          ///< [N m]
  double rod_force;             ///< [N]
  double kinetic_energy;        ///< [J]
  double potential_energy;      ///< of gravity, [J]
  double power;                 ///< with which the sum of both grows, [W]
};
[[nodiscard]] IdealForces calc_ideal_forces(const RpsupParameters& parameters, double t,
                                            Side side = Side::kBehind);

}  // namespace validation
