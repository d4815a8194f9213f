// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/dynamics/newton_euler.h"
#include "engine/kinematics/frame_recursion.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// What a coordinate does to the motion of its frame, its rate and acceleration with it.
struct HeldCoordinate {
  Vec3<double> rate;        ///< s qd
  Vec3<double> s_w, s_wd;   ///< what w and wd, of a sliding frame v and vd, lose where the axis s turns or slides by one
};

/// A joint's motion with all accelerations, and what of it its variation needs.
struct HeldJoint {
  Vec3<double> w, v, wd, vd;   ///< of its frame
  Vec3<double> parent_w;
  Vec3<double> w_r;            ///< parent_w x r
  Vec3<double> mid_v, mid_vd;  ///< of the frame moved by r, before the joint turns it
  SpatialForce<double> force;  ///< that its body and all that it carries need, less the loads on them
};

/// @param parent       motion of the parent's frame: w, v, wd and vd
/// @param qd, qdd      of the joint's first coordinate on
/// @param coordinates  as well
template <typename Joint>
RPSUP_INLINE void hold_joint(const Joint& joint, const HeldJoint& parent, const JointAxes& axes, const double* qd, const double* qdd,
                             HeldCoordinate* coordinates, HeldJoint& held) {
  Frame<double, double> f;
  f.w = held.parent_w = parent.w;
  f.v = parent.v;
  f.wd = parent.wd;
  f.vd = parent.vd;
  held.w_r = cross(f.w, axes.r);
  shift_frame(axes.r, joint.parent_turns, f);
  held.mid_v = f.v;
  held.mid_vd = f.vd;
  for (int k = 0; k < joint.count(); ++k) {
    HeldCoordinate& coordinate = coordinates[k];
    const Vec3<double>& s = axes.axis[k];
    coordinate.rate = qd[k] * s;
    coordinate.s_w = cross(s, f.w);
    coordinate.s_wd = cross(s, f.wd);
    if (joint.rotates()) {
      add_turning(s, joint.parent_turns || k > 0, qd[k], f);
      f.wd += qdd[k] * s;
    } else {
      coordinate.s_wd += cross(f.w, coordinate.s_w);
      add_sliding(s, joint.parent_turns, qd[k], f);
      f.vd += qdd[k] * s;
    }
  }
  held.w = f.w;
  held.v = f.v;
  held.wd = f.wd;
  held.vd = f.vd;
}

/// The force that the joint's body needs to move as it does.
template <typename Joint>
RPSUP_INLINE void hold_force(const Joint& joint, const Mat3<double>& R, HeldJoint& held) {
  Frame<double, double> f;
  f.R = R;
  f.w = held.w;
  f.wd = held.wd;
  f.vd = held.vd;
  held.force = calc_body_force(joint, f);
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
