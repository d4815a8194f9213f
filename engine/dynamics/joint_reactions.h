// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/dynamics/evaluation.h"
#include "engine/dynamics/inverse_dynamics.h"
#include "engine/model/mechanism.h"

namespace engine {

/// Reactions: the force and moment of every joint on the body that it carries, by Newton and Euler from the
/// motion and the forces of the cut joints.
class JointReactions {
 public:
  explicit JointReactions(const Mechanism& mechanism);

  void calc(const Evaluation& at);

  /// After calc(): motion of a coordinate's frame, with its accelerations, or of the ground.
  [[nodiscard]] const FrameMotion& motion(FrameIndex frame) const {
    return frame == kGround ? ground_ : frames_[static_cast<std::size_t>(frame)];
  }

  /// After calc(): about the origin of the joint's last frame, in W. With it come the joint's drives and
  /// springs.
  [[nodiscard]] const Wrench& of(FrameIndex last_frame) const {
    return inverse_dynamics_.transmitted(last_frame);
  }

 private:
  void add_cut_joint(const CutJoint& joint, const JointState& state);
  void add_spring(const PointSpring& spring);
  void add_body_load(const BodyLoad& load, double t);

  const Mechanism& mechanism_;
  InverseDynamics inverse_dynamics_;
  std::vector<FrameMotion> frames_;
  FrameMotion ground_;
};

}  // namespace engine
