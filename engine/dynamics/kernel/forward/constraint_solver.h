// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "engine/dynamics/constraint_rows.h"
#include "engine/dynamics/kernel/forward/articulated_bodies.h"
#include "engine/dynamics/kernel/forward/delassus_matrix.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/buffer.h"
#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// An ideal cut joint: its rows' residuals, and where its reaction acts.
struct IdealCutJoint {
  JointResidual<double, double> residual;
  Mat3<double> R_b;                       ///< of the bearing
  Vec3<double> bearing_offset,
      journal_offset;  ///< from the bodies' origins to the points where the reaction acts
};

/// Rows of a dynamic topology, which may be of coordinates, and may be redundant.
struct DynamicRows {
  explicit DynamicRows(const TreeModel& model)
      : jacobian(model), tau(model.coordinates), qdd(tau.size()) {}

  ConstraintJacobian jacobian;           ///< computed only where rows may be redundant
  Buffer<TangentPack> tau, qdd;   ///< one a coordinate
};
/// Rows of a static topology: of one joint, and independent.
struct StaticRows {
  RPSUP_INLINE explicit StaticRows(const TreeModel&) {}
};

/// Input of ArticulatedBodies::solve() without multipliers.
struct UnconstrainedMotion {
  const SpatialForce<double>* bias_force;  ///< one a joint
  const double* tau;                   ///< one a coordinate
  const SlenderBodyMotion* slender;        ///< one a joint, of a static topology
};

/// The multipliers lambda of closed loops and enforced drives, Eq. (K12):
///
///     (Phi_q M^-1 Phi_q^T) lambda = rhs - Phi_q qdd_0
///
/// Column r of the Delassus matrix Phi_q M^-1 Phi_q^T is Phi_q times the accelerations that a unit multiplier
/// of row r causes: the articulated-body algorithm computes as many columns at once as a pack has lanes.
/// Phi_q itself is not needed: a joint's rows map multipliers to forces on two bodies,
/// calc_joint_reaction(), and accelerations of two bodies into Phi_q qdd, subtract_joint_acceleration(). (It
/// is computed only where rows may be redundant, to find active rows and change points: see DelassusMatrix.)
/// Source of the name: J. Carpentier, R. Budhiraja, N. Mansard, Proximal and sparse resolution of constrained
/// dynamic equations (2021).
/// @tparam Topology  DynamicTopology or a StaticTopology
template <typename Topology>
class ConstraintSolver {
  using Bodies = ArticulatedBodies<Topology>;
  using Delassus = typename DelassusOf<Topology>::Type;
  template <typename T>
  using PerRow = typename Topology::template PerRow<T>;

 public:
  /// Workspace of solve() and solve_for_multipliers().
  template <typename T>
  using Workspace = typename Delassus::template Workspace<T>;

  RPSUP_INLINE explicit ConstraintSolver(const TreeModel& model)
      : rows(model),
        dynamic_rows(model),
        lambda(model.rows),
        joints(model.cut_joints.size()),
        model_(model),
        delassus_(model),
        work_(model),
        unconstrained_residual_(lambda.size()),
        unit_multipliers_(lambda.size()),
        residual_(lambda.size()) {}

  ConstraintResiduals<PerRow<double>> rows;
  std::conditional_t<Topology::is_static, StaticRows, DynamicRows> dynamic_rows;
  PerRow<double> lambda;                                 ///< multipliers of the last solve() of the caller
  typename Topology::template PerCutJoint<IdealCutJoint> joints;  ///< ideal cut joints

  /// Assembles and factors the Delassus matrix, and solves for the multipliers of a motion. False if the
  /// matrix is singular.
  /// @param multipliers  in: rhs
  [[nodiscard]] RPSUP_INLINE bool solve(const Bodies& bodies, const JointAxes* axes,
                                        const UnconstrainedMotion& motion, double* multipliers,
                                        Workspace<double>& work) {
    if (!factor(bodies, axes, motion)) return false;
    for (std::size_t r = 0; r < unconstrained_residual_.size(); ++r)
      multipliers[r] += unconstrained_residual_[r];
    delassus_.solve(multipliers, work);
    return true;
  }

  /// @returns whether a loop has opened. Redundant rows give no singular matrix that would tell.
  [[nodiscard]] RPSUP_INLINE bool is_torn_apart() const {
    constexpr double kTorn = 1e-2;  // [m] or [1]
    double largest = 0.0;
    for (int r = 0; r < model_.first_drive_row; ++r) largest = std::max(largest, std::abs(rows.Phi[r]));
    return !(largest < kTorn);
  }

  /// Solves (Phi_q M^-1 Phi_q^T) lambda = rhs - Phi_q qdd, after solve().
  /// @param multipliers  in: rhs  @tparam T  a number, or a pack
  template <typename T>
  RPSUP_INLINE void solve_for_multipliers(const SpatialAcceleration<T>* accelerations, const T* qdd,
                                          T* multipliers, Workspace<T>& work) const {
    subtract_constraint_acceleration(accelerations, qdd, multipliers);
    delassus_.solve(multipliers, work);
  }

  /// Applies Phi_q^T lambda: subtracts the reactions of joints from the bias forces, adds those of couplings
  /// and drives to tau.
  template <typename T>
  RPSUP_INLINE void add_reactions(const T* multipliers, SpatialForce<T>* bias_force, T* tau) const {
    subtract_joint_reactions(multipliers, bias_force);
    if constexpr (!Topology::is_static) add_coordinate_reactions(multipliers, tau);
  }

 private:
  /// Assembles the columns of the active rows, and before the first of them, as column kUnconstrained, the
  /// unconstrained motion: it is one more solution of the same systems.
  [[nodiscard]] RPSUP_INLINE bool factor(const Bodies& bodies, const JointAxes* axes,
                                         const UnconstrainedMotion& motion) {
    if constexpr (!Topology::is_static)
      if (model_.minimum_norm_multipliers) delassus_.find_active_rows(dynamic_rows.jacobian, model_.free);
    const int count = delassus_.active_count();
    delassus_.template for_each_pack_of_columns<TangentPack::kCount>([&](auto column) RPSUP_INLINE_LAMBDA {
      calc_columns_from(bodies, axes, motion, column);
      for (int k = std::max<int>(column, 0); k < count; ++k)
        delassus_.set(k, column, residual_[delassus_.active_row(k)]);
    });
    if constexpr (Topology::is_static)
      return delassus_.factor();
    else
      return delassus_.factor(dynamic_rows.jacobian, model_.free);
  }

  /// residual_ <- Phi_q M^-1 Phi_q^T of a pack of columns. The pack that begins with kUnconstrained brings
  /// unconstrained_residual_, too.
  RPSUP_INLINE void calc_columns_from(const Bodies& bodies, const JointAxes* axes,
                                      const UnconstrainedMotion& motion, int column) {
    auto& bias_forces = work_.bias_forces;
    bias_forces.fill({});
    if (column == kUnconstrained)
      for (std::size_t i = 0; i < bias_forces.size(); ++i)
        bias_forces[i] = {in_first_lane<TangentPack>(motion.bias_force[i].force),
                          in_first_lane<TangentPack>(motion.bias_force[i].moment)};
    unit_multipliers_.fill({});
    // The units are negative, as residual_ is -Phi_q qdd.
    for (int k = std::max(column, 0); k < std::min(column + TangentPack::kCount, delassus_.active_count());
         ++k)
      unit_multipliers_[delassus_.active_row(k)] = -TangentPack::unit(k - column);
    subtract_joint_reactions(unit_multipliers_.data(), bias_forces.data());
    residual_.fill({});
    if constexpr (Topology::is_static) {
      static constexpr double kNoTau[Topology::n_q]{};
      bodies.solve_bodies_pack(axes, column == kUnconstrained ? motion.tau : kNoTau, work_,
                               column == kUnconstrained ? motion.slender : nullptr);
      subtract_joint_accelerations(work_.accelerations.data(), residual_.data());
    } else {
      dynamic_rows.tau.fill({});
      if (column == kUnconstrained)
        for (std::size_t i = 0; i < dynamic_rows.tau.size(); ++i)
          dynamic_rows.tau[i] = TangentPack::first(motion.tau[i]);
      add_coordinate_reactions(unit_multipliers_.data(), dynamic_rows.tau.data());
      bodies.solve_pack(axes, dynamic_rows.tau.data(), work_, dynamic_rows.qdd.data());
      subtract_constraint_acceleration(work_.accelerations.data(), dynamic_rows.qdd.data(), residual_.data());
    }
    if (column == kUnconstrained)
      for (std::size_t r = 0; r < unconstrained_residual_.size(); ++r)
        unconstrained_residual_[r] = residual_[r][0];
  }

  /// Subtracts the reactions of the joints from the bias forces.
  template <typename T>
  RPSUP_INLINE void subtract_joint_reactions(const T* multipliers, SpatialForce<T>* bias_force) const {
    Topology::for_each_cut_joint(model_, [&](std::size_t k, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (joint.has_clearance()) return;
      const IdealCutJoint& loop = joints[k];
      const JointReaction<T> reaction =
          calc_joint_reaction(joint.rows, loop.residual, loop.R_b, multipliers + joint.data().first_row);
      if (joint.journal_joint >= 0) {
        SpatialForce<T>& on_journal = bias_force[joint.journal_joint];
        on_journal.force -= reaction.force;
        on_journal.moment -= reaction.moment;
        if (joint.journal.shifted) on_journal.moment -= cross(loop.journal_offset, reaction.force);
      }
      if (joint.bearing_joint >= 0) {
        SpatialForce<T>& on_bearing = bias_force[joint.bearing_joint];
        on_bearing.force += reaction.force;
        on_bearing.moment += reaction.moment + cross(loop.bearing_offset, reaction.force);
      }
    });
  }

  /// Adds the reactions of couplings and drives to tau. A driven coordinate has its share, too: the drive
  /// bears it.
  template <typename T>
  RPSUP_INLINE void add_coordinate_reactions(const T* multipliers, T* tau) const {
    for (std::size_t k = 0; k < model_.couplings.size(); ++k) {
      const Coupling& coupling = model_.couplings[k];
      const T& multiplier = multipliers[model_.first_coupling_row + k];
      tau[coupling.coordinate] += multiplier;
      tau[coupling.follows] -= coupling.ratio * multiplier;
    }
    if (!model_.drive_rows) return;
    for (std::size_t k = 0; k < model_.drives.size(); ++k)
      tau[model_.drives[k]] += multipliers[model_.first_drive_row + k];
  }

  /// residual <- residual - Phi_q qdd. @param accelerations  of the bodies, by the free coordinates
  template <typename T>
  RPSUP_INLINE void subtract_constraint_acceleration(const SpatialAcceleration<T>* accelerations,
                                                     const T* qdd, T* residual) const {
    subtract_joint_accelerations(accelerations, residual);
    if constexpr (!Topology::is_static) subtract_coordinate_accelerations(qdd, residual);
  }

  template <typename T>
  RPSUP_INLINE void subtract_joint_accelerations(const SpatialAcceleration<T>* accelerations,
                                                 T* residual) const {
    Topology::for_each_cut_joint(model_, [&](std::size_t k, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (joint.has_clearance()) return;
      const IdealCutJoint& loop = joints[k];
      const SpatialAcceleration<T> b =
          acceleration_at(accelerations, joint.bearing_joint, loop.bearing_offset);
      const SpatialAcceleration<T> j =
          acceleration_at(accelerations, joint.journal_joint, loop.journal_offset);
      subtract_joint_acceleration(joint.rows, loop.residual, loop.R_b, j.angular - b.angular,
                                  j.linear - b.linear, residual + joint.data().first_row);
    });
  }

  template <typename T>
  RPSUP_INLINE void subtract_coordinate_accelerations(const T* qdd, T* residual) const {
    const auto free = [&](int coordinate) RPSUP_INLINE_LAMBDA {
      return model_.is_eliminated(coordinate) ? T{} : qdd[coordinate];
    };
    for (std::size_t k = 0; k < model_.couplings.size(); ++k) {
      const Coupling& coupling = model_.couplings[k];
      residual[model_.first_coupling_row + k] -=
          free(coupling.coordinate) - coupling.ratio * free(coupling.follows);
    }
    if (!model_.drive_rows) return;
    for (std::size_t k = 0; k < model_.drives.size(); ++k)
      residual[model_.first_drive_row + k] -= qdd[model_.drives[k]];
  }

  /// Acceleration of a joint's body at an offset from its origin.
  template <typename T>
  [[nodiscard]] RPSUP_INLINE SpatialAcceleration<T> acceleration_at(
      const SpatialAcceleration<T>* accelerations, int joint, const Vec3<double>& offset) const {
    if (joint < 0 || !model_.joints[joint].moves) return {};
    const SpatialAcceleration<T>& body = accelerations[joint];
    return {body.angular, body.linear + cross(body.angular, offset)};
  }

  const TreeModel& model_;
  Delassus delassus_;                  ///< factored by solve()
  typename Bodies::template Workspace<TangentPack> work_;
  PerRow<double> unconstrained_residual_;  ///< -Phi_q qdd_0
  PerRow<TangentPack> unit_multipliers_, residual_;
};
/// Stands for the solver where a topology has no constraints.
struct NoConstraints {
  RPSUP_INLINE explicit NoConstraints(const TreeModel&) {}

  template <typename T>
  using Workspace = NoConstraints;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
