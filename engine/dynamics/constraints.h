#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "engine/dynamics/constraint_rows.h"
#include "engine/kinematics/frame_motion.h"
#include "engine/kinematics/tree_model.h"
#include "engine/model/mechanism.h"

namespace engine {

/// The five rows Phi(q) = 0 of each ideal cut joint, for whoever gives the motion of every coordinate; see ConstraintRows.
class Constraints {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  const Mechanism& mechanism_;
  TreeModel model_;
  Buffer<Frame<double, double>> frames_;
  Buffer<JointAxes> axes_;
  ConstraintRows rows_;

 public:
  explicit Constraints(const Mechanism& mechanism);

  [[nodiscard]] Eigen::Index count() const { return Phi.size(); }
  /// First row of a cut joint, -1 if it has clearance.
  [[nodiscard]] Eigen::Index row_of_joint(std::size_t joint) const { return model_.cut_joints[joint].first_row; }

  /// Computes all rows from the frames' motions. Bias is Phi's second derivative with the accelerations that the frames carry.
  void calc(const std::vector<FrameMotion>& frames);

  const Eigen::Map<const Eigen::VectorXd> Phi;    ///< [m] and [1]
  const Eigen::Map<const Eigen::VectorXd> Phi_d;  ///< first derivative by time
  const Eigen::Map<const Eigen::VectorXd> bias;   ///< second derivative without the unknown accelerations
  const Eigen::Map<const Rows> Phi_q;             ///< count x coordinates
};

}  // namespace engine
