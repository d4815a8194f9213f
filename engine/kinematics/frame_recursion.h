// SPDX-License-Identifier: Apache-2.0
#pragma once

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

/// Sine and cosine of an angle.
struct SineCosine {
  double sine, cosine;
};

/// Axes of a joint, in W.
struct JointAxes {
  Vec3<double> r;        ///< the frame's origin seen from that of the parent's, [m]
  Vec3<double> axis[3];  ///< of its coordinates
  /// spherical: the basis reciprocal to the three axes; not a number where two of them meet
  Mat3<double> reciprocal;
};

[[nodiscard]] RPSUP_INLINE Frame<double, double> make_ground(const TreeModel& model) {
  Frame<double, double> ground;
  ground.R.x.x = ground.R.y.y = ground.R.z.z = 1.0;
  ground.vd = {-model.gravity[0], -model.gravity[1], -model.gravity[2]};
  return ground;
}

template <typename P>
[[nodiscard]] RPSUP_INLINE Vec3<P> rotate_constant(const Mat3<P>& R, const std::array<double, 3>& v,
                                                   bool along_x) {
  return along_x ? v[0] * R.x : v[0] * R.x + v[1] * R.y + v[2] * R.z;
}

template <typename P>
[[nodiscard]] RPSUP_INLINE Mat3<P> multiply_constant(const Mat3<P>& R, const std::array<double, 9>& m) {
  return {m[0] * R.x + m[1] * R.y + m[2] * R.z, m[3] * R.x + m[4] * R.y + m[5] * R.z,
          m[6] * R.x + m[7] * R.y + m[8] * R.z};
}

/// Shifts a frame's origin by r, which is fixed in the frame.
template <typename P, typename V>
RPSUP_INLINE void shift_frame(const Vec3<P>& r, bool frame_rotates, Frame<P, V>& f) {
  f.p += r;
  if (!frame_rotates) return;
  const Vec3<V> carried = cross(f.w, r);
  f.v += carried;
  f.vd += cross(f.wd, r) + cross(f.w, carried);
}

/// Adds a rotation rate about the axis s, which is fixed in the frame.
template <typename P, typename V>
RPSUP_INLINE void add_rotation_rate(const Vec3<double>& s, bool frame_rotates, const V& qd, Frame<P, V>& f) {
  const Vec3<V> rate = qd * s;
  if (frame_rotates) f.wd += cross(f.w, rate);
  f.w += rate;
}

/// Rotates a frame's axes about one of them: the other two change. @returns that axis
RPSUP_INLINE Vec3<double> rotate_axes(int axis, const SineCosine& q, Mat3<double>& R) {
  const auto rotate_pair = [&](const Vec3<double>& fixed, Vec3<double>& i, Vec3<double>& j) {
    const Vec3<double> old_i = i;
    i = q.cosine * old_i + q.sine * j;
    j = q.cosine * j - q.sine * old_i;
    return fixed;
  };
  return axis == 0   ? rotate_pair(R.x, R.y, R.z)
         : axis == 1 ? rotate_pair(R.y, R.z, R.x)
                     : rotate_pair(R.z, R.x, R.y);
}

/// Rotates a frame, and its motion, about one of its axes.
RPSUP_INLINE void rotate_frame(int axis, bool frame_rotates, const SineCosine& q, double qd,
                               Frame<double, double>& f, Vec3<double>& s) {
  s = rotate_axes(axis, q, f.R);
  add_rotation_rate(s, frame_rotates, qd, f);
}

/// Adds a translation rate along the axis s, which is fixed in the frame.
template <typename P, typename V>
RPSUP_INLINE void add_translation_rate(const Vec3<double>& s, bool frame_rotates, const V& qd,
                                       Frame<P, V>& f) {
  const Vec3<V> rate = qd * s;
  f.v += rate;
  if (frame_rotates) f.vd += 2.0 * cross(f.w, rate);
}

/// Translates a frame, and its motion, along an axis.
RPSUP_INLINE void translate_frame(const Vec3<double>& s, bool frame_rotates, double q, double qd,
                                  Frame<double, double>& f, Vec3<double>& r) {
  const Vec3<double> along = q * s;
  r += along;
  shift_frame(along, frame_rotates, f);
  add_translation_rate(s, frame_rotates, qd, f);
}

[[nodiscard]] RPSUP_INLINE const Vec3<double>& axis_of(const Mat3<double>& R, int axis) {
  return axis == 0 ? R.x : axis == 1 ? R.y : R.z;
}

/// Rotates a frame about its z, then y, then x axis. @param sines, cosines, qd  of the three angles
RPSUP_INLINE void rotate_spherical(bool frame_rotates, const double* sines, const double* cosines,
                                   const double* qd, Frame<double, double>& f, JointAxes& axes) {
  rotate_frame(2, frame_rotates, {sines[0], cosines[0]}, qd[0], f, axes.axis[0]);
  const Vec3<double> x = f.R.x;
  rotate_frame(1, true, {sines[1], cosines[1]}, qd[1], f, axes.axis[1]);
  const double inverse = 1.0 / cosines[1];
  axes.reciprocal = {inverse * f.R.z, axes.axis[1], inverse * x};
  rotate_frame(0, true, {sines[2], cosines[2]}, qd[2], f, axes.axis[2]);
}

/// Frame of a joint from that of its parent, Eq. (2) and its derivatives by time. Accelerations are the bias
/// ones: those without the qdd of free coordinates.
/// @param f  in: the parent's frame
/// @param q, sines, cosines, qd, qdd  of the joint's first coordinate on; sines and cosines of rotations
/// only, qdd of a driven one only
template <typename Joint>
RPSUP_INLINE void calc_joint_frame(const Joint& joint, const double* q, const double* sines,
                                   const double* cosines, const double* qd, const double* qdd,
                                   Frame<double, double>& f, JointAxes& axes) {
  if (joint.shifted) {
    axes.r = rotate_constant(f.R, joint.data().placement.p, joint.shifted_along_x);
    shift_frame(axes.r, joint.parent_frame_rotates, f);
  } else {
    axes.r = {};
  }
  if (joint.rotated) f.R = multiply_constant(f.R, joint.data().placement.R);
  if (joint.kind == JointTraits::Kind::kTranslation) {
    axes.axis[0] = axis_of(f.R, joint.axis);
    translate_frame(axes.axis[0], joint.parent_frame_rotates, q[0], qd[0], f, axes.r);
    if (joint.driven) f.vd += qdd[0] * axes.axis[0];
  } else if (joint.kind == JointTraits::Kind::kRotation) {
    rotate_frame(joint.axis, joint.parent_frame_rotates, {sines[0], cosines[0]}, qd[0], f, axes.axis[0]);
    if (joint.driven) f.wd += qdd[0] * axes.axis[0];
  } else {
    rotate_spherical(joint.parent_frame_rotates, sines, cosines, qd, f, axes);
  }
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
