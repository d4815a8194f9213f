// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "engine/clearance/journal_motion.h"
#include "engine/kinematics/frame_motion.h"

namespace engine {

/// A cut joint at one instant.
struct JointState {
  JournalMotion journal;                                    ///< {j} seen from {b}
  ContactLoad load;  ///< of a joint with clearance; zero for an ideal one
  Eigen::Vector3d reaction_W = Eigen::Vector3d::Zero();     ///< force on the journal at its centre, [N]
  Eigen::Vector3d moment_W = Eigen::Vector3d::Zero();       ///< on the journal, about its centre, [N m]
};

/// Energy and work since the start of the run, and the power with which they change.
struct EnergyAccount {
  double kinetic = 0.0;                                     ///< [J]
  double potential = 0.0;                                   ///< gravity, springs, elastic contact, [J]
  Eigen::VectorXd drive_work;                               ///< of drives, force elements, body loads, [J]
  double impact_loss = 0.0;                                 ///< [J]
  double friction_loss = 0.0;                               ///< [J]
  double structural_loss = 0.0;                             ///< [J]

  /// E - work of the drives + losses: constant if the integration were exact.
  [[nodiscard]] double calc_balance() const {
    return kinetic + potential - drive_work.sum() + impact_loss + friction_loss + structural_loss;
  }

  /// Work that the drives did and took, and energy that was lost, since an instant shortly before.
  [[nodiscard]] double calc_turned_over_since(const EnergyAccount& before) const {
    return (drive_work - before.drive_work).cwiseAbs().sum() + std::abs(impact_loss - before.impact_loss) +
           std::abs(friction_loss - before.friction_loss) +
           std::abs(structural_loss - before.structural_loss);
  }
};

/// All that is known of the mechanism at one instant.
struct Evaluation {
  double t = 0.0;                                           ///< [s]
  Eigen::VectorXd q, qd, qdd;                               ///< every coordinate
  Eigen::VectorXd drive_force;                              ///< one a drive, [N] or [N m]
  Eigen::VectorXd applied_force;                            ///< of AppliedForces; laws of body loads
  Eigen::VectorXd applied_work;                             ///< the same, [J]
  Eigen::VectorXd friction_reaction;  ///< normal forces by reactions, one a force element, [N]
  std::vector<FrameMotion> frames;                          ///< one a coordinate; accelerations are not set
  std::vector<JointState> joints;                           ///< one a cut joint
  EnergyAccount energy;                                     ///< kinetic and potential: by calc_energies()
};

}  // namespace engine
