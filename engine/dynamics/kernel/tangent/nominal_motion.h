// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/dynamics/newton_euler.h"
#include "engine/kinematics/frame_recursion.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// A coordinate at the operating point, the nominal motion about which the equations are linearised: terms of
/// Eq. (K17), with w and wd before the coordinate's own motion is added.
struct NominalCoordinate {
  Vec3<double> rate;  ///< s qd
  Vec3<double> s_w;   ///< s x w
  Vec3<double> s_wd;  ///< s x wd; of a translation s x wd + w x (s x w)
};

/// A joint's frame at the operating point: its motion with all accelerations, and the terms that its tangents
/// share.
struct NominalJoint {
  Vec3<double> w, v, wd, vd;
  Vec3<double> parent_w;
  Vec3<double> w_r;            ///< parent_w x r
  Vec3<double> mid_v, mid_vd;  ///< v and vd before the joint's own motion is added
  SpatialForce<double>
      force;  ///< transmitted by the joint: Newton-Euler forces of the subtree less its loads
};

/// Computes all of a joint's frame but the force.
/// @param parent           w, v, wd and vd of the parent's frame
/// @param qd, qdd          of the joint's first coordinate on
/// @param coordinates      out: of the joint's first coordinate on
template <typename Joint>
RPSUP_INLINE void calc_nominal_joint(const Joint& joint, const NominalJoint& parent, const JointAxes& axes,
                                     const double* qd, const double* qdd, NominalCoordinate* coordinates,
                                     NominalJoint& nominal) {
  Frame<double, double> f;
  f.w = nominal.parent_w = parent.w;
  f.v = parent.v;
  f.wd = parent.wd;
  f.vd = parent.vd;
  nominal.w_r = cross(f.w, axes.r);
  shift_frame(axes.r, joint.parent_frame_rotates, f);
  nominal.mid_v = f.v;
  nominal.mid_vd = f.vd;
  for (int k = 0; k < joint.count(); ++k) {
    NominalCoordinate& coordinate = coordinates[k];
    const Vec3<double>& s = axes.axis[k];
    coordinate.rate = qd[k] * s;
    coordinate.s_w = cross(s, f.w);
    coordinate.s_wd = cross(s, f.wd);
    if (joint.rotates()) {
      add_rotation_rate(s, joint.parent_frame_rotates || k > 0, qd[k], f);
      f.wd += qdd[k] * s;
    } else {
      coordinate.s_wd += cross(f.w, coordinate.s_w);
      add_translation_rate(s, joint.parent_frame_rotates, qd[k], f);
      f.vd += qdd[k] * s;
    }
  }
  nominal.w = f.w;
  nominal.v = f.v;
  nominal.wd = f.wd;
  nominal.vd = f.vd;
}

/// Sets the force to the Newton-Euler force of the joint's body alone.
template <typename Joint>
RPSUP_INLINE void calc_nominal_force(const Joint& joint, const Mat3<double>& R, NominalJoint& nominal) {
  Frame<double, double> f;
  f.R = R;
  f.w = nominal.w;
  f.wd = nominal.wd;
  f.vd = nominal.vd;
  nominal.force = calc_newton_euler_force(joint, f);
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
