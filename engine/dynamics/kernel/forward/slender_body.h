// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/dynamics/newton_euler.h"
#include "engine/kinematics/frame_recursion.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// How a rod at a spherical joint moves as long as its angular acceleration is zero.
///
/// Of all links a frame's wd holds what the free coordinates do not add to: what the parent and the turning of the joint's axes make of it. A
/// spherical joint passes none of this on to the rod: its angular acceleration may as well be counted from zero, which leaves less to compute. It is
/// made up for in the accelerations of the joint's angles, from wd - wd_parent - w_parent x w and the axes' turning against each other. Rows of an
/// ideal joint on the rod see no difference: their bias lacks what its SpatialAcceleration, which is then the whole one, adds.
struct RodMotion {
  Vec3<double> x_d, x_dd;      ///< rate of its axis, w x x, and its derivative by time, w x (w x x)
  Vec3<double> lever;          ///< mc vd: its motion needs the moment x x lever
  Vec3<double> wd_carried;     ///< w_parent x w, and wd of a parent that is no rod
  double qdd_turning[3];       ///< what the axes' turning against each other adds to the accelerations of the angles
};

/// From the frame of a rod's parent to its own.
/// @param f       in: the parent's frame
/// @param parent  if that is a rod, its motion
template <typename Joint>
RPSUP_INLINE void calc_rod_frame(const Joint& joint, const RodMotion* parent, const double* sines, const double* cosines, const double* qd,
                                 Frame<double, double>& f, JointAxes& axes, RodMotion& rod) {
  axes.r = {};
  if (joint.shifted && joint.parent_is_rod) {
    const double l = joint.numbers().placement.p[0];
    axes.r = l * f.R.x;
    f.p += axes.r;
    f.v += l * parent->x_d;
    f.vd += l * parent->x_dd;
  } else if (joint.shifted) {
    axes.r = rotate_constant(f.R, joint.numbers().placement.p, joint.shifted_along_x);
    shift_frame(axes.r, joint.parent_turns, f);
  }
  const Vec3<double> parent_w = f.w, parent_wd = f.wd;
  turn_spherical(joint.parent_turns, sines, cosines, qd, f, axes);
  f.wd = {};
  rod.wd_carried = joint.parent_turns ? parent_wd + cross(parent_w, f.w) : Vec3<double>{};
  // -(zd yd z x y + yd xd y x x + zd xd z x x), of the axes z, y and x as they stand, in the basis reciprocal to them.
  const double zy = qd[0] * qd[1], yx = qd[1] * qd[2], inverse = 1.0 / cosines[1];
  rod.qdd_turning[0] = inverse * (zy * sines[1] + yx);
  rod.qdd_turning[1] = -(qd[0] * qd[2]) * cosines[1];
  rod.qdd_turning[2] = inverse * (zy + yx * sines[1]);
  rod.lever = joint.numbers().mc[0] * f.vd;
  rod.x_d = cross(f.w, f.R.x);
  rod.x_dd = cross(f.w, rod.x_d);
}

/// Newton and Euler for a rod, as calc_body_force() has them for any body, but for the moment x x lever.
template <typename Joint>
[[nodiscard]] RPSUP_INLINE SpatialForce<double> calc_rod_force(const Joint& joint, const Frame<double, double>& f, const RodMotion& rod) {
  const double mc = joint.numbers().mc[0];
  const double more = joint.numbers().I[0] - joint.numbers().I[4];
  return {joint.numbers().mass * f.vd + mc * rod.x_dd, (more * dot(f.R.x, f.w)) * rod.x_d};
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
