#include "engine/dynamics/constraints.h"

#include "engine/kinematics/plain_frame.h"

namespace engine {

namespace {

Frame<double, double> calc_end(const Mechanism& mechanism, FrameIndex frame, const Placement& placement, const std::vector<FrameMotion>& frames) {
  Frame<double, double> end = to_frame(frame == kGround ? ground_motion(mechanism) : frames[static_cast<std::size_t>(frame)]);
  (void)move_to(placement, end);
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
      Phi(rows_.Phi.data(), rows_.count),
      Phi_d(rows_.Phi_d.data(), rows_.count),
      bias(rows_.bias.data(), rows_.count),
      Phi_q(rows_.count, rows_.coordinates) {}

void Constraints::calc(const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd, const std::vector<FrameMotion>& frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames_[i].p = to_vec3(frames[i].p);  // all that the rows' derivatives by the coordinates take of it
    axes_[i].axis[0] = to_vec3(frames[i].axis);
  }
  for (std::size_t k = 0; k < model_.cut_joints.size(); ++k) {
    if (model_.cut_joints[k].first_row < 0) continue;
    const CutJoint& joint = mechanism_.cut_joints[k];
    const Frame<double, double> b = calc_end(mechanism_, joint.bearing_frame, joint.bearing, frames);
    const Frame<double, double> j = calc_end(mechanism_, joint.journal_frame, joint.journal, frames);
    violations_[k] = calc_joint_violation(model_.cut_joints[k].rows, b, j);
    calc_joint_rows(model_, model_.cut_joints[k], frames_.data(), axes_.data(), b, j, violations_[k], rows_);
  }
  calc_coupling_rows(model_, q.data(), qd.data(), qdd.data(), rows_);
  for (int r = 0; r < rows_.count; ++r)
    for (int i = 0; i < rows_.coordinates; ++i) Phi_q(r, i) = rows_.row(r)[i * ConstraintRows::kSide];
}

JointReaction<double> Constraints::calc_reaction(std::size_t joint, const Eigen::VectorXd& lambda, const std::vector<FrameMotion>& frames) const {
  const TreeCutJoint& cut = model_.cut_joints[joint];
  const Frame<double, double> b = calc_end(mechanism_, mechanism_.cut_joints[joint].bearing_frame, mechanism_.cut_joints[joint].bearing, frames);
  return calc_joint_reaction(cut.rows, violations_[joint], b.R, lambda.data() + cut.first_row);
}

}  // namespace engine
