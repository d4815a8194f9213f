// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "engine/clearance/cylinder_contact.h"
#include "engine/clearance/friction_parameters.h"
#include "engine/clearance/worn_bore.h"

namespace engine {

enum class RadialForm { kContinuum, kElements };

/// Surfaces that meet in a joint with clearance.
enum class ContactGeometry {
  kJournalInBore,  ///< cylinder in cylinder: revolute and, without faces, cylindrical joints
  kBallInSocket,   ///< sphere in sphere: spherical joints
  kBlockInSlot,    ///< eight corners of a block between two pairs of planes: prismatic joints
};

/// A joint with clearance, by default a revolute one: a journal of length L_b in a bearing, contact on the
/// bore and on the two faces. The second part of every joint is called the journal, the first the bearing.
/// The paper's joint has other numbers: see RpsupParameters.
struct ClearanceParameters {
  ContactGeometry geometry = ContactGeometry::kJournalInBore;
  double r_b = 5e-3;               ///< radius of bearing or socket, [m]
  double c_r = 0.25e-3;            ///< radial clearance, of a block that along x, [m], 0 < c_r < r_b
  double c_a = 0.0;                ///< axial clearance at each face, [m], >= 0; infinite: no faces
  double L_b = 20e-3;              ///< of journal or block, along z, [m]
  double block_x = 0.0;            ///< half the width of a block along x, [m]
  double block_y = 0.0;            ///< the same along y, [m]
  double c_y = 0.0;                ///< clearance of a block along y, [m], > 0
  RadialForm form = RadialForm::kContinuum;
  int n_r = 2;                     ///< rings
  int n_ce = 180;                  ///< elements on a ring (kElements)
  int n_a = 1;                     ///< circles of points on a face
  int n_ce_axial = 8;              ///< points on a circle
  double K = 4.7e10;               ///< Hertz stiffness of the whole bore, of a corner of a block, [N/m^1.5]
  CylinderContact cylinders{};     ///< kContinuum: in the place of Hertz's law, if it has another
  double K_a = 1e8;                ///< stiffness of one face, [N/m]
  double chi = 0.1425;             ///< damping factor of the normal law, [1]
  double damping = 0.0;            ///< Kelvin and Voigt's, of the whole bore, each face or corner, [N s/m]
  double minimum_onset_rate = 1e-3;///< floor of the latched penetration rate, [m/s]
  std::optional<FrictionParameters> friction;
  std::shared_ptr<const WornBore> worn;  ///< kContinuum: of as many rings; null: the bore is round

  [[nodiscard]] double r_j() const { return r_b - c_r; }  ///< journal radius, [m]
};

/// Hertz stiffness of a sphere on a plane: K = 4 / (3 pi 2 h) sqrt(R), h = (1 - nu^2) / (pi E).
/// @param radius  R; of two spheres 1 / R is the sum of their curvatures, [m]
/// @param nu      Poisson's ratio, [1]
[[nodiscard]] inline double calc_sphere_stiffness(double radius, double youngs_modulus, double nu) {
  const double h = (1.0 - nu * nu) / (std::numbers::pi * youngs_modulus);
  return 4.0 / (3.0 * std::numbers::pi * 2.0 * h) * std::sqrt(radius);
}

/// Hertz stiffness of the bore: R = r_b r_j / c_r. Source: project paper, ref. [9].
[[nodiscard]] inline double calc_hertz_stiffness(double r_b, double c_r, double youngs_modulus, double nu) {
  return calc_sphere_stiffness(r_b * (r_b - c_r) / c_r, youngs_modulus, nu);
}

}  // namespace engine
