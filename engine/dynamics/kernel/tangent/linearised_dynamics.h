// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "engine/dynamics/kernel/forward/applied_loads.h"
#include "engine/dynamics/kernel/forward/forward_dynamics.h"
#include "engine/dynamics/kernel/tangent/contact_tangent.h"
#include "engine/dynamics/kernel/tangent/frame_tangent.h"
#include "engine/dynamics/kernel/tangent/load_tangents.h"
#include "engine/dynamics/kernel/tangent/operating_point.h"
#include "engine/math/dual_vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Linearised forward dynamics: the tangents of accelerations, drive forces, journal motions and dissipated
/// powers by a pack of seeds, exact to rounding (forward-mode differentiation).
///
/// The residual of inverse dynamics R(q, qd, qdd, lambda) = M qdd + h - tau - Phi_q^T lambda is
/// differentiated with qdd and lambda constant, and the accelerations make up for its tangent, Eq. (K15):
///
///     M dqdd = Phi_q^T dlambda - dR
///
/// so that M is not differentiated. The steps of calc_tangents(): frames (K17), Newton-Euler forces (K18),
/// loads (K19), (K20), joint forces (K21), joint springs, M^-1 by ArticulatedBodies, multipliers (K22). All
/// tangents are corotational, each seen in the frame of its own body, Eq. (K16): where a joint rotates a
/// subtree, no force in it changes. Sources: [JR] and [CM] of the kernel's README.
/// @tparam Topology  DynamicTopology or a StaticTopology
template <typename Topology>
class LinearisedDynamics {
 public:
  /// @param point  the operating point, of the same dynamics; must outlive this
  LinearisedDynamics(const TreeModel& model, const ForwardDynamics<Topology>& dynamics,
                     const OperatingPoint<Topology>& point, std::size_t joints_with_clearance,
                     AppliedValues applied)
      : qdd(model.coordinates), drive_force(model.drives.size()),
        applied_force(model.applied_forces.size()), body_load_power(model.body_loads.size()),
        journals(joints_with_clearance),
        model_(model), dynamics_(dynamics), point_(point), applied_(applied),
        frames_(model.joints.size()), joint_rotations_(model.joints.size()), inactive_(model.joints.size()),
        work_(model), unconstrained_forces_(Topology::has_constraints ? model.joints.size() : 0),
        tau_(qdd.size()), lambda_(model.rows), constraint_work_(model) {}

  /// Computes the tangents by a pack of seeds. Much code with two callers: not inlined into both.
  /// @param coordinates  seeds, one a coordinate; qdd of driven ones only
  /// @param time         one in the lane of time, in which the drives' coordinates have seeds, too
  [[gnu::noinline]] void calc_tangents(const CoordinateTangent<TangentPack>* coordinates,
                                       const ContactLoadSeed* loads, int load_count, const TangentPack& time,
                                       const DrivenMotion* drives) {
    seeds_ = coordinates;
    load_seeds_ = loads;
    load_count_ = load_count;
    calc_frame_tangents();
    calc_load_tangents(time);
    rotate_joint_forces();
    add_joint_spring_tangents<Topology>(model_, seeds_, tau_.data());
    if constexpr (Topology::has_applied_forces)
      add_applied_force_tangents(model_, applied_.forces, seeds_, time, applied_force.data(), tau_.data());
    if constexpr (Topology::has_constraints)
      for (std::size_t i = 0; i < unconstrained_forces_.size(); ++i)
        unconstrained_forces_[i] = work_.bias_forces[i];
    solve();
    if constexpr (Topology::has_constraints)
      if (model_.rows > 0) calc_multiplier_tangents(time, drives);
    calc_drive_force_tangents();
    calc_loss_tangents();
  }

  // Out
  Buffer<TangentPack> qdd;  ///< of free coordinates
  Buffer<TangentPack> drive_force;
  Buffer<TangentPack> applied_force, body_load_power;
  Buffer<JournalTangent_b<TangentPack>> journals;  ///< of each joint with clearance
  LossPowers<TangentPack> losses;

 private:
  RPSUP_INLINE void calc_frame_tangents() {
    Topology::base_to_tip(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      const int first = joint.first;
      const bool parent_inactive = joint.parent < 0 || inactive_[joint.parent];
      bool inactive = parent_inactive;
      for (int k = 0; k < joint.count(); ++k) inactive = inactive && !seeds_[joint.first + k].active;
      inactive_[i] = inactive;
      if (inactive) {
        work_.bias_forces[i] = {};
        return;
      }
      FrameTangent<TangentPack> f;
      if (!parent_inactive) f = frames_[joint.parent];
      calc_frame_tangent(joint, dynamics_.axes[i], point_.nominal[i], &point_.coordinates[first],
                         seeds_ + joint.first, f, joint_rotations_[i]);
      work_.bias_forces[i] = calc_newton_euler_tangent(joint, dynamics_.frames[i].R, point_.nominal[i], f);
      frames_[i] = f;
    });
  }

  [[nodiscard]] RPSUP_INLINE bool is_inactive(int joint) const { return joint < 0 || inactive_[joint]; }

  /// Tangent of the frame of a joint's body, with its origin at p.
  [[nodiscard]] RPSUP_INLINE FrameTangent<TangentPack> tangent_at_point(int joint,
                                                                        const Vec3<double>& p) const {
    if (is_inactive(joint)) return {};
    return shift_origin(frames_[joint], offset_from_origin(joint, p));
  }

  RPSUP_INLINE void calc_load_tangents(const TangentPack& time) {
    losses = {};
    for (std::size_t k = 0; k < model_.cut_joints.size(); ++k) {
      const TreeCutJoint& joint = model_.cut_joints[k];
      if (!joint.has_clearance()) {
        if constexpr (Topology::has_constraints) calc_reaction_tangent(joint);
        continue;
      }
      calc_contact_tangent(joint, dynamics_.cuts[k]);
    }
    if constexpr (Topology::has_point_springs) {
      for (const TreeSpring& spring : model_.springs) calc_point_spring_tangent(spring);
      for (std::size_t k = 0; k < model_.body_loads.size(); ++k) calc_body_load_tangent(k, time);
    }
  }

  RPSUP_INLINE void calc_body_load_tangent(std::size_t k, const TangentPack& time) {
    const TreeBodyLoad& load = model_.body_loads[k];
    const SignalPoint& law = applied_.body_loads[k];
    const BodyLoadForce<TangentDual> tangent =
        calc_body_load(load, inertial_frame(load.joint), TangentDual(law.value, law.slope * time));
    subtract_load_tangent(load.joint, tangent.p, tangent.force, tangent.moment);
    body_load_power[k] = tangent.power.d;
  }

  RPSUP_INLINE void calc_point_spring_tangent(const TreeSpring& spring) {
    if (is_inactive(spring.from_joint) && is_inactive(spring.to_joint)) return;
    const PointSpringForce<TangentDual> spring_force =
        calc_point_spring_force(spring, inertial_frame(spring.from_joint), inertial_frame(spring.to_joint));
    subtract_load_tangent(spring.to_joint, spring_force.to, spring_force.force, {});
    subtract_load_tangent(spring.from_joint, spring_force.from, -spring_force.force, {});
    losses.structural += spring_force.loss.d;
  }

  /// Corotational with the bearing, in W, up to the forces on the two bodies.
  RPSUP_INLINE void calc_contact_tangent(const TreeCutJoint& joint,
                                         const CutJointMotion<double, double>& cut) {
    const ContactDerivative& contact = *point_.contacts[joint.clearance];
    JournalTangent_b<TangentPack>& journal_b = journals[joint.clearance];
    LoadTangent<TangentPack> load;
    JournalTangent_W<TangentPack> journal;
    if (is_inactive(joint.bearing_joint) && is_inactive(joint.journal_joint)) {
      journal_b = {};
    } else {
      journal = calc_journal_tangent(cut, tangent_at_point(joint.bearing_joint, cut.b.p),
                                     tangent_at_point(joint.journal_joint, cut.j.p));
      journal_b = to_bearing_frame(cut.b.R, journal);
      load = contact.apply(journal_b);
    }
    for (int i = 0; i < load_count_; ++i)
      if (load_seeds_[i].joint == static_cast<std::size_t>(joint.clearance))
        add_load_seed(load_seeds_[i], load);
    losses.impact += load.impact_power;
    losses.friction += load.friction_power;
    const ContactForceTangent<TangentPack> forces = calc_contact_force_tangent(
        cut, journal.rotation, journal.offset, load, offset_from_origin(joint.bearing_joint, cut.j.p),
        offset_from_origin(joint.journal_joint, cut.j.p));
    if (joint.bearing_joint >= 0) work_.bias_forces[joint.bearing_joint] += forces.on_bearing;
    if (joint.journal_joint >= 0) work_.bias_forces[joint.journal_joint] += forces.on_journal;
  }

  /// From the origin of a joint's body to p.
  [[nodiscard]] RPSUP_INLINE Vec3<double> offset_from_origin(int joint, const Vec3<double>& p) const {
    return joint < 0 ? p : p - dynamics_.frames[joint].p;
  }

  /// Tangents of an ideal joint's reaction, with constant multipliers, and of the right-hand side of its
  /// rows.
  RPSUP_INLINE void calc_reaction_tangent(const TreeCutJoint& joint) {
    const Frame<TangentDual, TangentDual> b =
        placed_frame(joint.bearing, inertial_frame(joint.bearing_joint), true);
    const Frame<TangentDual, TangentDual> j =
        placed_frame(joint.journal, inertial_frame(joint.journal_joint), true);
    const JointResidual<TangentDual, TangentDual> residual = calc_joint_residual(joint.rows, b, j);
    const int first = joint.first_row;
    for (int r = 0; r < joint.rows.count(); ++r)
      lambda_[first + r] = -(residual.Phi_dd[r].d + 2.0 * model_.alpha * residual.Phi_d[r].d +
                             (model_.beta * model_.beta) * residual.Phi[r].d);
    const JointReaction<TangentDual> reaction =
        calc_joint_reaction(joint.rows, residual, b.R, dynamics_.constraints.lambda.data() + first);
    subtract_load_tangent(joint.journal_joint, j.p, reaction.force, reaction.moment);
    subtract_load_tangent(joint.bearing_joint, bearing_point(joint.rows, b, j), -reaction.force,
                          -reaction.moment);
  }

  [[nodiscard]] RPSUP_INLINE const FrameTangent<TangentPack>& tangent_of(int joint) const {
    return is_inactive(joint) ? zero_tangent_ : frames_[joint];
  }
  [[nodiscard]] RPSUP_INLINE Frame<TangentDual, TangentDual> inertial_frame(int joint) const {
    return add_inertial_tangent(joint < 0 ? dynamics_.ground() : dynamics_.frames[joint],
                                joint < 0 ? point_.ground : point_.nominal[joint], tangent_of(joint));
  }

  /// Subtracts from a body's bias force the load of a force at p and a moment about p, in inertial tangents.
  RPSUP_INLINE void subtract_load_tangent(int joint, const Vec3<TangentDual>& p,
                                          const Vec3<TangentDual>& force, const Vec3<TangentDual>& moment) {
    if (joint < 0) return;
    const FrameTangent<TangentPack>& f = tangent_of(joint);
    const Vec3<TangentDual> origin = join(dynamics_.frames[joint].p, f.translation);
    const Vec3<TangentDual> about_origin = moment + cross(p - origin, force);
    work_.bias_forces[joint].force -= derivatives_of(force) - cross(f.rotation, values_of(force));
    work_.bias_forces[joint].moment -=
        derivatives_of(about_origin) - cross(f.rotation, values_of(about_origin));
  }

  /// The force that a joint transmits rotates, or is shifted, with the joint: Eq. (K21).
  RPSUP_INLINE void rotate_joint_forces() {
    tau_.fill({});
    Topology::tip_to_base(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      const CoordinateTangent<TangentPack>* seed = seeds_ + joint.first;
      bool active = false;
      for (int k = 0; k < joint.count(); ++k) active = active || seed[k].active;
      if (!active) return;
      const SpatialForce<double>& nominal = point_.nominal[i].force;
      const JointAxes& axes = dynamics_.axes[i];
      if (joint.kind == JointTraits::Kind::kTranslation) {
        if (joint.parent >= 0)
          work_.bias_forces[joint.parent].moment += seed[0].q * cross(axes.axis[0], nominal.force);
        return;
      }
      work_.bias_forces[i].force += cross(joint_rotations_[i], nominal.force);
      work_.bias_forces[i].moment += cross(joint_rotations_[i], nominal.moment);
      TangentPack* tau = &tau_[joint.first];
      for (int k = 1; k < joint.count(); ++k)  // each axis rotates with those before it
        for (int m = 0; m < k; ++m)
          tau[k] += dot(axes.axis[k], cross(axes.axis[m], nominal.moment)) * seed[m].q;
    });
  }

  RPSUP_INLINE void solve() {
    dynamics_.bodies.solve_pack(dynamics_.axes.data(), tau_.data(), work_, qdd.data());
    calc_auxiliary_accelerations<Topology>(model_, tau_, qdd);
  }

  RPSUP_INLINE void calc_multiplier_tangents(const TangentPack& time, const DrivenMotion* drives) {
    if constexpr (!Topology::is_static) {
      calc_coupling_tangents(model_, seeds_, lambda_.data());
      calc_drive_row_tangents(model_, seeds_, time, drives, lambda_.data());
    }
    dynamics_.constraints.solve_for_multipliers(work_.accelerations.data(), qdd.data(), lambda_.data(),
                                                constraint_work_);
    for (std::size_t i = 0; i < unconstrained_forces_.size(); ++i)
      work_.bias_forces[i] = unconstrained_forces_[i];
    dynamics_.constraints.add_reactions(lambda_.data(), work_.bias_forces.data(), tau_.data());
    solve();
  }

  /// See ForwardDynamics::calc_drive_forces().
  RPSUP_INLINE void calc_drive_force_tangents() {
    if (model_.drive_rows) {
      for (std::size_t k = 0; k < drive_force.size(); ++k)
        drive_force[k] = lambda_[model_.first_drive_row + k];
      return;
    }
    Topology::base_to_tip(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.driven) return;
      const TangentPack force = dynamics_.bodies.calc_drive_force(joint, i, dynamics_.axes[i], work_);
      drive_force[joint.drive] = force - tau_[joint.first];
    });
  }

  RPSUP_INLINE void calc_loss_tangents() {
    Topology::for_each_joint(model_, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.sprung) return;
      const int first = joint.first;
      for (int k = 0; k < joint.count(); ++k)
        if (seeds_[first + k].active)
          losses.structural +=
              (2.0 * joint.data().damping[k] * dynamics_.qd[first + k]) * seeds_[first + k].qd;
    });
  }

  const TreeModel& model_;
  const ForwardDynamics<Topology>& dynamics_;
  const OperatingPoint<Topology>& point_;
  AppliedValues applied_;  ///< one for each of the model's applied forces
  // The seeds of calc_tangents()
  const CoordinateTangent<TangentPack>* seeds_ = nullptr;
  const ContactLoadSeed* load_seeds_ = nullptr;
  int load_count_ = 0;
  const FrameTangent<TangentPack> zero_tangent_{};
  Buffer<FrameTangent<TangentPack>> frames_;
  Buffer<Vec3<TangentPack>> joint_rotations_;  ///< of each joint's frame against the parent's
  Buffer<bool> inactive_;  ///< joints that no seed of the pack moves: their frames are not set
  /// its bias forces: tangents of R, body by body
  typename ArticulatedBodies<Topology>::template Workspace<TangentPack> work_;
  /// copy of those bias forces, for the second solution with multipliers
  Buffer<SpatialForce<TangentPack>> unconstrained_forces_;
  Buffer<TangentPack> tau_, lambda_;  ///< lambda_: in, of the rows' right-hand sides; out, of the multipliers
  typename ForwardDynamics<Topology>::Constraints::template Workspace<TangentPack> constraint_work_;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
