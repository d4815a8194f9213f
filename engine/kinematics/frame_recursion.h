// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "engine/kinematics/tree_model.h"
#include "engine/math/dual.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Pose, velocity and acceleration of the frame F of a joint's body, in W.
/// P: what depends on positions; V: what depends on velocities as well.
template <typename P, typename V>
struct Frame {
  Mat3<P> R;        ///< R_WF
  Vec3<P> p;        ///< origin, [m]
  Vec3<V> w, v;     ///< angular velocity; velocity of the origin
  Vec3<V> wd, vd;   ///< angular acceleration; acceleration of the origin less that of gravity
};

/// Sine and cosine of a coordinate.
struct Turn {
  double sine, cosine;
};

/// How a joint stands: what the equations of motion need beside its frame.
struct JointAxes {
  Vec3<double> r;        ///< the frame's origin seen from that of the parent's, [m]
  Vec3<double> axis[3];  ///< of its coordinates
  Mat3<double> dual;     ///< spherical: the basis reciprocal to the three axes; not a number where two of them meet
};

[[nodiscard]] RPSUP_INLINE Frame<double, double> make_ground(const TreeModel& model) {
  Frame<double, double> ground;
  ground.R.x.x = ground.R.y.y = ground.R.z.z = 1.0;
  ground.vd = {-model.gravity[0], -model.gravity[1], -model.gravity[2]};
  return ground;
}

template <typename P>
[[nodiscard]] RPSUP_INLINE Vec3<P> rotate_constant(const Mat3<P>& R, const std::array<double, 3>& v, bool along_x) {
  return along_x ? v[0] * R.x : v[0] * R.x + v[1] * R.y + v[2] * R.z;
}

template <typename P>
[[nodiscard]] RPSUP_INLINE Mat3<P> multiply_constant(const Mat3<P>& R, const std::array<double, 9>& m) {
  return {m[0] * R.x + m[1] * R.y + m[2] * R.z, m[3] * R.x + m[4] * R.y + m[5] * R.z, m[6] * R.x + m[7] * R.y + m[8] * R.z};
}

/// Moves a frame's origin, which rotates with it, by r.
template <typename P, typename V>
RPSUP_INLINE void shift_frame(const Vec3<P>& r, bool turns, Frame<P, V>& f) {
  f.p += r;
  if (!turns) return;
  const Vec3<V> carried = cross(f.w, r);
  f.v += carried;
  f.vd += cross(f.wd, r) + cross(f.w, carried);
}

/// Adds a rate of turning about the axis s, which the frame carries.
template <typename P, typename V>
RPSUP_INLINE void add_turning(const Vec3<double>& s, bool turns, const V& qd, Frame<P, V>& f) {
  const Vec3<V> rate = qd * s;
  if (turns) f.wd += cross(f.w, rate);
  f.w += rate;
}

/// Turns a frame's axes about one of them, which stays, by changing the two beside it. @returns that axis
RPSUP_INLINE Vec3<double> turn_axes(int axis, const Turn& q, Mat3<double>& R) {
  const auto turn = [&](const Vec3<double>& own, Vec3<double>& i, Vec3<double>& j) {
    const Vec3<double> old_i = i;
    i = q.cosine * old_i + q.sine * j;
    j = q.cosine * j - q.sine * old_i;
    return own;
  };
  return axis == 0 ? turn(R.x, R.y, R.z) : axis == 1 ? turn(R.y, R.z, R.x) : turn(R.z, R.x, R.y);
}

/// Turns a frame about its own axis; the rest of its motion follows from the rate.
RPSUP_INLINE void turn_frame(int axis, bool turns, const Turn& q, double qd, Frame<double, double>& f, Vec3<double>& s) {
  s = turn_axes(axis, q, f.R);
  add_turning(s, turns, qd, f);
}

/// Adds a rate of sliding along the axis s, which the frame carries.
template <typename P, typename V>
RPSUP_INLINE void add_sliding(const Vec3<double>& s, bool turns, const V& qd, Frame<P, V>& f) {
  const Vec3<V> rate = qd * s;
  f.v += rate;
  if (turns) f.vd += 2.0 * cross(f.w, rate);
}

/// Slides a frame along an axis.
RPSUP_INLINE void slide_frame(const Vec3<double>& s, bool turns, double q, double qd, Frame<double, double>& f, Vec3<double>& r) {
  const Vec3<double> along = q * s;
  r += along;
  shift_frame(along, turns, f);
  add_sliding(s, turns, qd, f);
}

[[nodiscard]] RPSUP_INLINE const Vec3<double>& axis_of(const Mat3<double>& R, int axis) {
  return axis == 0 ? R.x : axis == 1 ? R.y : R.z;
}

/// Turns a frame about its own z, then y, then x. @param sines, cosines, qd  of the three angles
RPSUP_INLINE void turn_spherical(bool turns, const double* sines, const double* cosines, const double* qd, Frame<double, double>& f, JointAxes& axes) {
  turn_frame(2, turns, {sines[0], cosines[0]}, qd[0], f, axes.axis[0]);
  const Vec3<double> x = f.R.x;
  turn_frame(1, true, {sines[1], cosines[1]}, qd[1], f, axes.axis[1]);
  const double inverse = 1.0 / cosines[1];
  axes.dual = {inverse * f.R.z, axes.axis[1], inverse * x};
  turn_frame(0, true, {sines[2], cosines[2]}, qd[2], f, axes.axis[2]);
}

/// From the frame of a joint's parent to its own, Eq. (2) and its derivatives by time; accelerations without those of free coordinates.
/// @param f  in: the parent's frame
/// @param q, sines, cosines, qd, qdd  of the joint's first coordinate on; sines and cosines of rotations only, qdd of a driven one only
template <typename Joint>
RPSUP_INLINE void calc_joint_frame(const Joint& joint, const double* q, const double* sines, const double* cosines, const double* qd,
                                   const double* qdd, Frame<double, double>& f, JointAxes& axes) {
  if (joint.shifted) {
    axes.r = rotate_constant(f.R, joint.numbers().placement.p, joint.shifted_along_x);
    shift_frame(axes.r, joint.parent_turns, f);
  } else {
    axes.r = {};
  }
  if (joint.turned) f.R = multiply_constant(f.R, joint.numbers().placement.R);
  if (joint.kind == JointShape::Kind::kTranslation) {
    axes.axis[0] = axis_of(f.R, joint.axis);
    slide_frame(axes.axis[0], joint.parent_turns, q[0], qd[0], f, axes.r);
    if (joint.driven) f.vd += qdd[0] * axes.axis[0];
  } else if (joint.kind == JointShape::Kind::kRotation) {
    turn_frame(joint.axis, joint.parent_turns, {sines[0], cosines[0]}, qd[0], f, axes.axis[0]);
    if (joint.driven) f.wd += qdd[0] * axes.axis[0];
  } else {
    turn_spherical(joint.parent_turns, sines, cosines, qd, f, axes);
  }
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
