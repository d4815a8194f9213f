// SPDX-License-Identifier: Apache-2.0
#include "engine/dynamics/constraints.h"

#include <cmath>

#include <Eigen/Geometry>

#include "engine/kinematics/plain_frame.h"

namespace engine {

namespace {

RPSUP_INLINE Frame<double, double> calc_end(const Mechanism& mechanism, FrameIndex frame,
                                            const Placement& placement,
                                            const std::vector<FrameMotion>& frames) {
  Frame<double, double> end =
      to_frame(frame == kGround ? ground_motion(mechanism) : frames[static_cast<std::size_t>(frame)]);
  move_to(placement, end);
  return end;
}

Eigen::Matrix3d calc_relative_rotation(const Frame<double, double>& b, const Frame<double, double>& j) {
  const auto matrix = [](const Mat3<double>& R) {
    Eigen::Matrix3d columns;
    columns << to_eigen(R.x), to_eigen(R.y), to_eigen(R.z);
    return columns;
  };
  return matrix(b.R).transpose() * matrix(j.R);
}

/// Rotation vector of the smallest turn of the z axis into a direction.
Eigen::Vector3d calc_turn_of_z(const Eigen::Vector3d& direction) {
  const double sine = std::hypot(direction.x(), direction.y());
  const double angle = std::atan2(sine, direction.z());
  if (sine == 0.0) return {angle, 0.0, 0.0};  // none, or half a turn, for which any axis across will do
  return angle * (Eigen::Vector3d(-direction.y(), direction.x(), 0.0) / sine);
}

Eigen::Vector3d calc_rotation_vector(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd rotation(R);
  return rotation.angle() * rotation.axis();
}

/// Replaces the residuals of axes: see AxisResiduals::kRotationVectors.
void measure_by_rotation_vector(const CutRows& rows, const Frame<double, double>& b,
                                const Frame<double, double>& j, JointResidual<double, double>& residual) {
  if (rows.axes < 2) return;
  const Eigen::Matrix3d R = calc_relative_rotation(b, j);
  const Eigen::Vector3d rotation = rows.axes == 3 ? calc_rotation_vector(R) : calc_turn_of_z(R.col(2));
  const Vec3<double>* const along[] = {&b.R.x, &b.R.y, &b.R.z};
  for (int k = 0; k < rows.axes; ++k) {
    residual.Phi[rows.positions + k] = rotation[k];
    residual.moment_axis[k] = *along[k];
  }
}

}  // namespace

Constraints::Constraints(const Mechanism& mechanism)
    : mechanism_(mechanism),
      model_(make_given_model(mechanism)),
      frames_(model_.joints.size()),
      axes_(model_.joints.size()),
      residuals_(model_.cut_joints.size()),
      rows_(model_),
      jacobian_(model_),
      Phi(rows_.Phi.data(), jacobian_.count),
      Phi_d(rows_.Phi_d.data(), jacobian_.count),
      bias(rows_.bias.data(), jacobian_.count),
      Phi_q(jacobian_.Phi_q.data(), jacobian_.count, jacobian_.coordinates) {}

template <typename Visit>
RPSUP_INLINE void Constraints::each_joint(const std::vector<FrameMotion>& frames, const Visit& visit) const {
  for (std::size_t k = 0; k < model_.cut_joints.size(); ++k) {
    if (model_.cut_joints[k].first_row < 0) continue;
    const CutJoint& joint = mechanism_.cut_joints[k];
    visit(k, model_.cut_joints[k], calc_end(mechanism_, joint.bearing_frame, joint.bearing, frames),
          calc_end(mechanism_, joint.journal_frame, joint.journal, frames));
  }
}

void Constraints::calc_positions(const Eigen::VectorXd& q, const std::vector<FrameMotion>& frames,
                                 AxisResiduals axes) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames_[i].p = to_vec3(frames[i].p);  // Phi_q takes no more of a frame
    axes_[i].axis[0] = to_vec3(frames[i].axis);
  }
  each_joint(frames,
             [&](std::size_t, const TreeCutJoint& joint, const auto& b, const auto& j) RPSUP_INLINE_LAMBDA {
               // Velocities may be those of another instant: Phi_d and Phi_dd are not used.
               JointResidual<double, double> residual = calc_joint_residual(joint.rows, b, j);
               if (axes == AxisResiduals::kRotationVectors)
                 measure_by_rotation_vector(joint.rows, b, j, residual);
               for (int r = 0; r < joint.rows.count(); ++r)
                 rows_.Phi[static_cast<std::size_t>(joint.first_row + r)] = residual.Phi[r];
               calc_joint_jacobian(model_, joint, frames_.data(), axes_.data(), b, j, residual, jacobian_);
             });
  for (std::size_t k = 0; k < model_.couplings.size(); ++k)
    rows_.Phi[static_cast<std::size_t>(model_.first_coupling_row) + k] =
        calc_coupling_residual(model_.couplings[k], q.data());
}

int Constraints::find_turned_over(const std::vector<FrameMotion>& frames) const {
  int found = -1;
  each_joint(frames, [&](std::size_t k, const TreeCutJoint& joint, const auto& b, const auto& j) {
    const Eigen::Matrix3d R = calc_relative_rotation(b, j);
    const bool turned_over =
        joint.rows.axes >= 2 && (R(2, 2) < 0.0 || (joint.rows.axes == 3 && R(0, 0) < 0.0));
    if (turned_over && found < 0) found = static_cast<int>(k);
  });
  return found;
}

void Constraints::calc_rates(const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd,
                             const std::vector<FrameMotion>& frames) {
  each_joint(frames,
             [&](std::size_t k, const TreeCutJoint& joint, const auto& b, const auto& j) RPSUP_INLINE_LAMBDA {
               residuals_[k] = calc_joint_residual(joint.rows, b, j);
               set_joint_residual(joint.rows, joint.first_row, residuals_[k], rows_);
             });
  calc_coupling_residuals(model_, q.data(), qd.data(), qdd.data(), rows_);
}

JointReaction<double> Constraints::calc_reaction(std::size_t joint, const Eigen::VectorXd& lambda,
                                                 const std::vector<FrameMotion>& frames) const {
  const TreeCutJoint& cut = model_.cut_joints[joint];
  const Frame<double, double> b = calc_end(mechanism_, mechanism_.cut_joints[joint].bearing_frame,
                                           mechanism_.cut_joints[joint].bearing, frames);
  return calc_joint_reaction(cut.rows, residuals_[joint], b.R, lambda.data() + cut.first_row);
}

}  // namespace engine
