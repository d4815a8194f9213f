// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>
#include <vector>

#include "engine/clearance/joint_contact.h"
#include "engine/dynamics/cut_joint_motion.h"
#include "engine/dynamics/dynamics_kernel.h"
#include "engine/dynamics/kernel/forward/applied_loads.h"
#include "engine/dynamics/kernel/forward/articulated_bodies.h"
#include "engine/dynamics/kernel/forward/body_load.h"
#include "engine/dynamics/kernel/forward/constraint_solver.h"
#include "engine/dynamics/kernel/forward/loss_powers.h"
#include "engine/dynamics/kernel/forward/point_spring.h"
#include "engine/dynamics/kernel/forward/slender_body.h"
#include "engine/math/finite.h"
#include "engine/math/sine_cosine.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Forward dynamics of a mechanism at one instant, Eqs. (1)-(13) of the paper: frames, contacts, bias forces,
/// multipliers, accelerations, powers.
/// @tparam Topology  DynamicTopology or a StaticTopology
template <typename Topology>
class ForwardDynamics {
  template <typename T>
  using PerJoint = typename Topology::template PerJoint<T>;
  template <typename T>
  using PerCoordinate = typename Topology::template PerCoordinate<T>;
  template <typename T>
  using PerDrive = typename Topology::template PerDrive<T>;

 public:
  using Constraints =
      std::conditional_t<Topology::has_constraints, ConstraintSolver<Topology>, NoConstraints>;

  RPSUP_INLINE ForwardDynamics(const TreeModel& model, const std::vector<ClearanceJoint>& joints,
                               AppliedValues applied)
      : q(model.coordinates, in_sine_blocks(model.coordinates)),
        qd(q.size()), qdd(q.size()),
        drive_force(model.drives.size()),
        frames(model.joints.size()), axes(model.joints.size()),
        cuts(model.cut_joints.size()),
        spring_forces(model.springs.size()), body_loads(model.body_loads.size()),
        bodies(model),
        constraints(model),
        model_(model), joints_(joints), applied_(applied),
        ground_(make_ground(model)),
        work_(model), constraint_work_(model), tau_(q.size()),
        sines_(in_sine_blocks(q.size())), cosines_(in_sine_blocks(q.size())),
        body_bias_force_(model.joints.size()), bias_force_(model.joints.size()),
        slender_motion_(model.joints.size()) {}

  /// Computes all results from q, qd, the driven qdd (free ones: zero) and the bristles.
  [[nodiscard]] RPSUP_INLINE EvaluationStatus evaluate(const DrivenMotion* drives) {
    calc_frames();
    const bool definite = bodies.factor(frames.data(), axes.data());
    if (!calc_contacts()) return EvaluationStatus::kBristleMissing;
    if (is_out_of_range()) return EvaluationStatus::kOutOfRange;
    if (!definite) return EvaluationStatus::kNonFinite;
    calc_bias_forces();
    calc_joint_spring_forces<Topology>(model_, q, qd, tau_);
    if constexpr (Topology::has_applied_forces) add_applied_forces(model_, applied_.forces, tau_);
    if (!calc_accelerations(drives)) return EvaluationStatus::kLocked;
    calc_drive_forces();
    calc_losses();
    return is_finite() ? EvaluationStatus::kOk : EvaluationStatus::kNonFinite;
  }

  [[nodiscard]] const Frame<double, double>& ground() const { return ground_; }

  // In
  PerCoordinate<double> q, qd, qdd;  ///< qdd of free coordinates: out
  const double* bristles = nullptr;
  bool drives_moved = true;  ///< whether the driven coordinates have changed since the last evaluation
  // Out
  double* bristle_rates = nullptr;  ///< set by the caller
  PerDrive<double> drive_force;     ///< [N] or [N m]
  /// of each joint's body, with bias accelerations: those without the free coordinates' qdd
  PerJoint<Frame<double, double>> frames;
  PerJoint<JointAxes> axes;
  typename Topology::template PerCutJoint<CutJointMotion<double, double>> cuts;
  typename Topology::template PerPointSpring<PointSpringForce<double>> spring_forces;
  typename Topology::template PerBodyLoad<BodyLoadForce<double>> body_loads;
  LossPowers<double> losses;
  ArticulatedBodies<Topology> bodies;
  Constraints constraints;

 private:
  /// All frames, base to tip: Eq. (K1). Joints that do not move (see JointTraits) are computed again only
  /// when the drives have moved.
  RPSUP_INLINE void calc_frames() {
    if constexpr (Topology::is_static) {
      double sines[Topology::padded_sine_count],
          cosines[Topology::padded_sine_count];  // their addresses escape: all else may stay in registers
      calc_frames(sines, cosines);
    } else {
      calc_frames(sines_.data(), cosines_.data());
    }
  }

  /// @param sines, cosines  workspace
  RPSUP_INLINE void calc_frames(double* sines, double* cosines) {
    Topology::for_each_sine_block(q,
                                  [&](std::size_t first_sine, const SineBlock& angles) RPSUP_INLINE_LAMBDA {
                                    const SinesAndCosines of = calc_sines_and_cosines(angles);
                                    of.sine.store(sines + first_sine);
                                    of.cosine.store(cosines + first_sine);
                                  });
    Topology::base_to_tip(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.moves && !drives_moved) return;
      const int first = joint.first;
      const std::size_t first_sine = Topology::sine_index(joint);
      Frame<double, double> f = joint.parent < 0 ? ground_ : frames[joint.parent];
      if (Topology::is_static && joint.is_slender) {
        const SlenderBodyMotion* parent_motion =
            joint.parent_is_slender ? &slender_motion_[joint.parent] : nullptr;
        calc_slender_frame(joint, parent_motion, &sines[first_sine], &cosines[first_sine], &qd[first], f,
                           axes[i], slender_motion_[i]);
        body_bias_force_[i] = calc_slender_bias_force(joint, f, slender_motion_[i]);
      } else {
        calc_joint_frame(joint, &q[first], &sines[first_sine], &cosines[first_sine], &qd[first], &qdd[first],
                         f, axes[i]);
        body_bias_force_[i] = calc_newton_euler_force(joint, f);
      }
      frames[i] = f;
    });
  }

  RPSUP_INLINE bool calc_contacts() {
    bool complete = true;
    std::size_t bristle = 0;
    Topology::for_each_cut_joint(model_, [&](std::size_t k, const auto& joint) RPSUP_INLINE_LAMBDA {
      CutJointMotion<double, double>& cut = cuts[k];
      calc_cut_joint_motion(joint, frame_of(joint.bearing_joint), frame_of(joint.journal_joint), cut);
      cut.load = {};
      cut.reaction = cut.moment = {};
      if (!joint.has_clearance()) return;
      const ClearanceJoint& contact = joints_[joint.data().clearance];
      complete = add_contacts(contact, cut.journal, bristles + bristle, bristle_rates + bristle, cut.load) &&
                 complete;
      cut.reaction = cut.b.R * cut.load.force;
      cut.moment = cut.b.R * cut.load.moment;
      bristle += contact.bristle_count();
    });
    return complete;
  }

  [[nodiscard]] RPSUP_INLINE const Frame<double, double>& frame_of(int joint) const {
    return joint < 0 ? ground_ : frames[joint];
  }

  /// Bias force of each body: its Newton-Euler force less the loads of contacts, point springs
  /// and body loads.
  RPSUP_INLINE void calc_bias_forces() {
    Topology::base_to_tip(model_, [&](std::size_t i, const auto&) RPSUP_INLINE_LAMBDA {
      bias_force_[i] = body_bias_force_[i];
    });
    Topology::for_each_cut_joint(model_, [&](std::size_t k, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (joint.has_clearance()) subtract_contact_load(joint, cuts[k], frames, bias_force_);
    });
    if constexpr (Topology::has_point_springs) {
      subtract_point_springs(model_, ground_, frames, spring_forces, bias_force_);
      subtract_body_loads(model_, applied_.body_loads, ground_, frames, body_loads, bias_force_);
    }
  }

  /// False if the Delassus matrix is singular.
  RPSUP_INLINE bool calc_accelerations(const DrivenMotion* drives) {
    start_tip_to_base();
    if constexpr (Topology::has_constraints)
      if (model_.rows > 0 && !solve_multipliers(drives)) return false;
    bodies.solve(axes.data(), tau_.data(), work_, qdd.data(), slender());
    calc_auxiliary_accelerations<Topology>(model_, tau_, qdd);
    return true;
  }
  [[nodiscard]] RPSUP_INLINE const SlenderBodyMotion* slender() const {
    return Topology::is_static ? slender_motion_.data() : nullptr;
  }

  RPSUP_INLINE void start_tip_to_base() {
    Topology::base_to_tip(model_, [&](std::size_t i, const auto&) RPSUP_INLINE_LAMBDA {
      work_.bias_forces[i] = bias_force_[i];
    });
  }

  /// (Phi_q M^-1 Phi_q^T) lambda = -(Phi_q qdd_0 + bias) - 2 alpha Phi_d - beta^2 Phi, Eqs. (K11), (K12),
  /// with qdd_0 the unconstrained accelerations and Baumgarte's stabilisation. Adds the reactions to the bias
  /// forces and tau.
  RPSUP_INLINE bool solve_multipliers(const DrivenMotion* drives) {
    calc_constraint_rows(drives);
    if (model_.minimum_norm_multipliers && constraints.is_torn_apart()) return false;
    const auto& rows = constraints.rows;
    auto& lambda = constraints.lambda;
    for (std::size_t r = 0; r < lambda.size(); ++r)
      lambda[r] =
          -(rows.bias[r] + 2.0 * model_.alpha * rows.Phi_d[r] + model_.beta * model_.beta * rows.Phi[r]);
    if (!constraints.solve(bodies, axes.data(), {bias_force_.data(), tau_.data(), slender()}, lambda.data(),
                           constraint_work_))
      return false;
    constraints.add_reactions(lambda.data(), work_.bias_forces.data(), tau_.data());
    Topology::for_each_cut_joint(model_, [&](std::size_t k, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (joint.has_clearance()) return;
      const JointReaction<double> reaction = calc_joint_reaction(
          joint.rows, constraints.joints[k].residual, cuts[k].b.R, lambda.data() + joint.data().first_row);
      cuts[k].reaction = reaction.force;
      cuts[k].moment = reaction.moment;
    });
    return true;
  }

  RPSUP_INLINE void calc_constraint_rows(const DrivenMotion* drives) {
    Topology::for_each_cut_joint(model_, [&](std::size_t k, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (joint.has_clearance()) return;
      const Frame<double, double>&b = cuts[k].b, &j = cuts[k].j;
      IdealCutJoint& loop = constraints.joints[k];
      loop.residual = calc_joint_residual(joint.rows, b, j);
      loop.R_b = b.R;
      loop.bearing_offset = bearing_point(joint.rows, b, j) - frame_of(joint.bearing_joint).p;
      loop.journal_offset = j.p - frame_of(joint.journal_joint).p;
      set_joint_residual(joint.rows, joint.data().first_row, loop.residual, constraints.rows);
      if constexpr (!Topology::is_static)
        if (model_.minimum_norm_multipliers)
          calc_joint_jacobian(model_, joint, frames.data(), axes.data(), b, j, loop.residual,
                              constraints.dynamic_rows.jacobian);
    });
    if constexpr (!Topology::is_static) {
      calc_coupling_residuals(model_, q.data(), qd.data(), qdd.data(), constraints.rows);
      calc_drive_residuals(model_, q.data(), qd.data(), drives, constraints.rows);
    }
  }

  /// Force of each drive: its multiplier, or what its joint transmits less the springs and couplings that act
  /// on the coordinate.
  RPSUP_INLINE void calc_drive_forces() {
    if constexpr (Topology::has_constraints)
      if (model_.drive_rows) {
        for (std::size_t k = 0; k < drive_force.size(); ++k)
          drive_force[k] = constraints.lambda[model_.first_drive_row + k];
        return;
      }
    Topology::base_to_tip(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.driven) return;
      const int d = joint.first;
      const double force = bodies.calc_drive_force(joint, i, axes[i], work_);
      drive_force[joint.drive] = force - tau_[d];
    });
  }

  RPSUP_INLINE void calc_losses() {
    losses = {};
    Topology::for_each_cut_joint(model_, [&](std::size_t k, const auto&) RPSUP_INLINE_LAMBDA {
      losses.impact += cuts[k].load.impact_power;
      losses.friction += cuts[k].load.friction_power;
    });
    if constexpr (Topology::has_point_springs)
      for (const PointSpringForce<double>& spring : spring_forces) losses.structural += spring.loss;
    add_damper_power<Topology>(model_, qd, losses.structural);
  }

  [[nodiscard]] RPSUP_INLINE bool is_out_of_range() const {
    bool out = false;
    Topology::for_each_cut_joint(model_, [&](std::size_t k, const auto&) RPSUP_INLINE_LAMBDA {
      out = out || cuts[k].load.out_of_range;
    });
    return out;
  }

  [[nodiscard]] RPSUP_INLINE bool is_finite() const {
    double sums[3] = {losses.impact, losses.friction,
                      losses.structural};  // a sum with an infinity or a NaN is none or the other
    Topology::for_each_joint(model_, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (joint.driven) return;
      for_each_coordinate(joint, [&](int k) RPSUP_INLINE_LAMBDA { sums[k] += qdd[joint.first + k]; });
    });
    return is_number(sums[0] + sums[1] + sums[2]);
  }

  const TreeModel& model_;
  const std::vector<ClearanceJoint>& joints_;
  AppliedValues applied_;
  const Frame<double, double> ground_;
  typename ArticulatedBodies<Topology>::template Workspace<double> work_;
  typename Constraints::template Workspace<double> constraint_work_;
  PerCoordinate<double> tau_;  ///< springs, dampers, applied forces, couplings, enforced drives
  typename Topology::SineBuffer sines_, cosines_;
  PerJoint<SpatialForce<double>> body_bias_force_;  ///< Newton-Euler, kept for bodies that do not move
  PerJoint<SpatialForce<double>> bias_force_;       ///< less contacts and point springs
  typename Topology::template PerSlenderBody<SlenderBodyMotion> slender_motion_;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
