// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "engine/model/drive_law.h"
#include "engine/model/mechanism.h"
#include "engine/model/rpsup_parameters.h"

namespace engine {

/// The paper's laws of the two driven coordinates, psi^(1,1) and z^(1,2).
[[nodiscard]] RunUp crank_law(const RpsupParameters& parameters);
[[nodiscard]] RiseReturnPause rod_law(const RpsupParameters& parameters);

/// The motions of the two driven coordinates, by those laws or by others in their place.
[[nodiscard]] DrivenMotion calc_crank_motion(const RpsupParameters& parameters, double t);
[[nodiscard]] DrivenMotion calc_rod_motion(const RpsupParameters& parameters, double t);

/// The guide's frame {g} in the global frame: x along the guide, y that of the global frame. The slider moves
/// along x, its axes are those of {g}.
[[nodiscard]] Placement guide_frame(const RpsupParameters& parameters);

/// The unit vector of gravity in the global frame.
[[nodiscard]] Eigen::Vector3d gravity_direction_W(Direction direction);

/// Centre of the S joint at time t, the end of the rod, in the global frame, [m]
[[nodiscard]] Eigen::Vector3d calc_s_joint_W(const RpsupParameters& parameters, double t);

/// Projection of the coupler, of length l, on the guide, squared, with the S joint at p_gS in {g} and the
/// cross link's length a:
///
///     yoke about the guide:  l^2 - rho^2 + a^2,  rho^2 = y^2 + z^2
///     yoke across it:        l^2 - y^2 - max(0, z^2 - a^2)
///
/// Negative or zero: the linkage cannot be assembled there, or locks. [m^2]
[[nodiscard]] double calc_coupler_projection_squared(const RpsupParameters& parameters,
                                                     const Eigen::Vector3d& p_gS);
[[nodiscard]] double calc_coupler_projection_squared(const RpsupParameters& parameters, double t);

/// Distance rho of the S joint from the guide, less the cross link's length a, [m]. With the yoke about the
/// guide the linkage cannot be assembled below 0; at 0 its two ways of assembly meet.
[[nodiscard]] double calc_yoke_arm(const RpsupParameters& parameters, double t);

/// Start of Newton's method, which closes the loop at t = 0.
struct AssemblyGuess {
  double psi_13 = 0.0, theta_13 = 0.0, phi_13 = 0.0;  ///< of the S joint, [rad]
  double z_21 = 0.0;                                  ///< [m]
  double psi_22 = 0.0;                                ///< [rad]
};

/// With the yoke about the guide the closed form, rounded to 1e-6 so that a description of the linkage can
/// give the same numbers; else the coupler laid along the guide.
[[nodiscard]] AssemblyGuess calc_assembly_guess(const RpsupParameters& parameters);

}  // namespace engine
