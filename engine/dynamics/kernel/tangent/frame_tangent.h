// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/dynamics/kernel/tangent/nominal_motion.h"
#include "engine/math/dual.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Tangent (dq, dqd, dqdd) of a coordinate. @tparam T  a number, or a pack: one lane a seed
template <typename T>
struct CoordinateTangent {
  bool active = false;  ///< not zero in all lanes
  T q{}, qd{}, qdd{};
};

/// Corotational tangent of a frame: its rotation and translation, and the tangents of w, v, wd, vd as seen in
/// the frame, Eq. (K16),
///
///     w stands for R d(R^T w) = dw - rotation x w
///
/// so that a chain that is rotated as a whole has no tangent but the rotation and the translation.
template <typename T>
struct FrameTangent {
  Vec3<T> rotation, translation;  ///< of the frame, and of its origin, in W
  Vec3<T> w, v, wd, vd;
};

/// Tangent of a joint's frame, Eq. (K17).
/// @param coordinates, seed  of the joint's first coordinate on
/// @param f               in: tangent of the parent's frame; out: of the joint's
/// @param joint_rotation  out: rotation of the frame against the parent's
template <typename Joint, typename T>
RPSUP_INLINE void calc_frame_tangent(const Joint& joint, const JointAxes& axes, const NominalJoint& nominal,
                                     const NominalCoordinate* coordinates, const CoordinateTangent<T>* seed,
                                     FrameTangent<T>& f, Vec3<T>& joint_rotation) {
  const bool slides = joint.kind == JointTraits::Kind::kTranslation;
  if (joint.parent_frame_rotates && (joint.shifted || slides)) {
    const Vec3<T> carried = cross(f.w, axes.r);
    f.v += carried;
    f.vd += cross(f.wd, axes.r) + cross(f.w, nominal.w_r) + cross(nominal.parent_w, carried);
    f.translation += cross(f.rotation, axes.r);
  }
  joint_rotation = {};
  bool rotated = false;
  for (int k = 0; k < joint.count(); ++k) {
    const Vec3<double>& s = axes.axis[k];
    const NominalCoordinate& nominal_k = coordinates[k];
    if (slides) {
      if (joint.parent_frame_rotates) f.vd += 2.0 * cross(f.w, nominal_k.rate);
      if (!seed[k].active) continue;
      f.v += seed[k].qd * s - seed[k].q * nominal_k.s_w;
      f.vd += seed[k].qdd * s - 2.0 * (seed[k].qd * nominal_k.s_w) - seed[k].q * nominal_k.s_wd;
      f.translation += seed[k].q * s;
      continue;
    }
    if (seed[k].active) {
      f.w -= seed[k].q * nominal_k.s_w;
      f.wd -= seed[k].q * nominal_k.s_wd;
    }
    if (joint.parent_frame_rotates || k > 0) f.wd += cross(f.w, nominal_k.rate);
    if (seed[k].active) {
      f.wd += seed[k].qdd * s - seed[k].qd * nominal_k.s_w;
      f.w += seed[k].qd * s;
      joint_rotation += seed[k].q * s;
      rotated = true;
    }
  }
  if (!rotated) return;
  f.v -= cross(joint_rotation, nominal.mid_v);
  f.vd -= cross(joint_rotation, nominal.mid_vd);
  f.rotation += joint_rotation;
}

/// Tangent of a frame that is fixed to that of f, with its origin at r from the origin of f. wd and vd are
/// left as they are.
template <typename T>
[[nodiscard]] RPSUP_INLINE FrameTangent<T> shift_origin(FrameTangent<T> f, const Vec3<double>& r) {
  f.translation += cross(f.rotation, r);
  f.v += cross(f.w, r);
  return f;
}

/// Corotational tangent of the Newton-Euler force of a joint's body: Eq. (K18).
template <typename Joint, typename T>
[[nodiscard]] RPSUP_INLINE SpatialForce<T> calc_newton_euler_tangent(const Joint& body, const Mat3<double>& R,
                                                                     const NominalJoint& nominal,
                                                                     const FrameTangent<T>& f) {
  SpatialForce<T> force;
  if (body.inertia == JointTraits::Inertia::kNone) return force;
  force.force = body.data().mass * f.vd;
  if (!body.com_at_origin) {
    const Vec3<double> mc = rotate_constant(R, body.data().mc, body.com_along_x);
    force.moment = cross(mc, f.vd);
    if (body.frame_rotates)
      force.force += cross(f.wd, mc) + cross(f.w, cross(nominal.w, mc)) + cross(nominal.w, cross(f.w, mc));
  }
  if (!body.frame_rotates) return force;
  if (body.inertia == JointTraits::Inertia::kAxisymmetric) {
    const double across = body.data().I[4];
    const double more = body.data().I[0] - across;
    const Vec3<double>& x = R.x;
    force.moment += across * f.wd + (more * dot(x, f.wd)) * x + (more * dot(x, nominal.w)) * cross(f.w, x) +
                    (more * dot(x, f.w)) * cross(nominal.w, x);
  } else {
    force.moment += apply_inertia(body, R, f.wd) + cross(f.w, apply_inertia(body, R, nominal.w)) +
                    cross(nominal.w, apply_inertia(body, R, f.w));
  }
  return force;
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
