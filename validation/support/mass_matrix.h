// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "engine/dynamics/inverse_dynamics.h"
#include "engine/kinematics/frame_motion.h"
#include "engine/model/mechanism.h"
#include "validation/engine_names.h"

namespace validation {

/// Mass matrix M of the open chains as the engine's inverse dynamics has it: column j holds the forces that a
/// unit acceleration of coordinate j alone needs, without rates and gravity.
[[nodiscard]] inline Eigen::MatrixXd calc_mass_matrix(Mechanism mechanism, const Eigen::VectorXd& q) {
  mechanism.gravity_W.setZero();
  InverseDynamics inverse_dynamics(mechanism);
  std::vector<FrameMotion> frames(mechanism.coordinates.size());
  Eigen::MatrixXd M(q.size(), q.size());
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    calc_frame_motions(mechanism, q, Eigen::VectorXd::Zero(q.size()), Eigen::VectorXd::Unit(q.size(), j),
                       frames);
    M.col(j) = inverse_dynamics.calc(frames);
  }
  return M;
}

}  // namespace validation
