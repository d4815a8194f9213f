// SPDX-License-Identifier: Apache-2.0
#include "engine/dynamics/joint_reactions.h"

#include <cstddef>

#include "engine/dynamics/spring_motion.h"

namespace engine {

JointReactions::JointReactions(const Mechanism& mechanism)
    : mechanism_(mechanism),
      inverse_dynamics_(mechanism),
      frames_(mechanism.coordinates.size()),
      ground_(ground_motion(mechanism)) {}

void JointReactions::calc(const Evaluation& at) {
  calc_frame_motions(mechanism_, at.q, at.qd, at.qdd,
                     frames_);  // those of `at` may lack the free coordinates' accelerations
  for (std::size_t k = 0; k < at.joints.size(); ++k) add_cut_joint(mechanism_.cut_joints[k], at.joints[k]);
  for (const PointSpring& spring : mechanism_.springs) add_spring(spring);
  for (const BodyLoad& load : mechanism_.body_loads) add_body_load(load, at.t);
  (void)inverse_dynamics_.calc(frames_);
}

void JointReactions::add_spring(const PointSpring& spring) {
  const SpringMotion motion = calc_spring_motion(spring, frames_);
  const auto add = [&](FrameIndex index, const Eigen::Vector3d& point, const Eigen::Vector3d& force) {
    if (index == kGround) return;
    const Eigen::Vector3d arm = point - frames_[static_cast<std::size_t>(index)].p;
    inverse_dynamics_.add_load(index, {force, arm.cross(force)});
  };
  add(spring.to_frame, motion.to, motion.force);
  add(spring.from_frame, motion.from, -motion.force);
}

void JointReactions::add_body_load(const BodyLoad& load, double t) {
  if (load.frame == kGround) return;
  const FrameMotion& body = frames_[static_cast<std::size_t>(load.frame)];
  const double value = calc_signal(load.law, t).value;
  const Eigen::Matrix3d R = load.follows_body ? body.R : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  const Eigen::Vector3d force = value * (R * load.force), arm = body.R * load.at;
  inverse_dynamics_.add_load(load.frame, {force, value * (R * load.moment) + arm.cross(force)});
}

/// Force and moment act where the journal's centre is, the opposite ones on the bearing there.
void JointReactions::add_cut_joint(const CutJoint& joint, const JointState& state) {
  const FrameMotion journal = motion_of(joint.journal_frame, frames_);
  const Eigen::Vector3d point = journal.p + journal.R * joint.journal.p;
  const auto add = [&](FrameIndex index, double sign) {
    if (index == kGround) return;
    const Eigen::Vector3d force = sign * state.reaction_W;
    const Eigen::Vector3d arm = point - frames_[static_cast<std::size_t>(index)].p;
    inverse_dynamics_.add_load(index, {force, sign * state.moment_W + arm.cross(force)});
  };
  add(joint.journal_frame, 1.0);
  add(joint.bearing_frame, -1.0);
}

}  // namespace engine
