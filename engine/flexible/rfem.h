#pragma once

#include <vector>

#include <Eigen/Core>

namespace engine {

/// A straight uniform rod along x, to be divided.
struct UniformRod {
  double length = 0.0;          ///< l, [m]
  double mass = 0.0;            ///< [kg]
  double I_x = 0.0;             ///< about its axis, [kg m^2]
  double diameter = 0.0;        ///< of the solid round section, [m]
  double youngs_modulus = 0.0;  ///< E, [Pa]
  double shear_modulus = 0.0;   ///< G, [Pa]
  double damping_ratio = 0.0;   ///< zeta of the first pinned-pinned bending mode, [1]
};

/// A rigid finite element: a piece of the rod, its frame's origin at the near end.
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

/// The modified rigid finite element method, section 2.2 of the paper: n_rfe elements and n_rfe - 1 sde between them.
struct DividedRod {
  std::vector<RigidElement> elements;
  SpringDamperElement sde;  ///< all alike
};

/// Divides the rod into n_sde = n_rfe - 1 equal segments with an sde in the middle of each; the pieces between are the elements.
///
///     S = diag(E I, E I, G J) / dl,  D = (2 zeta / omega_1) S,  omega_1 = (pi / l)^2 sqrt(E I l / m)
///
/// @param n_rfe  elements, >= 2
[[nodiscard]] DividedRod divide_rod(const UniformRod& rod, int n_rfe);

}  // namespace engine
