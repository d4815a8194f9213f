// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "engine/dynamics/constraint_rows.h"
#include "engine/kinematics/frame_motion.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/buffer.h"
#include "engine/model/mechanism.h"

namespace engine {

/// Measure, in the rows of axes, of the rotation between bearing and journal.
enum class AxisResiduals {
  kProducts,         ///< scalar products of axes, as ConstraintResiduals says: zero for a half turn as well
  kRotationVectors,  ///< components, along the bearing's axes, of the rotation that would turn the journal
                     ///< into place: zero there alone. Phi_q is exact there only
};

/// Residuals and Jacobian of the rows of all ideal cut joints and couplings, of given coordinates and frames:
/// see ConstraintResiduals.
class Constraints {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  const Mechanism& mechanism_;
  TreeModel model_;
  Buffer<Frame<double, double>> frames_;
  Buffer<JointAxes> axes_;
  Buffer<JointResidual<double, double>> residuals_;  ///< one a cut joint
  ConstraintResiduals<Buffer<double>> rows_;
  ConstraintJacobian jacobian_;

  /// Visits the ideal cut joints with the frames of bearing and journal: visit(index, joint, b, j).
  template <typename Visit>
  void each_joint(const std::vector<FrameMotion>& frames, const Visit& visit) const;

 public:
  explicit Constraints(const Mechanism& mechanism);

  [[nodiscard]] Eigen::Index count() const { return Phi.size(); }

  /// Computes Phi and Phi_q from the coordinates and the frames' poses.
  void calc_positions(const Eigen::VectorXd& q, const std::vector<FrameMotion>& frames,
                      AxisResiduals axes = AxisResiduals::kProducts);

  /// The first cut joint whose journal is turned over: rather by a half turn than by none about an axis about
  /// which it may not turn. -1: none is.
  [[nodiscard]] int find_turned_over(const std::vector<FrameMotion>& frames) const;

  /// Computes all but Phi_q from the frames' motions. The bias is the second derivative of Phi with the
  /// accelerations given.
  void calc_rates(const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd,
                  const std::vector<FrameMotion>& frames);

  /// The reaction of an ideal cut joint's multipliers, after calc_rates().
  [[nodiscard]] JointReaction<double> calc_reaction(std::size_t joint, const Eigen::VectorXd& lambda,
                                                    const std::vector<FrameMotion>& frames) const;

  const Eigen::Map<const Eigen::VectorXd> Phi;    ///< [m] and [1]
  const Eigen::Map<const Eigen::VectorXd> Phi_d;  ///< first derivative by time
  /// second derivative by time but for the unknown accelerations
  const Eigen::Map<const Eigen::VectorXd> bias;
  const Eigen::Map<const Rows> Phi_q;             ///< count x coordinates
};

}  // namespace engine
