// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "engine/clearance/cylinder_contact.h"
#include "engine/clearance/friction_parameters.h"
#include "engine/clearance/normal_law.h"
#include "engine/clearance/worn_bore.h"
#include "engine/model/actuator.h"
#include "engine/model/drive_law.h"
#include "engine/model/links.h"

namespace engine {

enum class LinkModel { kRigid, kFlexible };
using Coupler = LinkModel;  ///< that of link (1,3)
enum class DriveEnforcement { kPrescribed, kBaumgarte };
enum class ContactForm { kContinuum, kElements };

/// Axis about which the cross link, link (2,2), turns in the slider.
enum class YokeAxis {
  kGuide,   ///< the slider's guide: z^(2,1) and psi^(2,2) are along and about the same axis, as the paper
            ///< writes them
  kAcross,  ///< the slider's y, at right angles to the guide
};

/// A direction of the global frame {0}.
enum class Direction { kX, kMinusX, kY, kMinusY, kZ, kMinusZ };

/// A link other than the coupler: a straight beam or tube, round, rigid or divided as the coupler is.
struct RoundLink {
  LinkModel model = LinkModel::kRigid;
  double diameter = 0.0;                           ///< of what bends, [m]
  double inner_diameter = 0.0;                     ///< [m]
  int elements = 4;                                ///< n_rfe, >= 2
  double damping_ratio = 0.01;                     ///< zeta of the first bending mode, [1]
};

/// Everything that defines one RPSUP linkage, its drives and its clearance joint, in SI units.
/// The values below are the defaults of the study; jobs/parameters/README.md says where each comes from.
struct RpsupParameters {
  // Links
  Coupler coupler = Coupler::kRigid;
  double crank_length = 0.2;                       ///< length of link (1,1), [m]
  double rod_length = 0.2;                         ///< length of link (1,2): its origin to the S joint, [m]
  double rod_start = 0.15;                         ///< crank's axis to the S joint while the rod rests, [m]
  double coupler_length = 0.5;                     ///< S joint to the centre of the bearing, [m]
  double guide_offset_y = 0.0;                     ///< the slider's guide in the global frame, [m]
  double guide_offset_z = 0.24;                    ///< [m]
  double guide_angle = 0.0;  ///< of the guide from the global x towards z, the crank's axis, [rad]
  YokeAxis yoke_axis = YokeAxis::kGuide;
  double gravity = 9.81;                           ///< [m/s^2]
  Direction gravity_direction = Direction::kMinusZ;
  /// Table 1, links of chain 1 as the beams they are. Its rows for (2,1) and (2,2) are no moments of a body
  /// (they break I_x <= I_y + I_z: the third repeats the second) and are read as those of a box and of a tube
  /// along z.
  std::array<LinkInertia, kLinkCount> links{{
      beam_inertia(0.471, 0.2, 6.964e-5),
      beam_inertia(0.490, 0.2, 2.451e-5),
      beam_inertia(0.306, 0.5, 3.829e-6),
      {0.780, {8.126e-4, 1.885e-4, 6.76e-4}},
      {0.107, {9.354e-5, 9.354e-5, 8.377e-6}},
  }};

  // Flexible coupler (modified rigid finite element method)
  int rigid_elements = 4;                          ///< n_rfe, >= 2
  double youngs_modulus = 2.1e11;                  ///< E, [Pa]
  double shear_modulus = 0.8e11;                   ///< G, [Pa]
  double coupler_diameter = 0.010;                 ///< d, [m]
  double coupler_damping_ratio = 0.0005;            ///< zeta of the first bending mode, [1]

  // The other links that may be flexible; sections by Table 1's masses and moments
  RoundLink crank{.diameter = 0.028, .inner_diameter = 0.020};  ///< link (1,1)
  RoundLink rod{.diameter = 0.020};                             ///< link (1,2)
  RoundLink cross{.diameter = 0.020, .inner_diameter = 0.015};  ///< link (2,2)
  double cross_length =
      0.0;  ///< of link (2,2), from the slider's joint along its own z to the journal's centre, [m]

  // Drives
  double crank_velocity = 10.0;                    ///< omega_0, [rad/s]
  double crank_start = 0.0;                        ///< psi^(1,1) at t = 0, from the global x, [rad]
  double run_up = 2.0;                             ///< time in which the crank reaches omega_0, [s]
  double rod_stroke = 0.015;                       ///< [m]
  double rod_stroke_time = 0.5;                    ///< time of the rise, and of the return, [s]
  double rod_pause = 0.5;                          ///< [s]
  StrokeLaw rod_law = StrokeLaw::kCosine;          ///< of the rise and of the return
  std::optional<DriveLaw> crank_drive;  ///< of psi^(1,1), in the place of crank_velocity and crank_start
  std::optional<DriveLaw> rod_drive;  ///< of z^(1,2), 0 with the S joint at rod_length from the crank's axis,
                                      ///< in the place of rod_start and of the stroke
  /// Moves psi^(1,1) from rest at crank_start, or z^(1,2) from rest at rod_start, in the place of a motion.
  std::optional<Actuator> crank_actuator, rod_actuator;
  DriveEnforcement drive = DriveEnforcement::kPrescribed;
  double baumgarte_alpha = 100.0;                  ///< [1/s]
  double baumgarte_beta = 100.0;                   ///< [1/s]

  // Clearance joint
  double c_r = 0.25e-3;                            ///< radial clearance, [m]; 0: the ideal joint
  double c_a = 0.0;                                ///< axial clearance, [m]
  ContactForm contact = ContactForm::kContinuum;
  int radial_levels = 3;                           ///< n_r, rings along the journal
  int radial_elements = 180;                       ///< n_ce on a ring
  int axial_levels = 1;                            ///< n_a, circles on a face
  int axial_elements = 8;                          ///< points on a circle
  double bearing_radius = 5e-3;                    ///< r_b, [m]
  double bearing_length = 16e-3;                   ///< L_b, [m]
  NormalForceLaw normal_law = NormalForceLaw::kLankaraniNikravesh;
  double restitution = 0.9;                        ///< k_r, (0, 1]; 0 by laws that allow it
  double contact_damping = 1000.0;                 ///< of Kelvin and Voigt's law, [N s/m]
  StiffnessLaw stiffness_law = StiffnessLaw::kHertz;
  double contact_stiffness_scale = 1.0;            ///< factor on the stiffness of the bore, [1]
  double axial_stiffness = 8.5e5;                  ///< K_a of one face, [N/m]
  double minimum_impact_velocity = 1e-3;           ///< floor of the latched onset velocity, [m/s]
  FrictionLaw friction = FrictionLaw::kLuGre;
  double mu_s = 0.1;                               ///< static; the paper prints mu_s < mu_k, [1]
  double mu_k = 0.2;                               ///< kinetic, [1]
  double sigma_0 = 100.0;                          ///< bristle stiffness, [1/m]
  double sigma_1 = 5.0;                            ///< bristle damping, [s/m]
  double sigma_2 = 0.0;                            ///< viscous friction, [s/m]
  double v_s = 1e-3;                               ///< Stribeck velocity, [m/s]
  double break_away = 0.7;                         ///< elasto-plastic bristles, [0, 1)
  double v_0 = 1e-4;  ///< of friction without bristles: FrictionParameters, [m/s]
  double v_1 = 1e-3;                               ///< [m/s]
  WearDepth wear_depth;                            ///< of the bore, one list a ring, [m]; empty: it is round
};

}  // namespace engine
