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
      rows_(model_),
      Phi(rows_.Phi.data(), rows_.count),
      Phi_d(rows_.Phi_d.data(), rows_.count),
      bias(rows_.bias.data(), rows_.count),
      Phi_q(rows_.Phi_q.data(), rows_.count, rows_.coordinates) {}

void Constraints::calc(const std::vector<FrameMotion>& frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames_[i].p = to_vec3(frames[i].p);  // all that the rows' derivatives by the coordinates take of it
    axes_[i].axis[0] = to_vec3(frames[i].axis);
  }
  for (std::size_t k = 0; k < model_.cut_joints.size(); ++k) {
    if (model_.cut_joints[k].first_row < 0) continue;
    const CutJoint& joint = mechanism_.cut_joints[k];
    calc_joint_rows(model_, model_.cut_joints[k], frames_.data(), axes_.data(), calc_end(mechanism_, joint.bearing_frame, joint.bearing, frames),
                    calc_end(mechanism_, joint.journal_frame, joint.journal, frames), rows_);
  }
}

}  // namespace engine
