// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/dynamics/newton_euler.h"
#include "engine/kinematics/frame_recursion.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Bias motion of a slender body (see complete_traits()) at a spherical joint, in W.
///
/// For every other body, the frame's wd is the bias angular acceleration: velocity products and driven
/// accelerations of the chain up to the frame. A spherical joint leaves its body's angular acceleration free,
/// whatever the bias. So that of a slender body is measured from zero: its frame has wd = 0, which leaves
/// less to compute. The angles' accelerations make up for the bias by wd_bias and qdd_bias, Eq. (K10). The
/// bias of an ideal cut joint's rows is without the same part, and the body's SpatialAcceleration, which is
/// its whole angular acceleration, brings it in.
struct SlenderBodyMotion {
  Vec3<double> x_d, x_dd;  ///< velocity of the unit vector x, w x x, and its bias acceleration, w x (w x x)
  Vec3<double> first_moment;  ///< L = mc vd: the moment x x L is not in the body's bias force
  Vec3<double> wd_bias;       ///< w_parent x w; and wd of a parent that is no slender body
  double qdd_bias[3];         ///< the angles' accelerations by the velocity products of their axes
};

/// Frame and bias motion of a slender body.
/// @param parent_motion  of the parent if that is a slender body
/// @param f       in: the parent's frame; out: the body's
template <typename Joint>
RPSUP_INLINE void calc_slender_frame(const Joint& joint, const SlenderBodyMotion* parent_motion,
                                     const double* sines, const double* cosines, const double* qd,
                                     Frame<double, double>& f, JointAxes& axes, SlenderBodyMotion& motion) {
  axes.r = {};
  if (joint.shifted && joint.parent_is_slender) {
    const double l = joint.data().placement.p[0];
    axes.r = l * f.R.x;
    f.p += axes.r;
    f.v += l * parent_motion->x_d;
    f.vd += l * parent_motion->x_dd;
  } else if (joint.shifted) {
    axes.r = rotate_constant(f.R, joint.data().placement.p, joint.shifted_along_x);
    shift_frame(axes.r, joint.parent_frame_rotates, f);
  }
  const Vec3<double> parent_w = f.w, parent_wd = f.wd;
  rotate_spherical(joint.parent_frame_rotates, sines, cosines, qd, f, axes);
  f.wd = {};
  motion.wd_bias = joint.parent_frame_rotates ? parent_wd + cross(parent_w, f.w) : Vec3<double>{};
  // Components along the axes z, y and x as they stand, by the reciprocal basis, of
  // -(qd0 qd1 cross(z, y) + qd1 qd2 cross(y, x) + qd0 qd2 cross(z, x)).
  const double zy = qd[0] * qd[1], yx = qd[1] * qd[2], inverse = 1.0 / cosines[1];
  motion.qdd_bias[0] = inverse * (zy * sines[1] + yx);
  motion.qdd_bias[1] = -(qd[0] * qd[2]) * cosines[1];
  motion.qdd_bias[2] = inverse * (zy + yx * sines[1]);
  motion.first_moment = joint.data().mc[0] * f.vd;
  motion.x_d = cross(f.w, f.R.x);
  motion.x_dd = cross(f.w, motion.x_d);
}

/// Newton-Euler bias force of a slender body, Eq. (K2) with wd = 0, but for the moment x x L.
template <typename Joint>
[[nodiscard]] RPSUP_INLINE SpatialForce<double> calc_slender_bias_force(const Joint& joint,
                                                                        const Frame<double, double>& f,
                                                                        const SlenderBodyMotion& motion) {
  const double mc = joint.data().mc[0];
  const double more = joint.data().I[0] - joint.data().I[4];
  return {joint.data().mass * f.vd + mc * motion.x_dd, (more * dot(f.R.x, f.w)) * motion.x_d};
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
