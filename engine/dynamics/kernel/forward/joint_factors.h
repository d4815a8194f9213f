// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "engine/dynamics/kernel/forward/articulated_inertia.h"
#include "engine/dynamics/kernel/forward/slender_body.h"
#include "engine/dynamics/newton_euler.h"
#include "engine/kinematics/frame_recursion.h"
#include "engine/math/instruction_set.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

// The kinds of joints. Each has the three steps of the articulated-body algorithm as functions, eliminate(),
// tip_to_base_force() and base_to_tip_acceleration(), and as members the results of eliminate() that the
// other two need.

/// Angular acceleration of a frame and linear acceleration of its origin, in W, beyond the frame's bias
/// accelerations.
template <typename T>
struct SpatialAcceleration {
  Vec3<T> angular, linear;
};

/// Stands for accelerations of the coordinates that nobody asks for.
template <typename T>
struct NoOutput {
  [[nodiscard]] RPSUP_INLINE NoOutput operator+(int) const { return {}; }
};
template <typename Qdd, typename T>
inline constexpr bool kWanted = !std::is_same_v<Qdd, NoOutput<T>>;

/// A joint of one axis, a rotation or a translation: Eqs. (K4), (K5), (K7). U = (U_a; U_alpha).
struct SingleAxisFactor {
  Vec3<double> U_a, U_alpha;  ///< force and moment by the coordinate's acceleration
  double D_inverse;

  /// @returns whether D is positive
  template <typename Joint>
  RPSUP_INLINE bool eliminate(const Joint& joint, const Mat3<double>& /*R*/, const JointAxes& axes,
                              ArticulatedInertia& inertia) {
    const Vec3<double>& axis = axes.axis[0];
    if (joint.rotates()) {
      U_a = inertia.C * axis;
      U_alpha = inertia.J * axis;
    } else {
      U_a = inertia.A * axis;
      if (joint.moment_matters) U_alpha = transpose_times(inertia.C, axis);
    }
    double D = joint.rotates() ? dot(axis, U_alpha) : dot(axis, U_a);
    if (joint.has_armature) D += joint.data().armature;
    D_inverse = 1.0 / D;
    if (joint.parent_moves) {
      const double minus = -D_inverse;
      add_outer(inertia.A, minus, U_a);
      if (joint.parent_moment_matters) {
        add_outer(inertia.J, minus, U_alpha);
        const Vec3<double> scaled = minus * U_a;
        inertia.C += Mat3<double>{U_alpha.x * scaled, U_alpha.y * scaled, U_alpha.z * scaled};
      }
    }
    return D > 0.0;
  }

  /// @param local  out: D^-1 u in local.x
  /// @param force  in: p^A; out: p^a
  template <typename Joint, typename T, typename Tau>
  RPSUP_INLINE void tip_to_base_force(const Joint& joint, const JointAxes& axes, const Tau& tau,
                                      const Vec3<T>& /*first_moment*/, Vec3<T>& local,
                                      SpatialForce<T>& force) const {
    local.x = D_inverse *
              (tau[0] - (joint.rotates() ? dot(axes.axis[0], force.moment) : dot(axes.axis[0], force.force)));
    force.force += local.x * U_a;
    if (joint.moment_matters) force.moment += local.x * U_alpha;
  }

  /// @param a  in: a', the parent's at the joint's origin; out: of the joint's body
  template <typename Joint, typename T, typename Qdd>
  RPSUP_INLINE void base_to_tip_acceleration(const Joint& joint, const JointAxes& axes, const Vec3<T>& local,
                                             const SlenderBodyMotion* /*motion*/, SpatialAcceleration<T>& a,
                                             const Qdd& qdd) const {
    T acceleration = local.x;
    if (joint.parent_moves) {
      acceleration -= D_inverse * dot(U_a, a.linear);
      if (joint.parent_moment_matters) acceleration -= D_inverse * dot(U_alpha, a.angular);
    }
    if constexpr (kWanted<Qdd, T>) qdd[0] = acceleration;
    if (joint.rotates())
      a.angular += acceleration * axes.axis[0];
    else
      a.linear += acceleration * axes.axis[0];
  }
};

/// The moment that a spherical joint's generalised forces exert: tau along the reciprocal basis.
template <typename T, typename Tau>
[[nodiscard]] RPSUP_INLINE Vec3<T> spherical_moment(const JointAxes& axes, const Tau& tau) {
  return tau[0] * axes.reciprocal.x + tau[1] * axes.reciprocal.y + tau[2] * axes.reciprocal.z;
}

/// Accelerations of a spherical joint's angles: Eq. (K10).
/// @param relative  angular acceleration of the joint's body less that of its parent
/// @param motion    of a slender body whose angular acceleration is measured from zero, else null
template <typename T, typename Qdd>
RPSUP_INLINE void calc_euler_accelerations(const JointAxes& axes, Vec3<T> relative,
                                           const SlenderBodyMotion* motion, const Qdd& qdd) {
  if (motion) relative = relative - motion->wd_bias;
  qdd[0] = dot(axes.reciprocal.x, relative);
  qdd[1] = dot(axes.reciprocal.y, relative);
  qdd[2] = dot(axes.reciprocal.z, relative);
  if (!motion) return;
  qdd[0] = motion->qdd_bias[0] + qdd[0];
  qdd[1] = motion->qdd_bias[1] + qdd[1];
  qdd[2] = motion->qdd_bias[2] + qdd[2];
}

/// A spherical joint, its three rotations at once, whatever their axes: Eq. (K8). The unknown is alpha -
/// alpha', so that H = (0; 1), U = (C; J) and D = J. alpha' cancels: alpha itself results. Nothing but a
/// force passes to the parent.
struct SphericalFactor {
  Mat3<double> C;
  Sym3<double> J_inverse;

  /// @returns whether J is positive definite
  template <typename Joint>
  RPSUP_INLINE bool eliminate(const Joint& joint, const Mat3<double>& /*R*/, const JointAxes& /*axes*/,
                              ArticulatedInertia& inertia) {
    const Sym3Inverse<double> inverse = invert(inertia.J);
    if (!(inverse.determinant > 0.0)) return false;
    J_inverse = inverse.matrix;
    C = inertia.C;
    if (joint.parent_moves) subtract_spherical_joint(inertia.A);
    return true;
  }

  template <typename Joint, typename T, typename Tau>
  RPSUP_INLINE void tip_to_base_force(const Joint& /*joint*/, const JointAxes& axes, const Tau& tau,
                                      const Vec3<T>& /*first_moment*/, Vec3<T>& local,
                                      SpatialForce<T>& force) const {
    const Vec3<T> moment = spherical_moment<T>(axes, tau);
    local = J_inverse * (moment - force.moment);
    force.force += C * local;
    force.moment = moment;
  }

  template <typename Joint, typename T, typename Qdd>
  RPSUP_INLINE void base_to_tip_acceleration(const Joint& joint, const JointAxes& axes, const Vec3<T>& local,
                                             const SlenderBodyMotion* /*motion*/, SpatialAcceleration<T>& a,
                                             const Qdd& qdd) const {
    Vec3<T> alpha = local;
    if (joint.parent_moves) alpha -= J_inverse * transpose_times(C, a.linear);
    if constexpr (kWanted<Qdd, T>) calc_euler_accelerations(axes, alpha - a.angular, nullptr, qdd);
    a.angular = alpha;
  }

 private:
  /// A <- A - C J^-1 C^T
  RPSUP_INLINE void subtract_spherical_joint(Sym3<double>& A) const {
    const Vec3<double> row_x{C.x.x, C.y.x, C.z.x}, row_y{C.x.y, C.y.y, C.z.y}, row_z{C.x.z, C.y.z, C.z.z};
    const Vec3<double> x = J_inverse * row_x, y = J_inverse * row_y, z = J_inverse * row_z;
    A.xx -= dot(row_x, x);
    A.yy -= dot(row_y, y);
    A.zz -= dot(row_z, z);
    A.xy -= dot(row_x, y);
    A.xz -= dot(row_x, z);
    A.yz -= dot(row_y, z);
  }
};

/// The spherical joint of a slender body: Eq. (K9), the same in the body's own frame, where D has the blocks
/// D_xx and that of y and z, and C x = 0. So U and J need not be assembled.
struct SlenderBodyFactor {
  Mat3<double> R;
  Vec3<double> U_D_inverse_y, U_D_inverse_z;  ///< columns y and z of U_a D^-1
  double D_inverse_xx, D_inverse_yy, D_inverse_yz, D_inverse_zz;

  /// @returns whether D is positive definite
  template <typename Joint>
  RPSUP_INLINE bool eliminate(const Joint& joint, const Mat3<double>& R_WB, const JointAxes& /*axes*/,
                              ArticulatedInertia& inertia) {
    R = R_WB;
    D_inverse_xx = 1.0 / joint.data().I[0];
    const double determinant = joint.has_moving_children ? eliminate_loaded_slender(joint, inertia)
                                                         : eliminate_tip_slender(joint, inertia);
    return determinant > 0.0 && joint.data().I[0] > 0.0;
  }

  /// @param first_moment  L: force.moment is without the moment x x L
  /// @param local  in the body's frame
  template <typename Joint, typename T, typename Tau>
  RPSUP_INLINE void tip_to_base_force(const Joint& /*joint*/, const JointAxes& axes, const Tau& tau,
                                      const Vec3<T>& first_moment, Vec3<T>& local,
                                      SpatialForce<T>& force) const {
    const Vec3<T> moment = spherical_moment<T>(axes, tau);
    Vec3<T> u = transpose_times(R, moment - force.moment);
    u.y += dot(R.z, first_moment);
    u.z -= dot(R.y, first_moment);
    local = {D_inverse_xx * u.x, D_inverse_yy * u.y + D_inverse_yz * u.z,
             D_inverse_yz * u.y + D_inverse_zz * u.z};
    force.force += u.y * U_D_inverse_y + u.z * U_D_inverse_z;
    force.moment = moment;
  }

  template <typename Joint, typename T, typename Qdd>
  RPSUP_INLINE void base_to_tip_acceleration(const Joint& joint, const JointAxes& axes, const Vec3<T>& local,
                                             const SlenderBodyMotion* motion, SpatialAcceleration<T>& a,
                                             const Qdd& qdd) const {
    Vec3<T> alpha = local;
    if (joint.parent_moves) {
      alpha.y -= dot(U_D_inverse_y, a.linear);
      alpha.z -= dot(U_D_inverse_z, a.linear);
    }
    alpha = R * alpha;
    if constexpr (kWanted<Qdd, T>) calc_euler_accelerations(axes, alpha - a.angular, motion, qdd);
    a.angular = alpha;
  }

 private:
  /// With child_A at l x, and B = mc 1 + l child_A:  U_a y = -B z,  U_a z = B y,
  /// D_yy = I_y - l mc + l z B z,  D_zz = I_y - l mc + l y B y,  D_yz = -l z B y.
  template <typename Joint>
  RPSUP_INLINE double eliminate_loaded_slender(const Joint& joint, ArticulatedInertia& inertia) {
    const double mc = joint.data().mc[0], l = inertia.child_x;
    Sym3<double> B = l * inertia.child_A;
    B.xx += mc;
    B.yy += mc;
    B.zz += mc;
    const Vec3<double> B_y = B * R.y, B_z = B * R.z;
    const double beyond_B = joint.data().I[4] - l * mc;
    const double D_yy = beyond_B + l * dot(R.z, B_z), D_zz = beyond_B + l * dot(R.y, B_y),
                 minus_D_yz = l * dot(R.z, B_y);
    const double determinant = D_yy * D_zz - minus_D_yz * minus_D_yz;
    const double inverse = 1.0 / determinant;
    D_inverse_yy = inverse * D_zz;
    D_inverse_yz = inverse * minus_D_yz;
    D_inverse_zz = inverse * D_yy;
    U_D_inverse_y = D_inverse_yz * B_y - D_inverse_yy * B_z;
    U_D_inverse_z = D_inverse_zz * B_y - D_inverse_yz * B_z;
    if (joint.parent_moves) {
      add_half_outer(inertia.A, U_D_inverse_y, B_z);
      add_half_outer(inertia.A, -U_D_inverse_z, B_y);
    }
    return determinant;
  }

  /// Without a child:  U_a y = -mc z,  U_a z = mc y,  D_yy = D_zz = I_y,  D_yz = 0.
  template <typename Joint>
  RPSUP_INLINE double eliminate_tip_slender(const Joint& joint, ArticulatedInertia& inertia) {
    const double mc = joint.data().mc[0], I_y = joint.data().I[4];
    D_inverse_yy = D_inverse_zz = 1.0 / I_y;
    D_inverse_yz = 0.0;
    const double scaled = mc * D_inverse_yy;
    U_D_inverse_y = -scaled * R.z;
    U_D_inverse_z = scaled * R.y;
    if (joint.parent_moves) {  // y y^T + z z^T = 1 - x x^T
      const double across = mc * scaled;
      inertia.A.xx -= across;
      inertia.A.yy -= across;
      inertia.A.zz -= across;
      add_outer(inertia.A, across, R.x);
    }
    return I_y;
  }
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
