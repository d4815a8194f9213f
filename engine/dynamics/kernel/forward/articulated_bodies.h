// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "engine/dynamics/kernel/forward/articulated_inertia.h"
#include "engine/dynamics/kernel/forward/joint_factors.h"
#include "engine/dynamics/kernel/forward/slender_body.h"
#include "engine/dynamics/newton_euler.h"
#include "engine/kinematics/frame_recursion.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/lanes.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Generalised forces of one motion, in the first lane of a pack of seeds.
struct FirstSeedForces {
  const double* tau;
  [[nodiscard]] RPSUP_INLINE FirstSeedForces operator+(int k) const { return {tau + k}; }
  [[nodiscard]] RPSUP_INLINE TangentPack operator[](int k) const { return TangentPack::first(tau[k]); }
};

/// A vector of one motion; of a pack of seeds, in its first lane.
template <typename T>
[[nodiscard]] RPSUP_INLINE Vec3<T> in_first_lane(const Vec3<double>& v) {
  if constexpr (std::is_same_v<T, double>)
    return v;
  else
    return {T::first(v.x), T::first(v.y), T::first(v.z)};
}

/// The articulated-body algorithm: M qdd = tau - h of the open chains solved for qdd in O(n), without M.
///
///     factor(), tip to base   I^A <- I of the body + sum of the children's I^a        (K6)
///                             U = I^A H,  D = H^T U + J_a                             (K4)
///                             I^a = I^A - U D^-1 U^T                                  (K5)
///     solve(), tip to base    p^A <- p of the body + sum of the children's p^a        (K6)
///                             u = tau - H^T p^A                                       (K4)
///                             p^a = p^A + U D^-1 u                                    (K5)
///              base to tip    a' = the parent's a at the joint                        (K7)
///                             qdd = D^-1 (u - U^T a'),  a = a' + H qdd                (K7)
///
/// Velocity-product terms are in the bias accelerations wd, vd of the frames, and so in the bias forces p of
/// the bodies; the accelerations a are those beyond them. Equation numbers are those of kernel/README.md.
/// Source: R. Featherstone, Rigid Body Dynamics Algorithms (2008), section 7.3.
/// @tparam Topology  DynamicTopology or a StaticTopology
template <typename Topology>
class ArticulatedBodies {
  template <typename T>
  using PerJoint = typename Topology::template PerJoint<T>;

 public:
  explicit ArticulatedBodies(const TreeModel& model)
      : model_(model), inertias_(model.joints.size()), factors_(model.joints.size()) {}

  /// Computes the articulated inertias, and eliminates all free joints. False if a D is not positive
  /// definite.
  [[nodiscard]] RPSUP_INLINE bool factor(const Frame<double, double>* frames, const JointAxes* axes) {
    bool definite = true;
    Topology::tip_to_base(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.moves) return;
      ArticulatedInertia& inertia = inertias_[i];
      add_body_inertia(joint, frames[i].R, inertia);
      if (!joint.driven) {
        with_kind(joint, factors_[i], [&](auto& factor) RPSUP_INLINE_LAMBDA {
          definite = factor.eliminate(joint, frames[i].R, axes[i], inertia) && definite;
        });
      }
      if (joint.parent_moves)
        add_to_parent(joint, inertia, axes[i].r, inertias_[joint.parent]);
    });
    return definite;
  }

  /// Workspace of solve(), one entry a joint.
  template <typename T>
  struct Workspace {
    explicit Workspace(const TreeModel& model)
        : bias_forces(model.joints.size()),
          first_moments(model.joints.size()),
          local(model.joints.size()),
          accelerations(model.joints.size()) {}
    /// in: p of each body (loads already subtracted); out: p^a, or p^A of driven joints
    PerJoint<SpatialForce<T>> bias_forces;
    PerJoint<Vec3<T>> first_moments;  ///< L of a slender body's child: its moment x x L is not in bias_forces
    PerJoint<Vec3<T>> local;          ///< D^-1 u: the joint's acceleration while the parent stands still
    PerJoint<SpatialAcceleration<T>> accelerations;  ///< a of each body
  };

  /// Solves for the accelerations of the free coordinates, after factor().
  /// @param tau      generalised force on each coordinate
  /// @param qdd      out: one a coordinate, driven ones are left as they are; or NoOutput
  /// @param slender  one a joint (of a pack of seeds, in the first lane): the angular acceleration of slender
  ///                 bodies is measured from zero, see SlenderBodyMotion. Null: from the bias, as of all
  ///                 others
  template <typename T, typename Tau, typename Qdd>
  RPSUP_INLINE void solve(const JointAxes* axes, const Tau& tau, Workspace<T>& work, const Qdd& qdd,
                          const SlenderBodyMotion* slender = nullptr) const {
    calc_forces(axes, tau, work, slender);
    calc_accelerations(axes, work, qdd, slender);
  }

  /// solve() of a pack of seeds. Much code with several callers: not inlined into each of them.
  [[gnu::noinline]] void solve_pack(const JointAxes* axes, const TangentPack* tau,
                                    Workspace<TangentPack>& work, TangentPack* qdd) const {
    solve(axes, tau, work, qdd);
  }
  /// The same for the accelerations of the bodies alone; in the first lane tau and slender bodies of a
  /// motion.
  [[gnu::noinline]] void solve_bodies_pack(const JointAxes* axes, const double* tau,
                                           Workspace<TangentPack>& work,
                                           const SlenderBodyMotion* slender) const {
    solve(axes, FirstSeedForces{tau}, work, NoOutput<TangentPack>(), slender);
  }

  /// H^T (I^A a + p^A) of a driven joint after solve(): the force or moment along its axis, of the drive and
  /// of tau.
  /// @param i  index of the joint
  template <typename Joint, typename T>
  [[nodiscard]] RPSUP_INLINE T calc_drive_force(const Joint& joint, std::size_t i, const JointAxes& axes,
                                                const Workspace<T>& work) const {
    SpatialForce<T> force = work.bias_forces[i];
    if (joint.parent_moves) {
      const SpatialAcceleration<T>& a = work.accelerations[i];
      force.force += inertias_[i].A * a.linear + inertias_[i].C * a.angular;
      force.moment += transpose_times(inertias_[i].C, a.linear) + inertias_[i].J * a.angular;
    }
    return joint.rotates() ? dot(axes.axis[0], force.moment) : dot(axes.axis[0], force.force);
  }

 private:
  /// One of them is in use: see with_kind().
  struct JointFactor {
    SphericalFactor spherical;
    SlenderBodyFactor slender;
    SingleAxisFactor single_axis;
  };

  /// The forces of solve(), tip to base.
  template <typename T, typename Tau>
  RPSUP_INLINE void calc_forces(const JointAxes* axes, const Tau& tau, Workspace<T>& work,
                                const SlenderBodyMotion* slender) const {
    Topology::tip_to_base(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      SpatialForce<T>& force = work.bias_forces[i];
      if (!joint.driven) {
        Vec3<T> first_moment;
        if (joint.is_slender && joint.has_moving_children) first_moment = work.first_moments[i];
        if (joint.is_slender && slender)
          first_moment = first_moment + in_first_lane<T>(slender[i].first_moment);
        with_kind(joint, factors_[i], [&](const auto& factor) RPSUP_INLINE_LAMBDA {
          factor.tip_to_base_force(joint, axes[i], tau + joint.first, first_moment, work.local[i], force);
        });
      }
      if (joint.parent < 0) return;
      const int p = joint.parent;
      SpatialForce<T>& parent = work.bias_forces[p];
      parent.force += force.force;
      if (joint.parent_is_slender) {
        work.first_moments[p] =
            joint.data().placement.p[0] * force.force;  // the only child: see complete_traits()
        parent.moment += force.moment;
      } else if (joint.parent_frame_rotates) {
        parent.moment += force.moment + cross(axes[i].r, force.force);
      }
    });
  }

  /// The accelerations of solve(), base to tip.
  template <typename T, typename Qdd>
  RPSUP_INLINE void calc_accelerations(const JointAxes* axes, Workspace<T>& work, const Qdd& qdd,
                                       const SlenderBodyMotion* slender) const {
    Topology::base_to_tip(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.moves) return;
      SpatialAcceleration<T> a;
      if (joint.parent_moves) {
        a = work.accelerations[joint.parent];
        if (joint.parent_moment_matters) a.linear += cross(a.angular, axes[i].r);
      }
      if (!joint.driven) {
        with_kind(joint, factors_[i], [&](const auto& factor) RPSUP_INLINE_LAMBDA {
          factor.base_to_tip_acceleration(joint, axes[i], work.local[i], slender ? &slender[i] : nullptr, a,
                                          qdd + joint.first);
        });
      }
      if (joint.has_moving_children || joint.driven || Topology::has_constraints) work.accelerations[i] = a;
    });
  }

  /// Calls f with the factor of the joint's kind.
  template <typename Joint, typename Factor, typename Function>
  RPSUP_INLINE static void with_kind(const Joint& joint, Factor& factor, const Function& f) {
    if (joint.is_slender)
      f(factor.slender);
    else if (joint.kind == JointTraits::Kind::kSpherical)
      f(factor.spherical);
    else
      f(factor.single_axis);
  }

  const TreeModel& model_;
  PerJoint<ArticulatedInertia> inertias_;
  PerJoint<JointFactor> factors_;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
