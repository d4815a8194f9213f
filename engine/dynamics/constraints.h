#pragma once

#include <vector>

#include <Eigen/Core>

#include "engine/kinematics/frame_motion.h"
#include "engine/model/mechanism.h"

namespace engine {

/// Rows of the constraints Phi(q, t) = 0: five for each ideal cut joint, one for each drive that is enforced by a multiplier.
///
///     p_J - p_B = 0 (3),  z_b . x_j = 0,  z_b . y_j = 0,    q_d - q_d(t) = 0
///
/// The multipliers are the forces that the rows exert: of an ideal joint on its journal (in W), of a drive on its coordinate.
class Constraints {
 public:
  explicit Constraints(const Mechanism& mechanism);

  [[nodiscard]] Eigen::Index count() const { return Phi.size(); }
  /// First row of a cut joint, -1 if it has clearance.
  [[nodiscard]] Eigen::Index row_of_joint(std::size_t joint) const { return joint_rows_[joint]; }
  [[nodiscard]] Eigen::Index row_of_drive(std::size_t drive) const { return first_drive_row_ + static_cast<Eigen::Index>(drive); }

  /// Computes all rows from the frames' motions. Bias is Phi's second derivative with the accelerations that the frames carry.
  void calc(const std::vector<FrameMotion>& frames, const Eigen::VectorXd& q, const Eigen::VectorXd& qd, double t);

  Eigen::VectorXd Phi;    ///< [m] and [1]
  Eigen::VectorXd Phi_d;  ///< first derivative by time
  Eigen::VectorXd bias;   ///< second derivative without the unknown accelerations
  Eigen::MatrixXd Phi_q;  ///< count x coordinates

 private:
  void calc_joint(const CutJoint& joint, const std::vector<FrameMotion>& frames, Eigen::Index row);
  void calc_joint_jacobian(const CutJoint& joint, const std::vector<FrameMotion>& frames, const FrameMotion& b, const FrameMotion& j,
                           Eigen::Index row);

  const Mechanism& mechanism_;
  std::vector<Eigen::Index> joint_rows_;
  Eigen::Index first_drive_row_ = 0;
};

/// The motion of a cut joint's bearing or journal.
[[nodiscard]] FrameMotion calc_bearing_motion(const Mechanism& mechanism, const CutJoint& joint, const std::vector<FrameMotion>& frames);
[[nodiscard]] FrameMotion calc_journal_motion(const Mechanism& mechanism, const CutJoint& joint, const std::vector<FrameMotion>& frames);

}  // namespace engine
