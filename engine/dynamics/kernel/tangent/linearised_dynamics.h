// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "engine/dynamics/kernel/forward/forward_dynamics.h"
#include "engine/dynamics/kernel/tangent/contact_tangent.h"
#include "engine/dynamics/kernel/tangent/frame_tangent.h"
#include "engine/math/dual_vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// With how it varies in several directions.
using VariedNumber = DualOf<Directions::kCount>;

/// A load on a journal in one of the directions.
struct LoadDirection {
  std::size_t joint;   ///< of those with clearance
  const double* load;  ///< force, and moment about the journal's centre, in {b}
  double* effect;      ///< where the column of the outputs' derivatives by it goes
  Directions lanes;    ///< one where it acts
};

/// How the solution of the equations of motion varies with the state, in several directions at once, exact to rounding.
///
/// The forces that hold the motion, R(q, qd, qdd, lambda) = M qdd + bias - tau - Phi_q^T lambda, vary with qdd and lambda held where they are;
/// what then is missing is made up for by the accelerations: M dqdd = Phi_q^T dlambda - dR. So no matrix is ever differentiated. Where a joint
/// turns all that it carries, the forces there turn with it, and need not be found again: see VariedFrame.
/// Source: A. Jain, G. Rodriguez, Linearization of manipulator dynamics using spatial operators (1993).
template <typename Shapes>
class VariedEquations {
 public:
  /// @param solved  the equations; evaluated and kept before hold()
  VariedEquations(const TreeModel& model, const std::vector<ClearanceJoint>& joints, std::size_t bristles,
                  const EquationsOfMotion<Shapes>& solved)
      : qdd(static_cast<std::size_t>(model.coordinates)),
        drive_force(model.drives.size()),
        journals(joints.size()),
        model_(model),
        joints_(joints),
        solved_(solved),
        held_(model.joints.size()),
        held_coordinates_(qdd.size()),
        acting_(joints.size()),
        own_bristles_(bristles),
        frames_(model.joints.size()),
        own_turns_(model.joints.size()),
        still_(model.joints.size()),
        scratch_(model),
        needed_(Shapes::have_rows ? model.joints.size() : 0),
        tau_(qdd.size()),
        lambda_(static_cast<std::size_t>(model.rows)),
        multiplier_scratch_(model) {
    ground_.vd = {-model.gravity[0], -model.gravity[1], -model.gravity[2]};
    for (const ClearanceJoint& joint : joints)
      contacts_.push_back(std::make_unique<ContactDerivative>(static_cast<std::size_t>(joint.bristle_count())));
  }

  /// Takes up the solution: what all directions share. Like differentiate() much code, which two functions call: not inlined into both.
  /// @param acting  the bristles that touch or are bent, in pairs and in their order
  [[gnu::noinline]] void hold(const double* bristles, const int* acting, int acting_count) {
    find_acting(acting, acting_count);
    hold_motion();
    hold_loads(bristles);
    Shapes::inwards(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (joint.parent < 0) return;
      const SpatialForce<double>& force = held_[i].force;
      SpatialForce<double>& parent = held_[static_cast<std::size_t>(joint.parent)].force;
      parent.force += force.force;
      parent.moment += force.moment + cross(solved_.axes[i].r, force.force);
    });
  }

  /// @param coordinates  one a coordinate; qdd of driven ones only
  /// @param time         lane in which time varies, the drives' coordinates with it
  [[gnu::noinline]] void differentiate(const CoordinateVariation<Directions>* coordinates, const LoadDirection* loads, int load_count,
                                       const Directions& time, const DrivenMotion* drives) {
    coordinates_ = coordinates;
    loads_ = loads;
    load_count_ = load_count;
    vary_frames();
    vary_loads();
    carry_forces();
    vary_applied_forces();
    if constexpr (Shapes::have_rows)
      for (std::size_t i = 0; i < needed_.size(); ++i) needed_[i] = scratch_.forces[i];
    solve();
    if constexpr (Shapes::have_rows)
      if (model_.rows > 0) vary_multipliers(time, drives);
    vary_drive_forces();
    vary_losses();
  }

  // Of the solution taken up, for others
  [[nodiscard]] const HeldJoint* held() const { return held_.data(); }
  [[nodiscard]] const HeldCoordinate* held_coordinates() const { return held_coordinates_.data(); }
  [[nodiscard]] const std::unique_ptr<ContactDerivative>* contacts() const { return contacts_.data(); }
  [[nodiscard]] const ActingBristles* acting() const { return acting_.data(); }

  // Out
  Buffer<Directions> qdd;                         ///< of free coordinates
  Buffer<Directions> drive_force;
  Buffer<JournalVariation<Directions>> journals;  ///< of each joint with clearance
  LossPowers<Directions> losses;

 private:
  /// Sorts the acting bristles by joints.
  RPSUP_INLINE void find_acting(const int* acting, int count) {
    int first = 0, next = 0;
    for (std::size_t k = 0; k < joints_.size(); ++k) {
      const int end = first + joints_[k].bristle_count();
      ActingBristles& own = acting_[k];
      own = {first, own_bristles_.data() + next, 0};
      for (; next < count && acting[next] < end; ++next, ++own.count) own_bristles_[static_cast<std::size_t>(next)] = acting[next] - first;
      first = end;
    }
  }

  RPSUP_INLINE void hold_motion() {
    Shapes::outwards(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      const auto first = static_cast<std::size_t>(joint.first);
      const HeldJoint& parent = joint.parent < 0 ? ground_ : held_[static_cast<std::size_t>(joint.parent)];
      hold_joint(joint, parent, solved_.axes[i], &solved_.qd[first], &solved_.qdd[first], &held_coordinates_[first], held_[i]);
      hold_force(joint, solved_.frames[i].R, held_[i]);
    });
  }

  RPSUP_INLINE void hold_loads(const double* bristles) {
    for (std::size_t k = 0; k < model_.cut_joints.size(); ++k) {
      const TreeCutJoint& joint = model_.cut_joints[k];
      const CutJointMotion<double, double>& cut = solved_.cuts[k];
      if (!joint.has_clearance()) {
        hold_load(joint.journal_joint, cut.j.p, cut.reaction, cut.moment);
        hold_load(joint.bearing_joint, bearing_point(joint.rows, cut.b, cut.j), -cut.reaction, -cut.moment);
        continue;
      }
      const auto own = static_cast<std::size_t>(joint.clearance);
      contacts_[own]->calc(joints_[own], cut.journal, bristles, acting_[own]);
      hold_load(joint.journal_joint, cut.j.p, cut.reaction, cut.moment);
      hold_load(joint.bearing_joint, cut.j.p, -cut.reaction, -cut.moment);
    }
    if constexpr (Shapes::have_springs) hold_springs();
  }

  RPSUP_INLINE void hold_springs() {
    for (std::size_t k = 0; k < model_.springs.size(); ++k) {
      const SpringPull<double>& pull = solved_.pulls[k];
      hold_load(model_.springs[k].to_joint, pull.to, pull.force, {});
      hold_load(model_.springs[k].from_joint, pull.from, -pull.force, {});
    }
  }

  /// A force at p, with a moment about it, on a joint's body.
  RPSUP_INLINE void hold_load(int joint, const Vec3<double>& p, const Vec3<double>& force, const Vec3<double>& moment) {
    if (joint < 0) return;
    SpatialForce<double>& needed = held_[static_cast<std::size_t>(joint)].force;
    needed.force -= force;
    needed.moment -= moment + cross(p - solved_.frames[static_cast<std::size_t>(joint)].p, force);
  }

  RPSUP_INLINE void vary_frames() {
    Shapes::outwards(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      const auto first = static_cast<std::size_t>(joint.first);
      const bool parent_still = joint.parent < 0 || still_[static_cast<std::size_t>(joint.parent)];
      bool still = parent_still;
      for (int k = 0; k < joint.count(); ++k) still = still && !coordinates_[joint.first + k].varies;
      still_[i] = still;
      if (still) {
        scratch_.forces[i] = {};
        return;
      }
      VariedFrame<Directions> f;
      if (!parent_still) f = frames_[static_cast<std::size_t>(joint.parent)];
      vary_joint_frame(joint, solved_.axes[i], held_[i], &held_coordinates_[first], coordinates_ + joint.first, f, own_turns_[i]);
      scratch_.forces[i] = vary_body_force(joint, solved_.frames[i].R, held_[i], f);
      frames_[i] = f;
    });
  }

  [[nodiscard]] RPSUP_INLINE bool is_still(int joint) const { return joint < 0 || still_[static_cast<std::size_t>(joint)]; }

  /// How the frame of a joint's body varies, with the origin at p.
  [[nodiscard]] RPSUP_INLINE VariedFrame<Directions> see_at(int joint, const Vec3<double>& p) const {
    if (is_still(joint)) return {};
    return move_origin(frames_[static_cast<std::size_t>(joint)], arm_of(joint, p));
  }

  RPSUP_INLINE void vary_loads() {
    losses = {};
    for (std::size_t k = 0; k < model_.cut_joints.size(); ++k) {
      const TreeCutJoint& joint = model_.cut_joints[k];
      if (!joint.has_clearance()) {
        if constexpr (Shapes::have_rows) vary_reaction(joint);
        continue;
      }
      vary_contact(joint, solved_.cuts[k]);
    }
    if constexpr (Shapes::have_springs)
      for (const TreeSpring& spring : model_.springs) vary_spring(spring);
  }

  RPSUP_INLINE void vary_spring(const TreeSpring& spring) {
    if (is_still(spring.from_joint) && is_still(spring.to_joint)) return;
    const SpringPull<VariedNumber> pull = calc_spring_pull(spring, see_at_rest(spring.from_joint), see_at_rest(spring.to_joint));
    vary_load(spring.to_joint, pull.to, pull.force, {});
    vary_load(spring.from_joint, pull.from, -pull.force, {});
    losses.structural += pull.loss.d;
  }

  /// All in W as an observer sees it who turns with the bearing, until the journal's own is needed.
  RPSUP_INLINE void vary_contact(const TreeCutJoint& joint, const CutJointMotion<double, double>& cut) {
    const ContactDerivative& contact = *contacts_[static_cast<std::size_t>(joint.clearance)];
    JournalVariation<Directions>& varies = journals[static_cast<std::size_t>(joint.clearance)];
    LoadVariation<Directions> load;
    VariedJournal<Directions> journal;
    if (is_still(joint.bearing_joint) && is_still(joint.journal_joint)) {
      varies = {};
    } else {
      journal = vary_journal(cut, see_at(joint.bearing_joint, cut.b.p), see_at(joint.journal_joint, cut.j.p));
      varies = see_from_bearing(cut.b.R, journal);
      load = contact.apply(varies);
    }
    for (int i = 0; i < load_count_; ++i)
      if (loads_[i].joint == static_cast<std::size_t>(joint.clearance)) add_load(loads_[i], load);
    losses.impact += load.impact_power;
    losses.friction += load.friction_power;
    const VariedNeed<Directions> need =
        vary_need(cut, journal.turn, journal.offset, load, arm_of(joint.bearing_joint, cut.j.p), arm_of(joint.journal_joint, cut.j.p));
    if (joint.bearing_joint >= 0) scratch_.forces[static_cast<std::size_t>(joint.bearing_joint)] += need.of_bearing;
    if (joint.journal_joint >= 0) scratch_.forces[static_cast<std::size_t>(joint.journal_joint)] += need.of_journal;
  }

  RPSUP_INLINE static void add_load(const LoadDirection& of, LoadVariation<Directions>& load) {
    load.force += Vec3<Directions>{of.load[0] * of.lanes, of.load[1] * of.lanes, of.load[2] * of.lanes};
    load.moment += Vec3<Directions>{of.load[3] * of.lanes, of.load[4] * of.lanes, of.load[5] * of.lanes};
  }

  /// From the origin of a joint's body to p.
  [[nodiscard]] RPSUP_INLINE Vec3<double> arm_of(int joint, const Vec3<double>& p) const {
    if (joint < 0) return p;
    return p - solved_.frames[static_cast<std::size_t>(joint)].p;
  }

  /// What an ideal joint exerts with its multipliers held, and what its rows lack then.
  RPSUP_INLINE void vary_reaction(const TreeCutJoint& joint) {
    const Frame<VariedNumber, VariedNumber> b = place(joint.bearing, see_at_rest(joint.bearing_joint), true);
    const Frame<VariedNumber, VariedNumber> j = place(joint.journal, see_at_rest(joint.journal_joint), true);
    const JointViolation<VariedNumber, VariedNumber> violation = calc_joint_violation(joint.rows, b, j);
    const auto first = static_cast<std::size_t>(joint.first_row);
    for (std::size_t r = 0; r < static_cast<std::size_t>(joint.rows.count()); ++r)
      lambda_[first + r] =
          -(violation.Phi_dd[r].d + 2.0 * model_.alpha * violation.Phi_d[r].d + (model_.beta * model_.beta) * violation.Phi[r].d);
    const JointReaction<VariedNumber> reaction = calc_joint_reaction(joint.rows, violation, b.R, solved_.loops.lambda.data() + first);
    vary_load(joint.journal_joint, j.p, reaction.force, reaction.moment);
    vary_load(joint.bearing_joint, bearing_point(joint.rows, b, j), -reaction.force, -reaction.moment);
  }

  /// The frame of a joint's body, with all accelerations, as an observer at rest sees it.
  [[nodiscard]] RPSUP_INLINE Frame<VariedNumber, VariedNumber> see_at_rest(int joint) const {
    const VariedFrame<Directions>& f = is_still(joint) ? at_rest_ : frames_[static_cast<std::size_t>(joint)];
    const HeldJoint& held = joint < 0 ? ground_ : held_[static_cast<std::size_t>(joint)];
    const Frame<double, double>& stands = joint < 0 ? solved_.ground() : solved_.frames[static_cast<std::size_t>(joint)];
    const auto turned = [&](const Vec3<double>& v) RPSUP_INLINE_LAMBDA { return join(v, cross(f.turn, v)); };
    const auto turned_too = [&](const Vec3<double>& v, const Vec3<Directions>& own) RPSUP_INLINE_LAMBDA { return join(v, own + cross(f.turn, v)); };
    return {{turned(stands.R.x), turned(stands.R.y), turned(stands.R.z)}, join(stands.p, f.shift), turned_too(held.w, f.w), turned_too(held.v, f.v),
            turned_too(held.wd, f.wd), turned_too(held.vd, f.vd)};
  }

  /// A force at p, with a moment about it, as an observer at rest sees them, on a joint's body.
  RPSUP_INLINE void vary_load(int joint, const Vec3<VariedNumber>& p, const Vec3<VariedNumber>& force, const Vec3<VariedNumber>& moment) {
    if (joint < 0) return;
    const VariedFrame<Directions>& f = is_still(joint) ? at_rest_ : frames_[static_cast<std::size_t>(joint)];
    const Vec3<VariedNumber> origin = join(solved_.frames[static_cast<std::size_t>(joint)].p, f.shift);
    const Vec3<VariedNumber> about_origin = moment + cross(p - origin, force);
    scratch_.forces[static_cast<std::size_t>(joint)].force -= derivatives_of(force) - cross(f.turn, values_of(force));
    scratch_.forces[static_cast<std::size_t>(joint)].moment -= derivatives_of(about_origin) - cross(f.turn, values_of(about_origin));
  }

  /// What the joints transmit turns with them.
  RPSUP_INLINE void carry_forces() {
    tau_.fill({});
    Shapes::inwards(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      const CoordinateVariation<Directions>* varies = coordinates_ + joint.first;
      bool own = false;
      for (int k = 0; k < joint.count(); ++k) own = own || varies[k].varies;
      if (!own) return;
      const SpatialForce<double>& held = held_[i].force;
      const JointAxes& axes = solved_.axes[i];
      if (joint.kind == JointShape::Kind::kTranslation) {
        if (joint.parent >= 0) scratch_.forces[static_cast<std::size_t>(joint.parent)].moment += varies[0].q * cross(axes.axis[0], held.force);
        return;
      }
      scratch_.forces[i].force += cross(own_turns_[i], held.force);
      scratch_.forces[i].moment += cross(own_turns_[i], held.moment);
      Directions* tau = &tau_[static_cast<std::size_t>(joint.first)];
      for (int k = 1; k < joint.count(); ++k)  // but an axis turns with those before it
        for (int m = 0; m < k; ++m) tau[k] += dot(axes.axis[k], cross(axes.axis[m], held.moment)) * varies[m].q;
    });
  }

  RPSUP_INLINE void vary_applied_forces() {
    Shapes::outwards(model_, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.sprung) return;
      const auto first = static_cast<std::size_t>(joint.first);
      for (std::size_t k = 0; k < static_cast<std::size_t>(joint.count()); ++k) {
        const CoordinateVariation<Directions>& coordinate = coordinates_[first + k];
        if (coordinate.varies) tau_[first + k] -= joint.numbers().stiffness[k] * coordinate.q + joint.numbers().damping[k] * coordinate.qd;
      }
    });
  }

  RPSUP_INLINE void solve() {
    solved_.bodies.solve_lanes(solved_.axes.data(), tau_.data(), scratch_, qdd.data());
  }

  RPSUP_INLINE void vary_multipliers(const Directions& time, const DrivenMotion* drives) {
    if constexpr (!Shapes::known) {
      vary_coupling_rows();
      if (model_.drive_rows) vary_drive_rows(time, drives);
    }
    solved_.loops.find_multipliers(scratch_.accelerations.data(), qdd.data(), lambda_.data(), multiplier_scratch_);
    for (std::size_t i = 0; i < needed_.size(); ++i) scratch_.forces[i] = needed_[i];
    solved_.loops.add_reactions(lambda_.data(), scratch_.forces.data(), tau_.data());
    solve();
  }

  RPSUP_INLINE void vary_coupling_rows() {
    for (std::size_t k = 0; k < model_.couplings.size(); ++k) {
      const Coupling& coupling = model_.couplings[k];
      const CoordinateVariation<Directions>& a = coordinates_[coupling.coordinate];
      const CoordinateVariation<Directions>& b = coordinates_[coupling.follows];
      lambda_[static_cast<std::size_t>(model_.first_coupling_row) + k] = -(a.qdd - coupling.ratio * b.qdd) -
                                                                         2.0 * model_.alpha * (a.qd - coupling.ratio * b.qd) -
                                                                         (model_.beta * model_.beta) * (a.q - coupling.ratio * b.q);
    }
  }

  /// The drives' motion varies in time, and by nothing else.
  RPSUP_INLINE void vary_drive_rows(const Directions& time, const DrivenMotion* drives) {
    for (std::size_t k = 0; k < model_.drives.size(); ++k) {
      const CoordinateVariation<Directions>& varies = coordinates_[model_.drives[k]];
      lambda_[static_cast<std::size_t>(model_.first_drive_row) + k] = drives[k].qddd * time -
                                                                      2.0 * model_.alpha * (varies.qd - drives[k].qdd * time) -
                                                                      (model_.beta * model_.beta) * (varies.q - drives[k].qd * time);
    }
  }

  /// See EquationsOfMotion::calc_drive_forces().
  RPSUP_INLINE void vary_drive_forces() {
    if (model_.drive_rows) {
      for (std::size_t k = 0; k < drive_force.size(); ++k) drive_force[k] = lambda_[static_cast<std::size_t>(model_.first_drive_row) + k];
      return;
    }
    Shapes::outwards(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.driven) return;
      const Directions force = solved_.bodies.calc_drive_force(joint, i, solved_.axes[i], scratch_);
      drive_force[static_cast<std::size_t>(joint.drive)] = force - tau_[static_cast<std::size_t>(joint.first)];
    });
  }

  RPSUP_INLINE void vary_losses() {
    Shapes::outwards(model_, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.sprung) return;
      const auto first = static_cast<std::size_t>(joint.first);
      for (std::size_t k = 0; k < static_cast<std::size_t>(joint.count()); ++k)
        if (coordinates_[first + k].varies)
          losses.structural += (2.0 * joint.numbers().damping[k] * solved_.qd[first + k]) * coordinates_[first + k].qd;
    });
  }

  const TreeModel& model_;
  const std::vector<ClearanceJoint>& joints_;
  const EquationsOfMotion<Shapes>& solved_;
  // Of the solution
  HeldJoint ground_;
  Buffer<HeldJoint> held_;
  Buffer<HeldCoordinate> held_coordinates_;
  std::vector<std::unique_ptr<ContactDerivative>> contacts_;
  Buffer<ActingBristles> acting_;           ///< of each joint with clearance
  Buffer<int> own_bristles_;                ///< theirs
  // Of the directions at hand
  const CoordinateVariation<Directions>* coordinates_ = nullptr;
  const LoadDirection* loads_ = nullptr;
  int load_count_ = 0;
  const VariedFrame<Directions> at_rest_{};
  Buffer<VariedFrame<Directions>> frames_;
  Buffer<Vec3<Directions>> own_turns_;       ///< of each joint against its parent
  Buffer<bool> still_;                       ///< joints that no direction moves: their frames are not set
  typename ArticulatedBodies<Shapes>::template Scratch<Directions> scratch_;  ///< its forces: how what each joint's body needs varies
  Buffer<SpatialForce<Directions>> needed_;  ///< the same, where it is solved for twice
  Buffer<Directions> tau_;
  Buffer<Directions> lambda_;                ///< variation of the multipliers; before that, of what their rows lack
  typename EquationsOfMotion<Shapes>::Loops::template Scratch<Directions> multiplier_scratch_;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
