// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "engine/model/mechanism.h"
#include "validation/engine_names.h"

namespace validation {

/// The coupler of the study as a rod: E = 2.1e11 Pa, G = 0.8e11 Pa, d = 10 mm, l = 0.5 m.
struct Rod {
  double mass;  ///< [kg]
  double I_x;   ///< about its axis, [kg m^2]; half of it is the rotary inertia of its sections

  static constexpr double kLength = 0.5;  ///< [m]
  [[nodiscard]] static double EI();       ///< [N m^2]
  [[nodiscard]] static double GJ();       ///< [N m^2]
};

/// Solid, of this density: I_x = m r^2 / 2.
[[nodiscard]] Rod solid_rod(double density);

/// The same mass without rotary inertia (a part in 1e8 of it is left, for a mass matrix with an inverse).
[[nodiscard]] Rod slender(Rod rod);

/// Support of the near end. The far end is free.
enum class NearEnd {
  kClamped,    ///< the first rigid element is fixed to the ground
  kSpherical,  ///< as in the linkage
  kFree,       ///< three translations before the spherical joint
};

/// The flexible coupler cut out of the linkage as the engine builds it, without gravity, its near end at the
/// global origin.
[[nodiscard]] Mechanism cut_coupler(const Rod& rod, int segments, NearEnd near_end);

/// Mass matrix by the engine, at q = 0 and rest.
[[nodiscard]] Eigen::MatrixXd calc_mass_matrix(const Mechanism& mechanism);
/// The springs on the diagonal.
[[nodiscard]] Eigen::MatrixXd stiffness_matrix(const Mechanism& mechanism);
/// Velocity of the far end, in W, for unit rates at q = 0: 3 rows.
[[nodiscard]] Eigen::MatrixXd calc_tip_jacobian(const Mechanism& mechanism);

/// Natural frequencies of K x = omega^2 M x, rising, [Hz]; rigid motion gives 0.
/// @param constraint  rows that J x = 0 has to hold; may have none
[[nodiscard]] Eigen::VectorXd calc_frequencies(const Eigen::MatrixXd& M, const Eigen::MatrixXd& K,
                                               const Eigen::MatrixXd& constraint);

/// A bending mode by its ends and number.
enum class Ends { kPinnedPinned, kClampedFree, kFreeFree };
struct BendingMode {
  const char* name;
  Ends ends;
  int number;  ///< 1: the first that bends
};
inline constexpr BendingMode kBendingModes[] = {{"pinned-pinned, mode 1", Ends::kPinnedPinned, 1},
                                                {"clamped-free, mode 1", Ends::kClampedFree, 1},
                                                {"clamped-free, mode 2", Ends::kClampedFree, 2},
                                                {"free-free, mode 1", Ends::kFreeFree, 1}};

/// Frequency of the engine's divided coupler, bending in the x-y or the x-z plane, [Hz].
enum class Plane { kXY, kXZ };
[[nodiscard]] double engine_frequency(const Rod& rod, int segments, const BendingMode& mode,
                                      Plane plane = Plane::kXY);

/// The same division by another route: lateral displacements of the elements' ends as unknowns, matrices
/// assembled bar by bar.
[[nodiscard]] double bars_frequency(const Rod& rod, int segments, const BendingMode& mode);

/// The undivided rod, sections turning with it (Rayleigh), or without rotary inertia (Euler and Bernoulli).
/// [Hz]
[[nodiscard]] double rayleigh_frequency(const Rod& rod, const BendingMode& mode);
[[nodiscard]] double euler_bernoulli_frequency(const Rod& rod, const BendingMode& mode);

}  // namespace validation
