// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "engine/dynamics/cut_joint_motion.h"
#include "engine/dynamics/dynamics_kernel.h"
#include "engine/kinematics/frame_recursion.h"
#include "engine/kinematics/plain_frame.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Reads out the frame of a joint's k-th coordinate. Numbers are copied one by one, here and below: functions
/// of Eigen would be shared between instruction sets by the linker.
inline void read_out_frame(const Frame<double, double>& from, const JointAxes& axes, int k,
                           FrameMotion& to) {
  copy(axes.axis[k], to.axis.data());
  copy(k == 0 ? axes.r : Vec3<double>{}, to.p_parent.data());
  copy(from.R, to.R.data());
  copy(from.p, to.p.data());
  copy(from.w, to.w.data());
  copy(from.v, to.v.data());
}

inline void read_out_joint(const CutJointMotion<double, double>& from, JointState& to) {
  copy(from.journal.R, to.journal.R_bj.data());
  copy(from.journal.p, to.journal.p_bj.data());
  copy(from.journal.v, to.journal.v.data());
  copy(from.journal.w, to.journal.w.data());
  copy(from.reaction, to.reaction_W.data());
  copy(from.moment, to.moment_W.data());
  copy(from.load.force, to.load.force.data());
  copy(from.load.moment, to.load.moment.data());
  to.load.radial_normal_sum = from.load.radial_normal_sum;
  to.load.face_normal_sum = from.load.face_normal_sum;
  to.load.friction_sum = from.load.friction_sum;
  to.load.max_penetration = from.load.max_penetration;
  to.load.elastic_energy = from.load.elastic_energy;
  to.load.impact_power = from.load.impact_power;
  to.load.friction_power = from.load.friction_power;
  to.load.face_touches = from.load.face_touches;
}

/// Reads out the frame of an auxiliary joint, which no pass over the tree computes.
/// @param q, qd  its coordinate
template <typename Joint>
void read_out_auxiliary(const Joint& joint, const Frame<double, double>& ground, const double* q,
                        const double* qd, FrameMotion& to) {
  const double sine = std::sin(*q), cosine = std::cos(*q), no_acceleration = 0.0;
  Frame<double, double> f = ground;
  JointAxes axes;
  calc_joint_frame(joint, q, &sine, &cosine, qd, &no_acceleration, f, axes);
  read_out_frame(f, axes, 0, to);
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
