// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "engine/dynamics/motion_system.h"

namespace engine {

/// Bounds of the unstable oscillatory modes about a state.
struct Instability {
  double growth = 0.0;     ///< largest real part of their eigenvalues, [1/s]; 0: no mode is unstable
  double frequency = 0.0;  ///< largest imaginary part of their eigenvalues, [rad/s]
};

/// Unstable oscillatory modes of the equations of motion, linearised about a state. Friction can excite
/// vibrations (self-excited vibration, mode coupling): bending of flexible links, and bouncing of the journal
/// on its bore. They grow within about 10 ms from a size that no error estimate shows to peaks; but an
/// L-stable method damps every mode that is faster than its steps, whether the mode is stable or not.
///
/// The eigenvalues lambda of the Jacobian J are computed by shift-invert, with a shift s above most
/// frequencies. Let R be the part of (s 1 - J)^-1 that takes coordinates and rates to coordinates and rates,
/// and nu its eigenvalues:
///
///     lambda = s - 1 / nu
///
/// The bristles are condensed in R as if they followed a motion of exp(s t): they hardly bend, as in a fast
/// vibration.
class UnstableModes {
 public:
  /// @param free_count  free coordinates of the systems
  explicit UnstableModes(Eigen::Index free_count);

  /// @param system  linearised, with free coordinates; its factors for a real shift are others afterwards
  /// @param slowest_growth  of the modes that are looked for, [1/s]
  /// @returns no instability where the matrix is singular, or its eigenvalues are not found
  [[nodiscard]] Instability find(MotionSystem& system, double slowest_growth);

 private:
  void calc_response(MotionSystem& system);

  Eigen::MatrixXd response_;  ///< R, rates measured in units of s
  Eigen::EigenSolver<Eigen::MatrixXd> solver_;
};

}  // namespace engine
