// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>
#include <vector>

#include "engine/clearance/joint_contact.h"
#include "engine/dynamics/cut_joint_motion.h"
#include "engine/dynamics/dynamics_kernel.h"
#include "engine/dynamics/kernel/forward/articulated_bodies.h"
#include "engine/dynamics/kernel/forward/constraint_solver.h"
#include "engine/dynamics/kernel/forward/loss_powers.h"
#include "engine/dynamics/kernel/forward/point_spring.h"
#include "engine/dynamics/kernel/forward/slender_body.h"
#include "engine/math/finite.h"
#include "engine/math/sine_cosine.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The equations of motion of a mechanism at one instant, Eqs. (1)-(13), with room for all that they need.
/// Shapes: the tree's joints, AnyShapes or known ones.
template <typename Shapes>
class EquationsOfMotion {
  template <typename T>
  using JointRoom = typename Shapes::template JointRoom<T>;
  template <typename T>
  using CoordinateRoom = typename Shapes::template CoordinateRoom<T>;
  template <typename T>
  using DriveRoom = typename Shapes::template DriveRoom<T>;

 public:
  using Loops = std::conditional_t<Shapes::have_rows, LoopEquations<Shapes>, NoLoops>;

  RPSUP_INLINE EquationsOfMotion(const TreeModel& model, const std::vector<ClearanceJoint>& joints)
      : q(static_cast<std::size_t>(model.coordinates), in_sine_blocks(static_cast<std::size_t>(model.coordinates))),
        qd(q.size()),
        qdd(q.size()),
        drive_force(model.drives.size()),
        frames(model.joints.size()),
        axes(model.joints.size()),
        cuts(model.cut_joints.size()),
        pulls(model.springs.size()),
        bodies(model),
        loops(model),
        model_(model),
        joints_(joints),
        ground_(make_ground(model)),
        scratch_(model),
        multiplier_scratch_(model),
        tau_(q.size()),
        sines_(in_sine_blocks(q.size())),
        cosines_(in_sine_blocks(q.size())),
        given_(model.joints.size()),
        needed_(model.joints.size()),
        rods_(model.joints.size()) {}

  /// Computes everything below from q, qd, the driven qdd (free ones: zero) and the bristles.
  [[nodiscard]] RPSUP_INLINE EvaluationStatus evaluate(const DrivenMotion* drives) {
    calc_frames();
    const bool definite = bodies.factor(frames.data(), axes.data());
    if (!calc_contacts()) return EvaluationStatus::kBristleMissing;
    if (is_out_of_range()) return EvaluationStatus::kOutOfRange;
    if (!definite) return EvaluationStatus::kNonFinite;
    calc_needed_forces();
    calc_spring_forces();
    if (!calc_accelerations(drives)) return EvaluationStatus::kLocked;
    calc_drive_forces();
    calc_losses();
    return is_finite() ? EvaluationStatus::kOk : EvaluationStatus::kNonFinite;
  }

  [[nodiscard]] const Frame<double, double>& ground() const { return ground_; }

  // In
  CoordinateRoom<double> q, qd, qdd;            ///< qdd of free coordinates: out
  const double* bristles = nullptr;
  bool drives_moved = true;                     ///< whether the driven coordinates are others than in the last evaluation
  // Out
  double* bristle_rates = nullptr;              ///< where they go
  DriveRoom<double> drive_force;                ///< [N] or [N m]
  JointRoom<Frame<double, double>> frames;      ///< of each joint's body, with the accelerations that free coordinates do not add to
  JointRoom<JointAxes> axes;
  typename Shapes::template CutRoom<CutJointMotion<double, double>> cuts;
  typename Shapes::template SpringRoom<SpringPull<double>> pulls;  ///< of each spring between two points
  LossPowers<double> losses;
  ArticulatedBodies<Shapes> bodies;
  Loops loops;

 private:
  /// All frames, root to tip. The joints that stand on driven ones alone move with time only.
  RPSUP_INLINE void calc_frames() {
    if constexpr (Shapes::known) {
      double sines[Shapes::sine_room], cosines[Shapes::sine_room];  // of which addresses are known: the others may stay in registers
      calc_frames(sines, cosines);
    } else {
      calc_frames(sines_.data(), cosines_.data());
    }
  }

  /// @param sines, cosines  room for them
  RPSUP_INLINE void calc_frames(double* sines, double* cosines) {
    Shapes::each_sine_block(q, [&](std::size_t place, const SineBlock& angles) RPSUP_INLINE_LAMBDA {
      const SinesAndCosines of = calc_sines_and_cosines(angles);
      of.sine.store(sines + place);
      of.cosine.store(cosines + place);
    });
    Shapes::outwards(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.moves && !drives_moved) return;
      const auto first = static_cast<std::size_t>(joint.first);
      const std::size_t place = Shapes::sine_place(joint);
      Frame<double, double> f = joint.parent < 0 ? ground_ : frames[static_cast<std::size_t>(joint.parent)];
      if (Shapes::known && joint.is_rod) {
        const RodMotion* parent = joint.parent_is_rod ? &rods_[static_cast<std::size_t>(joint.parent)] : nullptr;
        calc_rod_frame(joint, parent, &sines[place], &cosines[place], &qd[first], f, axes[i], rods_[i]);
        given_[i] = calc_rod_force(joint, f, rods_[i]);
      } else {
        calc_joint_frame(joint, &q[first], &sines[place], &cosines[place], &qd[first], &qdd[first], f, axes[i]);
        given_[i] = calc_body_force(joint, f);
      }
      frames[i] = f;
    });
  }

  RPSUP_INLINE bool calc_contacts() {
    bool complete = true;
    std::size_t bristle = 0;
    Shapes::cut_joints(model_, [&](std::size_t k, const auto& joint) RPSUP_INLINE_LAMBDA {
      CutJointMotion<double, double>& cut = cuts[k];
      place_parts(joint, frame_of(joint.bearing_joint), frame_of(joint.journal_joint), cut);
      cut.load = {};
      cut.reaction = cut.moment = {};
      if (!joint.has_clearance()) return;
      const ClearanceJoint& contact = joints_[static_cast<std::size_t>(joint.numbers().clearance)];
      complete = add_contacts(contact, cut.journal, bristles + bristle, bristle_rates + bristle, cut.load) && complete;
      cut.reaction = cut.b.R * cut.load.force;
      cut.moment = cut.b.R * cut.load.moment;
      bristle += static_cast<std::size_t>(contact.bristle_count());
    });
    return complete;
  }

  [[nodiscard]] RPSUP_INLINE const Frame<double, double>& frame_of(int joint) const {
    return joint < 0 ? ground_ : frames[static_cast<std::size_t>(joint)];
  }

  /// What moves each joint's body as its frame moves, less the contacts' and springs' loads on it.
  RPSUP_INLINE void calc_needed_forces() {
    Shapes::outwards(model_, [&](std::size_t i, const auto&) RPSUP_INLINE_LAMBDA { needed_[i] = given_[i]; });
    Shapes::cut_joints(model_, [&](std::size_t k, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.has_clearance()) return;
      const CutJointMotion<double, double>& cut = cuts[k];
      // Both act at the journal's centre: on the journal, and the opposite on the bearing.
      if (joint.journal_joint >= 0) {
        SpatialForce<double>& needed = needed_[static_cast<std::size_t>(joint.journal_joint)];
        needed.force -= cut.reaction;
        needed.moment -= cut.moment;
        if (joint.journal.shifted) needed.moment -= cross(cut.j.p - frames[static_cast<std::size_t>(joint.journal_joint)].p, cut.reaction);
      }
      if (joint.bearing_joint >= 0) {
        SpatialForce<double>& needed = needed_[static_cast<std::size_t>(joint.bearing_joint)];
        needed.force += cut.reaction;
        needed.moment += cut.moment + cross(cut.j.p - frames[static_cast<std::size_t>(joint.bearing_joint)].p, cut.reaction);
      }
    });
    if constexpr (Shapes::have_springs) apply_springs();
  }

  RPSUP_INLINE void apply_springs() {
    for (std::size_t k = 0; k < pulls.size(); ++k) {
      const TreeSpring& spring = model_.springs[k];
      pulls[k] = calc_spring_pull(spring, frame_of(spring.from_joint), frame_of(spring.to_joint));
      apply(spring.to_joint, pulls[k].to, pulls[k].force);
      apply(spring.from_joint, pulls[k].from, -pulls[k].force);
    }
  }

  /// A force at p on a joint's body.
  RPSUP_INLINE void apply(int joint, const Vec3<double>& p, const Vec3<double>& force) {
    if (joint < 0) return;
    SpatialForce<double>& needed = needed_[static_cast<std::size_t>(joint)];
    needed.force -= force;
    needed.moment -= cross(p - frames[static_cast<std::size_t>(joint)].p, force);
  }

  RPSUP_INLINE void calc_spring_forces() {
    Shapes::outwards(model_, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
      const auto first = static_cast<std::size_t>(joint.first);
      each_coordinate(joint, [&](int index) RPSUP_INLINE_LAMBDA {
        const auto k = static_cast<std::size_t>(index);
        tau_[first + k] =
            joint.sprung ? -(joint.numbers().stiffness[k] * q[first + k] + joint.numbers().damping[k] * qd[first + k]) : 0.0;
      });
    });
  }

  /// False if the loops cannot follow.
  RPSUP_INLINE bool calc_accelerations(const DrivenMotion* drives) {
    take_needed_forces();
    if constexpr (Shapes::have_rows)
      if (model_.rows > 0 && !solve_multipliers(drives)) return false;
    bodies.solve(axes.data(), tau_.data(), scratch_, qdd.data(), rods());
    return true;
  }
  [[nodiscard]] RPSUP_INLINE const RodMotion* rods() const { return Shapes::known ? rods_.data() : nullptr; }

  RPSUP_INLINE void take_needed_forces() {
    Shapes::outwards(model_, [&](std::size_t i, const auto&) RPSUP_INLINE_LAMBDA { scratch_.forces[i] = needed_[i]; });
  }

  /// (Phi_q M^-1 Phi_q^T) lambda = -(Phi_q qdd_0 + bias) - 2 alpha Phi_d - beta^2 Phi, with qdd_0 the accelerations without constraints.
  /// Adds what lambda exerts to the forces and tau.
  RPSUP_INLINE bool solve_multipliers(const DrivenMotion* drives) {
    calc_rows(drives);
    if (model_.least_multipliers && is_apart()) return false;
    const auto& rows = loops.rows;
    auto& lambda = loops.lambda;
    for (std::size_t r = 0; r < lambda.size(); ++r)
      lambda[r] = -(rows.bias[r] + 2.0 * model_.alpha * rows.Phi_d[r] + model_.beta * model_.beta * rows.Phi[r]);
    if (!loops.solve(bodies, axes.data(), {needed_.data(), tau_.data(), rods()}, lambda.data(), multiplier_scratch_)) return false;
    loops.add_reactions(lambda.data(), scratch_.forces.data(), tau_.data());
    Shapes::cut_joints(model_, [&](std::size_t k, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (joint.has_clearance()) return;
      const JointReaction<double> reaction =
          calc_joint_reaction(joint.rows, loops.joints[k].violation, cuts[k].b.R, lambda.data() + joint.numbers().first_row);
      cuts[k].reaction = reaction.force;
      cuts[k].moment = reaction.moment;
    });
    return true;
  }

  /// Where rows depend on each other no singular matrix tells that the loops cannot follow: they come apart.
  [[nodiscard]] RPSUP_INLINE bool is_apart() const {
    constexpr double kApart = 1e-2;  // [m] or [1]
    double largest = 0.0;
    for (int r = 0; r < model_.first_drive_row; ++r) largest = std::max(largest, std::abs(loops.rows.Phi[static_cast<std::size_t>(r)]));
    return !(largest < kApart);
  }

  RPSUP_INLINE void calc_rows(const DrivenMotion* drives) {
    Shapes::cut_joints(model_, [&](std::size_t k, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (joint.has_clearance()) return;
      const Frame<double, double>&b = cuts[k].b, &j = cuts[k].j;
      ClosedJoint& closed = loops.joints[k];
      closed.violation = calc_joint_violation(joint.rows, b, j);
      closed.R_b = b.R;
      closed.bearing_arm = bearing_point(joint.rows, b, j) - frame_of(joint.bearing_joint).p;
      closed.journal_arm = j.p - frame_of(joint.journal_joint).p;
      set_joint_rows(joint.rows, joint.numbers().first_row, closed.violation, loops.rows);
      if constexpr (!Shapes::known)
        if (model_.least_multipliers) calc_joint_entries(model_, joint, frames.data(), axes.data(), b, j, closed.violation, loops.general.entries);
    });
    if constexpr (!Shapes::known) calc_coordinate_rows(drives);
  }

  RPSUP_INLINE void calc_coordinate_rows(const DrivenMotion* drives) {
    auto& rows = loops.rows;
    calc_coupling_rows(model_, q.data(), qd.data(), qdd.data(), rows);
    if (!model_.drive_rows) return;
    for (std::size_t k = 0; k < model_.drives.size(); ++k) {
      const auto d = static_cast<std::size_t>(model_.drives[k]);
      const std::size_t row = static_cast<std::size_t>(model_.first_drive_row) + k;
      rows.Phi[row] = q[d] - drives[k].q;
      rows.Phi_d[row] = qd[d] - drives[k].qd;
      rows.bias[row] = -drives[k].qdd;
    }
  }

  /// What springs and couplings exert on a driven coordinate its drive need not.
  RPSUP_INLINE void calc_drive_forces() {
    if constexpr (Shapes::have_rows)
      if (model_.drive_rows) {
        for (std::size_t k = 0; k < drive_force.size(); ++k) drive_force[k] = loops.lambda[static_cast<std::size_t>(model_.first_drive_row) + k];
        return;
      }
    Shapes::outwards(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.driven) return;
      const auto d = static_cast<std::size_t>(joint.first);
      const double force = bodies.calc_drive_force(joint, i, axes[i], scratch_);
      drive_force[static_cast<std::size_t>(joint.drive)] = force - tau_[d];
    });
  }

  RPSUP_INLINE void calc_losses() {
    losses = {};
    Shapes::cut_joints(model_, [&](std::size_t k, const auto&) RPSUP_INLINE_LAMBDA {
      losses.impact += cuts[k].load.impact_power;
      losses.friction += cuts[k].load.friction_power;
    });
    if constexpr (Shapes::have_springs)
      for (const SpringPull<double>& pull : pulls) losses.structural += pull.loss;
    Shapes::outwards(model_, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.sprung) return;
      each_coordinate(joint, [&](int k) RPSUP_INLINE_LAMBDA {
        const double rate = qd[static_cast<std::size_t>(joint.first + k)];
        losses.structural += joint.numbers().damping[static_cast<std::size_t>(k)] * (rate * rate);
      });
    });
  }

  [[nodiscard]] RPSUP_INLINE bool is_out_of_range() const {
    bool out = false;
    Shapes::cut_joints(model_, [&](std::size_t k, const auto&) RPSUP_INLINE_LAMBDA { out = out || cuts[k].load.out_of_range; });
    return out;
  }

  [[nodiscard]] RPSUP_INLINE bool is_finite() const {
    double sums[3] = {losses.impact, losses.friction, losses.structural};  // what is not finite stays in a sum
    Shapes::outwards(model_, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (joint.driven) return;
      each_coordinate(joint, [&](int k) RPSUP_INLINE_LAMBDA { sums[k] += qdd[static_cast<std::size_t>(joint.first + k)]; });
    });
    return is_number(sums[0] + sums[1] + sums[2]);
  }

 private:
  const TreeModel& model_;
  const std::vector<ClearanceJoint>& joints_;
  const Frame<double, double> ground_;
  typename ArticulatedBodies<Shapes>::template Scratch<double> scratch_;
  typename Loops::template Scratch<double> multiplier_scratch_;
  CoordinateRoom<double> tau_;                  ///< what springs, dampers, couplings and enforced drives exert on each coordinate
  typename Shapes::SineRoom sines_, cosines_;
  JointRoom<SpatialForce<double>> given_;       ///< needed by the bodies that move with time only
  JointRoom<SpatialForce<double>> needed_;
  typename Shapes::template RodRoom<RodMotion> rods_;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
