// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "engine/model/mechanism.h"
#include "validation/engine_names.h"

namespace validation {

/// T of one frame, Eq. (2), and its derivatives by the coordinates; those that do not move the frame have
/// zero ones.
struct FrameTransforms {
  Eigen::Matrix4d T;
  std::vector<Eigen::Matrix4d> T_i;  ///< dT/dq_i, one a coordinate
};
[[nodiscard]] FrameTransforms calc_transforms(const Mechanism& mechanism, FrameIndex frame,
                                              const Eigen::VectorXd& q);

/// Sum of T_mn qd_m qd_n, the second derivative of T by time at constant rates.
[[nodiscard]] Eigen::Matrix4d calc_convective_transform(const Mechanism& mechanism, FrameIndex frame,
                                                        const Eigen::VectorXd& q, const Eigen::VectorXd& qd);

/// The equations of motion as the paper writes them, Eqs. (2)-(7): 4x4 transforms, their first and second
/// derivatives by each coordinate, pseudo-inertia matrices, traces. Slow, and written without a look at the
/// engine's recursions.
struct TraceForm {
  Eigen::MatrixXd M;         ///< Eq. (5)
  Eigen::VectorXd h;         ///< Eq. (5)
  Eigen::VectorXd g;         ///< Eq. (7)
  double kinetic_energy;     ///< Eq. (4)
  double potential_energy;   ///< Eq. (6), gravity alone
};

/// Of a mechanism only coordinates, bodies and gravity are read: no springs, drives or cut joints.
[[nodiscard]] TraceForm calc_trace_form(const Mechanism& mechanism, const Eigen::VectorXd& q,
                                        const Eigen::VectorXd& qd);

}  // namespace validation
