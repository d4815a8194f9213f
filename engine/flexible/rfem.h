// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

namespace engine {

/// A straight uniform beam of round section along x.
struct RoundBeam {
  double length = 0.0;          ///< l, [m]
  double mass = 0.0;            ///< [kg]
  double I_x = 0.0;             ///< about its axis, [kg m^2]
  double diameter = 0.0;        ///< of the round section, [m]
  double youngs_modulus = 0.0;  ///< E, [Pa]
  double shear_modulus = 0.0;   ///< G, [Pa]
  double damping_ratio = 0.0;   ///< zeta of the first pinned-pinned bending mode, [1]
  double inner_diameter = 0.0;  ///< of a tube, below the other, [m]
};

/// A straight uniform beam of any section along x, its frame's axes those of the section.
struct UniformBeam {
  double length = 0.0;          ///< l, [m]
  double mass = 0.0;            ///< [kg]
  double I_x = 0.0;             ///< of the mass about its axis, [kg m^2]
  double share_y = 0.5;         ///< share of I_x about y: I_y / (I_y + I_z) of the section, [1]
  double EI_y = 0.0;            ///< bending stiffness about y, [N m^2]
  double EI_z = 0.0;            ///< about z, [N m^2]
  double GJ = 0.0;              ///< torsional stiffness, [N m^2]
  double damping_ratio = 0.0;   ///< zeta of the first pinned-pinned bending mode, [1]
};

/// A rigid finite element: a piece of the beam, its frame's origin at the near end.
struct RigidElement {
  double length = 0.0;                                  ///< [m]
  double mass = 0.0;                                    ///< [kg]
  Eigen::Vector3d inertia = Eigen::Vector3d::Zero();    ///< about the origin of its frame, [kg m^2]
};

/// Springs and dampers between two elements, for (psi, theta, phi) about (z, y, x).
struct SpringDamperElement {
  Eigen::Vector3d stiffness = Eigen::Vector3d::Zero();  ///< [N m/rad]
  Eigen::Vector3d damping = Eigen::Vector3d::Zero();    ///< [N m s/rad]
};

/// The modified rigid finite element method, section 2.2 of the paper: n_rfe elements and n_rfe - 1 sde
/// between them.
struct DividedBeam {
  std::vector<RigidElement> elements;
  SpringDamperElement sde;  ///< all alike
};

/// Divides the beam into n_sde = n_rfe - 1 equal segments with an sde in the middle of each; the pieces
/// between are the elements.
///
///     S = diag(E I, E I, G J) / dl,  D = (2 zeta / omega_1) S,  omega_1 = (pi / l)^2 sqrt(E I l / m)
///
/// Of a beam that is stiffer about one axis, S = diag(E I_z, E I_y, G J) / dl and omega_1 is that of the
/// softer one.
/// @param n_rfe  elements, >= 2
[[nodiscard]] DividedBeam divide_beam(const UniformBeam& beam, int n_rfe);

[[nodiscard]] UniformBeam make_beam(const RoundBeam& round);

/// Moments of a uniform beam along x about its end: I_y = m l^2 / 3 + share_y I_x, I_z with the other share,
/// [kg m^2].
[[nodiscard]] Eigen::Vector3d calc_beam_inertia(const UniformBeam& beam);

}  // namespace engine
