// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/kinematics/frame_recursion.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Force, and moment about a frame's origin, in W. Source: R. Featherstone, Rigid Body Dynamics Algorithms
/// (2008), chapter 2.
template <typename T>
struct SpatialForce {
  Vec3<T> force, moment;
};

template <typename T>
RPSUP_INLINE SpatialForce<T>& operator+=(SpatialForce<T>& a, const SpatialForce<T>& b) {
  a.force += b.force;
  a.moment += b.moment;
  return a;
}

/// Inertia matrix of a joint's body about its frame's origin, in W.
template <typename Joint, typename P>
[[nodiscard]] RPSUP_INLINE Sym3<P> calc_inertia(const Joint& body, const Mat3<P>& R) {
  const std::array<double, 9>& moments = body.data().I;
  Sym3<P> I;
  if (body.inertia == JointTraits::Inertia::kAxisymmetric) {
    add_outer(I, moments[0] - moments[4], R.x);
    I.xx += moments[4];
    I.yy += moments[4];
    I.zz += moments[4];
  } else if (body.inertia == JointTraits::Inertia::kDiagonal) {
    add_outer(I, moments[0], R.x);
    add_outer(I, moments[4], R.y);
    add_outer(I, moments[8], R.z);
  } else if (body.inertia == JointTraits::Inertia::kFull) {
    const Mat3<P> RI = multiply_constant(R, moments);
    const auto entry = [&](const P& ax, const P& ay, const P& az, const P& bx, const P& by, const P& bz) {
      return ax * bx + ay * by + az * bz;
    };
    I.xx = entry(RI.x.x, RI.y.x, RI.z.x, R.x.x, R.y.x, R.z.x);
    I.yy = entry(RI.x.y, RI.y.y, RI.z.y, R.x.y, R.y.y, R.z.y);
    I.zz = entry(RI.x.z, RI.y.z, RI.z.z, R.x.z, R.y.z, R.z.z);
    I.xy = entry(RI.x.x, RI.y.x, RI.z.x, R.x.y, R.y.y, R.z.y);
    I.xz = entry(RI.x.x, RI.y.x, RI.z.x, R.x.z, R.y.z, R.z.z);
    I.yz = entry(RI.x.y, RI.y.y, RI.z.y, R.x.z, R.y.z, R.z.z);
  }
  return I;
}

/// I v with the inertia matrix of a joint's body about its frame's origin, in W.
template <typename Joint, typename P, typename T>
[[nodiscard]] RPSUP_INLINE Vec3<T> apply_inertia(const Joint& body, const Mat3<P>& R, const Vec3<T>& v) {
  if (body.inertia == JointTraits::Inertia::kFull) return calc_inertia(body, R) * v;
  const std::array<double, 9>& moments = body.data().I;
  return (moments[0] * dot(R.x, v)) * R.x + (moments[4] * dot(R.y, v)) * R.y +
         (moments[8] * dot(R.z, v)) * R.z;
}

/// Newton-Euler force of a joint's body about its frame's origin, in W: the force that moves the body as its
/// frame moves, Eq. (K2).
///
///     f = m vd + wd x mc + w x (w x mc),   n = mc x vd + I wd + w x I w
///
/// With the bias accelerations of the frame, this is the body's bias force before loads are subtracted.
template <typename Joint, typename P, typename V>
[[nodiscard]] RPSUP_INLINE SpatialForce<V> calc_newton_euler_force(const Joint& body, const Frame<P, V>& f) {
  SpatialForce<V> bias_force;
  if (body.inertia == JointTraits::Inertia::kNone) return bias_force;
  bias_force.force = body.data().mass * f.vd;
  if (!body.com_at_origin) {
    const Vec3<P> mc = rotate_constant(f.R, body.data().mc, body.com_along_x);
    bias_force.moment = cross(mc, f.vd);
    if (body.frame_rotates) bias_force.force += cross(f.wd, mc) + cross(f.w, cross(f.w, mc));
  }
  if (!body.frame_rotates) return bias_force;
  if (body.inertia == JointTraits::Inertia::kAxisymmetric) {
    const double across = body.data().I[4];
    const double more = body.data().I[0] - across;
    bias_force.moment +=
        across * f.wd + (more * dot(f.R.x, f.wd)) * f.R.x + (more * dot(f.R.x, f.w)) * cross(f.w, f.R.x);
  } else {
    bias_force.moment += apply_inertia(body, f.R, f.wd) + cross(f.w, apply_inertia(body, f.R, f.w));
  }
  return bias_force;
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
