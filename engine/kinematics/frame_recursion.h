#pragma once

#include <cmath>

#include "engine/dynamics/tree_model.h"
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
template <typename P>
struct Turn {
  P sine, cosine;
};

/// How a joint stands: what the equations of motion need beside its frame.
template <typename P>
struct JointAxes {
  Vec3<P> r;        ///< the frame's origin seen from that of the parent's, [m]
  Vec3<P> axis[3];  ///< of its coordinates
  Mat3<P> dual;     ///< spherical: the basis reciprocal to the three axes; not a number where two of them meet
};

template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE Frame<P, V> make_ground(const TreeModel& model) {
  Frame<P, V> ground;
  ground.R.x.x = ground.R.y.y = ground.R.z.z = P(1.0);
  ground.vd = {V(-model.gravity[0]), V(-model.gravity[1]), V(-model.gravity[2])};
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

/// Turns a frame about its own axis: the two columns beside it change, the rest follows from the rate.
template <typename P, typename V>
RPSUP_INLINE void turn_frame(int axis, bool turns, const Turn<P>& q, const V& qd, Frame<P, V>& f, Vec3<P>& s) {
  const auto turn = [&](const Vec3<P>& own, Vec3<P>& i, Vec3<P>& j) {
    s = own;
    const Vec3<P> old_i = i;
    i = q.cosine * old_i + q.sine * j;
    j = q.cosine * j - q.sine * old_i;
  };
  if (axis == 0)
    turn(f.R.x, f.R.y, f.R.z);
  else if (axis == 1)
    turn(f.R.y, f.R.z, f.R.x);
  else
    turn(f.R.z, f.R.x, f.R.y);
  const Vec3<V> rate = qd * s;
  if (turns) f.wd += cross(f.w, rate);
  f.w += rate;
}

/// Slides a frame along an axis.
template <typename P, typename V>
RPSUP_INLINE void slide_frame(const Vec3<P>& s, bool turns, const P& q, const V& qd, Frame<P, V>& f, Vec3<P>& r) {
  const Vec3<P> along = q * s;
  r += along;
  shift_frame(along, turns, f);
  const Vec3<V> rate = qd * s;
  f.v += rate;
  if (turns) f.vd += 2.0 * cross(f.w, rate);
}

template <typename P>
[[nodiscard]] RPSUP_INLINE const Vec3<P>& axis_of(const Mat3<P>& R, int axis) {
  return axis == 0 ? R.x : axis == 1 ? R.y : R.z;
}

/// From the frame of a joint's parent to its own, Eq. (2) and its derivatives by time; accelerations without those of free coordinates.
/// @param f  in: the parent's frame
/// @param q, turns, qd, qdd  of the joint's first coordinate on; turns of rotations only, qdd of a driven one only
template <typename Joint, typename P, typename V>
RPSUP_INLINE void calc_joint_frame(const Joint& joint, const P* q, const Turn<P>* turns, const V* qd, const V* qdd, Frame<P, V>& f,
                                   JointAxes<P>& axes) {
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
    turn_frame(joint.axis, joint.parent_turns, turns[0], qd[0], f, axes.axis[0]);
    if (joint.driven) f.wd += qdd[0] * axes.axis[0];
  } else {
    turn_frame(2, joint.parent_turns, turns[0], qd[0], f, axes.axis[0]);
    const Vec3<P> x = f.R.x;
    turn_frame(1, true, turns[1], qd[1], f, axes.axis[1]);
    const P inverse = 1.0 / dot(axes.axis[0], f.R.z);  // 1 / cos theta
    axes.dual = {inverse * f.R.z, axes.axis[1], inverse * x};
    turn_frame(0, true, turns[2], qd[2], f, axes.axis[2]);
  }
}

template <typename P>
[[nodiscard]] RPSUP_INLINE Turn<P> calc_turn(const P& q) {
  const double sine = std::sin(value_of(q));
  const double cosine = std::cos(value_of(q));
  return {differentiate(q, sine, cosine), differentiate(q, cosine, -sine)};
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
