#pragma once

#include <array>

#include <Eigen/Core>

#include "engine/model/rpsup_parameters.h"
#include "engine/validation/reference/taylor.h"

namespace engine::validation {

/// C(u) = u - sin(2 pi u) / (2 pi), the cycloidal law of both drives.
[[nodiscard]] Taylor calc_cycloid(const Taylor& u);
/// psi^(1,1): from rest to omega_0 by C in `run_up`, then on at that speed.
[[nodiscard]] Taylor calc_crank_angle(const RpsupParameters& parameters, double t);
/// z^(1,2): rise and return by C, a pause, again.
[[nodiscard]] Taylor calc_rod_displacement(const RpsupParameters& parameters, double t);
/// The slider of the ideal rigid linkage,
///
///     z^(2,1) = r cos psi + W,  W = sqrt(l^2 - z_g^2 - (r sin psi - y_g)^2),  r = l_(1,2) + z^(1,2),
///
/// (y_g, z_g) the guide's place in the global frame: the coupler's end lies on the guide.
[[nodiscard]] Taylor calc_slider(const RpsupParameters& parameters, double t);

/// A link's 4x4 transform into the global frame, and its first and second derivative by time.
struct LinkMotion {
  Eigen::Matrix4d T, T_d, T_dd;
};

/// All links of the ideal rigid linkage at one instant, in the order of `Link`, from geometry alone:
/// x_13 points from the S joint to the bearing, z_13 is the axis of joint R, at right angles to x_13 and to the axis y of the cross link.
[[nodiscard]] std::array<LinkMotion, kLinkCount> calc_ideal_motion(const RpsupParameters& parameters, double t);

/// Forces that make the ideal linkage move so, by Newton's and Euler's laws link after link.
struct IdealForces {
  Eigen::Vector3d reaction_W;   ///< of the coupler on the cross link, [N]
  double crank_torque;          ///< [N m]
  double rod_force;             ///< [N]
  double kinetic_energy;        ///< [J]
  double potential_energy;      ///< of gravity, [J]
  double power;                 ///< with which the sum of both grows, [W]
};
[[nodiscard]] IdealForces calc_ideal_forces(const RpsupParameters& parameters, double t);

}  // namespace engine::validation
