// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/dynamics/newton_euler.h"
#include "engine/kinematics/frame_recursion.h"
#include "engine/math/instruction_set.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Articulated inertia of the subtree that a joint carries: the 6 x 6 matrix I^A = (A, C; C^T, J) of Eq.
/// (K3), about the origin of the joint's frame, in W. Source: R. Featherstone, Rigid Body Dynamics Algorithms
/// (2008), section 7.1.
struct ArticulatedInertia {
  Sym3<double> A;             ///< force by linear acceleration, [kg]
  Mat3<double> C;             ///< force by angular acceleration, [kg m]
  Sym3<double> J;             ///< moment by angular acceleration, [kg m^2]
  // Of a slender body instead of C and J, see Eq. (K9):
  Sym3<double> child_A;       ///< A of its child
  double child_x = 0.0;       ///< place of the child's joint on its x axis, [m]
};

/// A [r]x
[[nodiscard]] RPSUP_INLINE Mat3<double> times_cross(const Sym3<double>& A, const Vec3<double>& r) {
  return {{A.xy * r.z - A.xz * r.y, A.yy * r.z - A.yz * r.y, A.yz * r.z - A.zz * r.y},
          {A.xz * r.x - A.xx * r.z, A.yz * r.x - A.xy * r.z, A.zz * r.x - A.xz * r.z},
          {A.xx * r.y - A.xy * r.x, A.xy * r.y - A.yy * r.x, A.xz * r.y - A.yz * r.x}};
}

/// J <- J - [r]x B, for a B that makes the product symmetric.
RPSUP_INLINE void subtract_cross(const Vec3<double>& r, const Mat3<double>& B, Sym3<double>& J) {
  J.xx -= r.y * B.x.z - r.z * B.x.y;
  J.yy -= r.z * B.y.x - r.x * B.y.z;
  J.zz -= r.x * B.z.y - r.y * B.z.x;
  J.xy -= r.y * B.y.z - r.z * B.y.y;
  J.xz -= r.y * B.z.z - r.z * B.z.y;
  J.yz -= r.z * B.z.x - r.x * B.z.z;
}

/// J <- J + [r]x C + ([r]x C)^T
RPSUP_INLINE void add_cross_both(const Vec3<double>& r, const Mat3<double>& C, Sym3<double>& J) {
  const Vec3<double> x = cross(r, C.x), y = cross(r, C.y), z = cross(r, C.z);
  J.xx += 2.0 * x.x;
  J.yy += 2.0 * y.y;
  J.zz += 2.0 * z.z;
  J.xy += y.x + x.y;
  J.xz += z.x + x.z;
  J.yz += z.y + y.z;
}

/// C of a rigid body: -[mc]x.
[[nodiscard]] RPSUP_INLINE Mat3<double> first_mass_moment_matrix(const Vec3<double>& mc) {
  return {{0.0, -mc.z, mc.y}, {mc.z, 0.0, -mc.x}, {-mc.y, mc.x, 0.0}};
}

/// Adds the rigid-body inertia of the joint's own body; sets it if the body has no moving children.
template <typename Joint>
RPSUP_INLINE void add_body_inertia(const Joint& joint, const Mat3<double>& R, ArticulatedInertia& inertia) {
  if (!joint.has_moving_children) inertia = ArticulatedInertia{};
  inertia.A.xx += joint.data().mass;
  inertia.A.yy += joint.data().mass;
  inertia.A.zz += joint.data().mass;
  if (!joint.moment_matters || joint.is_slender) return;
  if (!joint.com_at_origin)
    inertia.C += first_mass_moment_matrix(rotate_constant(R, joint.data().mc, joint.com_along_x));
  if (joint.inertia != JointTraits::Inertia::kNone) inertia.J += calc_inertia(joint, R);
}

/// Shifts what the joint's elimination has left by r to the parent's origin, and adds it to the parent: Eq.
/// (K6).
/// @param r  from the parent's origin to the joint's
template <typename Joint>
RPSUP_INLINE void add_to_parent(const Joint& joint, const ArticulatedInertia& inertia, const Vec3<double>& r,
                                ArticulatedInertia& parent) {
  if (joint.last_child) parent = ArticulatedInertia{};  // visited first, so it resets
  parent.A += inertia.A;
  if (joint.parent_is_slender) {
    parent.child_A = inertia.A;
    parent.child_x = joint.data().placement.p[0];
    return;
  }
  if (!joint.parent_moment_matters) return;
  const Mat3<double> B = times_cross(inertia.A, r);
  parent.C.x -= B.x;
  parent.C.y -= B.y;
  parent.C.z -= B.z;
  subtract_cross(r, B, parent.J);
  if (joint.kind == JointTraits::Kind::kSpherical) return;  // C and J are zero: Eq. (K8)
  parent.C += inertia.C;
  parent.J += inertia.J;
  add_cross_both(r, inertia.C, parent.J);
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
