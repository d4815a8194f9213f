// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/dynamics/kernel/tangent/nominal_motion.h"
#include "engine/math/dual.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// How a coordinate varies. @tparam T  a number, or one for each of several directions
template <typename T>
struct CoordinateVariation {
  bool varies = false;
  T q{}, qd{}, qdd{};
};

/// How a frame's motion varies, w, v, wd and vd as an observer sees them who turns with the frame: R d(R^T w). For him a
/// chain that is turned as a whole stays as it is, R with it.
template <typename T>
struct VariedFrame {
  Vec3<T> turn, shift;  ///< by how much the frame turns and its origin moves
  Vec3<T> w, v, wd, vd;
};

/// From the variation of the frame of a joint's parent to that of its own.
/// @param coordinates, varies  of the joint's first coordinate on
/// @param own_turn  out: by how much the joint itself turns its frame
template <typename Joint, typename T>
RPSUP_INLINE void vary_joint_frame(const Joint& joint, const JointAxes& axes, const HeldJoint& held, const HeldCoordinate* coordinates,
                                   const CoordinateVariation<T>* varies, VariedFrame<T>& f, Vec3<T>& own_turn) {
  const bool slides = joint.kind == JointShape::Kind::kTranslation;
  if (joint.parent_turns && (joint.shifted || slides)) {
    const Vec3<T> carried = cross(f.w, axes.r);
    f.v += carried;
    f.vd += cross(f.wd, axes.r) + cross(f.w, held.w_r) + cross(held.parent_w, carried);
    f.shift += cross(f.turn, axes.r);
  }
  own_turn = {};
  bool turned = false;
  for (int k = 0; k < joint.count(); ++k) {
    const Vec3<double>& s = axes.axis[k];
    const HeldCoordinate& held_k = coordinates[k];
    if (slides) {
      if (joint.parent_turns) f.vd += 2.0 * cross(f.w, held_k.rate);
      if (!varies[k].varies) continue;
      f.v += varies[k].qd * s - varies[k].q * held_k.s_w;
      f.vd += varies[k].qdd * s - 2.0 * (varies[k].qd * held_k.s_w) - varies[k].q * held_k.s_wd;
      f.shift += varies[k].q * s;
      continue;
    }
    if (varies[k].varies) {
      f.w -= varies[k].q * held_k.s_w;
      f.wd -= varies[k].q * held_k.s_wd;
    }
    if (joint.parent_turns || k > 0) f.wd += cross(f.w, held_k.rate);
    if (varies[k].varies) {
      f.wd += varies[k].qdd * s - varies[k].qd * held_k.s_w;
      f.w += varies[k].qd * s;
      own_turn += varies[k].q * s;
      turned = true;
    }
  }
  if (!turned) return;
  f.v -= cross(own_turn, held.mid_v);
  f.vd -= cross(own_turn, held.mid_vd);
  f.turn += own_turn;
}

/// How the force that a joint's body needs varies, seen by the observer who turns with it.
template <typename Joint, typename T>
[[nodiscard]] RPSUP_INLINE SpatialForce<T> vary_body_force(const Joint& body, const Mat3<double>& R, const HeldJoint& held, const VariedFrame<T>& f) {
  SpatialForce<T> varied;
  if (body.inertia == JointShape::Inertia::kNone) return varied;
  varied.force = body.numbers().mass * f.vd;
  if (!body.com_at_origin) {
    const Vec3<double> mc = rotate_constant(R, body.numbers().mc, body.com_along_x);
    varied.moment = cross(mc, f.vd);
    if (body.turns) varied.force += cross(f.wd, mc) + cross(f.w, cross(held.w, mc)) + cross(held.w, cross(f.w, mc));
  }
  if (!body.turns) return varied;
  if (body.inertia == JointShape::Inertia::kAxisymmetric) {
    const double across = body.numbers().I[4];
    const double more = body.numbers().I[0] - across;
    const Vec3<double>& x = R.x;
    varied.moment += across * f.wd + (more * dot(x, f.wd)) * x + (more * dot(x, held.w)) * cross(f.w, x) + (more * dot(x, f.w)) * cross(held.w, x);
  } else {
    varied.moment += apply_inertia(body, R, f.wd) + cross(f.w, apply_inertia(body, R, held.w)) + cross(held.w, apply_inertia(body, R, f.w));
  }
  return varied;
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
