// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "engine/dynamics/motion_system.h"

namespace engine {

/// The vibrations that grow about a state.
struct FedVibration {
  double growth = 0.0;     ///< of the one that grows fastest, [1/s]; 0: there is none
  double frequency = 0.0;  ///< the highest of all that grow, [rad/s]
};

/// Looks for vibrations that grow: friction feeds some, of what presses on a bore as of elastic links. From nothing that a step's error could show they
/// become peaks within some 10 ms; but an L-stable method damps whatever vibrates faster than its steps, be it growing or not.
///
/// Vibrations about a state are the eigenvalues of the Jacobian J there. With R the part of (s 1 - J)^-1 that takes coordinates and rates to
/// coordinates and rates, they are s - 1 / eigenvalues of R. Bristles stand in it as they follow a motion of exp(s t): with s larger than most
/// frequencies they hardly bend, as in a fast vibration.
class FedVibrations {
 public:
  /// @param system  linearised, with free coordinates; its factors for a real shift are others afterwards
  /// @returns none where the matrix is singular, or its eigenvalues are not found
  [[nodiscard]] FedVibration find(MotionSystem& system);

 private:
  void find_response(MotionSystem& system);

  Eigen::VectorXd column_;
  Eigen::MatrixXd response_;  ///< R, rates measured in units of s
  Eigen::EigenSolver<Eigen::MatrixXd> solver_;
};

}  // namespace engine
