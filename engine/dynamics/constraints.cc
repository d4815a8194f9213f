// SPDX-License-Identifier: Apache-2.0
#include "engine/dynamics/constraints.h"

#include "engine/kinematics/plain_frame.h"

namespace engine {

namespace {

RPSUP_INLINE Frame<double, double> calc_end(const Mechanism& mechanism, FrameIndex frame, const Placement& placement,
                                            const std::vector<FrameMotion>& frames) {
  Frame<double, double> end = to_frame(frame == kGround ? ground_motion(mechanism) : frames[static_cast<std::size_t>(frame)]);
  move_to(placement, end);
  return end;
}

}  // namespace

Constraints::Constraints(const Mechanism& mechanism)
    : mechanism_(mechanism),
      model_(make_given_model(mechanism)),
      frames_(model_.joints.size()),
      axes_(model_.joints.size()),
      violations_(model_.cut_joints.size()),
      rows_(model_),
      entries_(model_),
      Phi(rows_.Phi.data(), entries_.count),
      Phi_d(rows_.Phi_d.data(), entries_.count),
      bias(rows_.bias.data(), entries_.count),
      Phi_q(entries_.Phi_q.data(), entries_.count, entries_.coordinates) {}

template <typename Visit>
RPSUP_INLINE void Constraints::each_joint(const std::vector<FrameMotion>& frames, const Visit& visit) const {
  for (std::size_t k = 0; k < model_.cut_joints.size(); ++k) {
    if (model_.cut_joints[k].first_row < 0) continue;
    const CutJoint& joint = mechanism_.cut_joints[k];
    visit(k, model_.cut_joints[k], calc_end(mechanism_, joint.bearing_frame, joint.bearing, frames),
          calc_end(mechanism_, joint.journal_frame, joint.journal, frames));
  }
}

void Constraints::calc_positions(const Eigen::VectorXd& q, const std::vector<FrameMotion>& frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames_[i].p = to_vec3(frames[i].p);  // all that the rows' derivatives by the coordinates take of it
    axes_[i].axis[0] = to_vec3(frames[i].axis);
  }
  each_joint(frames, [&](std::size_t, const TreeCutJoint& joint, const auto& b, const auto& j) RPSUP_INLINE_LAMBDA {
    // Velocities may be those of another instant: nothing of them is taken.
    const JointViolation<double, double> violation = calc_joint_violation(joint.rows, b, j);
    for (int r = 0; r < joint.rows.count(); ++r) rows_.Phi[static_cast<std::size_t>(joint.first_row + r)] = violation.Phi[r];
    calc_joint_entries(model_, joint, frames_.data(), axes_.data(), b, j, violation, entries_);
  });
  for (std::size_t k = 0; k < model_.couplings.size(); ++k)
    rows_.Phi[static_cast<std::size_t>(model_.first_coupling_row) + k] = calc_coupling_row(model_.couplings[k], q.data());
}

void Constraints::calc_rates(const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd,
                             const std::vector<FrameMotion>& frames) {
  each_joint(frames, [&](std::size_t k, const TreeCutJoint& joint, const auto& b, const auto& j) RPSUP_INLINE_LAMBDA {
    violations_[k] = calc_joint_violation(joint.rows, b, j);
    set_joint_rows(joint.rows, joint.first_row, violations_[k], rows_);
  });
  calc_coupling_rows(model_, q.data(), qd.data(), qdd.data(), rows_);
}

JointReaction<double> Constraints::calc_reaction(std::size_t joint, const Eigen::VectorXd& lambda, const std::vector<FrameMotion>& frames) const {
  const TreeCutJoint& cut = model_.cut_joints[joint];
  const Frame<double, double> b = calc_end(mechanism_, mechanism_.cut_joints[joint].bearing_frame, mechanism_.cut_joints[joint].bearing, frames);
  return calc_joint_reaction(cut.rows, violations_[joint], b.R, lambda.data() + cut.first_row);
}

}  // namespace engine
