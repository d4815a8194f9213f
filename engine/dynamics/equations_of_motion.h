#pragma once

#include <vector>

#include "engine/clearance/joint_contact.h"
#include "engine/dynamics/articulated_bodies.h"
#include "engine/dynamics/constraint_rows.h"
#include "engine/dynamics/cut_joint_motion.h"
#include "engine/dynamics/equations.h"
#include "engine/dynamics/multiplier_matrix.h"
#include "engine/math/sine_cosine.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Work and losses by time.
template <typename T>
struct LossPowers {
  T impact{}, friction{}, structural{};
};

/// The equations of motion of a mechanism at one instant, Eqs. (1)-(13), with room for all that they need.
/// Shapes: the tree's joints, AnyShapes or known ones.
template <typename Shapes>
class EquationsOfMotion {
 public:
  EquationsOfMotion(const TreeModel& model, const std::vector<ClearanceJoint>& joints, std::size_t bristle_room)
      : q(static_cast<std::size_t>(model.coordinates), in_sine_blocks(static_cast<std::size_t>(model.coordinates))),
        qd(q.size()),
        qdd(q.size()),
        bristles(bristle_room),
        bristle_rates(bristle_room),
        drive_force(model.drives.size()),
        frames(model.joints.size()),
        axes(model.joints.size()),
        cuts(model.cut_joints.size()),
        bodies(model),
        rows(model),
        lambda(static_cast<std::size_t>(model.rows)),
        model_(model),
        joints_(joints),
        ground_(make_ground(model)),
        scratch_(model),
        tau_(q.size()),
        sines_(in_sine_blocks(q.size())),
        cosines_(in_sine_blocks(q.size())),
        given_(model.joints.size()),
        needed_(model.joints.size()),
        response_(static_cast<std::size_t>(model.rows) * q.size()),
        violations_(model.cut_joints.size()),
        matrix_(model),
        multiplier_scratch_(model) {}

  /// Computes everything below from q, qd, the driven qdd (free ones: zero) and the bristles.
  [[nodiscard]] RPSUP_INLINE EvaluationStatus evaluate(const DrivenMotion* drives) {
    calc_frames();
    if (!calc_contacts()) return EvaluationStatus::kBristleMissing;
    calc_needed_forces();
    if (!bodies.factor(frames.data(), axes.data())) return EvaluationStatus::kNonFinite;
    calc_free_accelerations();
    if (model_.rows > 0 && !solve_multipliers(drives)) return EvaluationStatus::kLocked;
    calc_drive_forces();
    calc_losses();
    if (is_finite()) return EvaluationStatus::kOk;
    return is_out_of_range() ? EvaluationStatus::kOutOfRange : EvaluationStatus::kNonFinite;
  }

  /// What the constraints lack of the accelerations that they want: lambda <- (Phi_q M^-1 Phi_q^T)^-1 (wanted - Phi_q qdd). After evaluate().
  /// @param multipliers  in: wanted  @tparam T  a number, or several side by side
  template <typename T>
  RPSUP_INLINE void find_multipliers(const T* accelerations, T* multipliers, MultiplierMatrix::Scratch<T>& scratch) const {
    for (int r = 0; r < rows.count; ++r)
      for (const int i : model_.free) multipliers[r] -= rows.row(r)[i] * accelerations[i];
    matrix_.solve(multipliers, scratch);
  }

  /// tau <- tau + Phi_q^T lambda
  template <typename T>
  RPSUP_INLINE void add_reactions(const T* multipliers, T* tau) const {
    for (int r = 0; r < rows.count; ++r)
      for (const int i : model_.free) tau[i] += rows.row(r)[i] * multipliers[r];
  }

  [[nodiscard]] const Frame<double, double>& ground() const { return ground_; }

  // In
  Buffer<double> q;                             ///< one a coordinate, as the following
  Buffer<double> qd, qdd;                       ///< qdd of free coordinates: out
  Buffer<double> bristles;
  bool drives_moved = true;                     ///< whether the driven coordinates are others than in the last evaluation
  // Out
  Buffer<double> bristle_rates;
  Buffer<double> drive_force;                   ///< one a drive, [N] or [N m]
  Buffer<Frame<double, double>> frames;         ///< of each joint's body, with the accelerations that free coordinates do not add to
  Buffer<JointAxes> axes;
  Buffer<CutJointMotion<double, double>> cuts;
  LossPowers<double> losses;
  ArticulatedBodies<Shapes> bodies;
  ConstraintRows rows;
  Buffer<double> lambda;                        ///< the rows' multipliers

 private:
  /// All frames, root to tip. The joints that stand on driven ones alone move with time only.
  RPSUP_INLINE void calc_frames() {
    calc_sines_and_cosines(q.data(), q.size(), sines_.data(), cosines_.data());  // of slides too: asking costs more
    Shapes::outwards(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.moves && !drives_moved) return;
      const auto first = static_cast<std::size_t>(joint.first);
      Frame<double, double> f = joint.parent < 0 ? ground_ : frames[static_cast<std::size_t>(joint.parent)];
      calc_joint_frame(joint, &q[first], &sines_[first], &cosines_[first], &qd[first], &qdd[first], f, axes[i]);
      frames[i] = f;
      if (!joint.moves) given_[i] = calc_body_force(joint, f);
    });
  }

  RPSUP_INLINE bool calc_contacts() {
    bool complete = true;
    std::size_t bristle = 0;
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      const TreeCutJoint& joint = model_.cut_joints[k];
      place_parts(joint, frame_of(joint.bearing_joint), frame_of(joint.journal_joint), cuts[k]);
      if (joint.clearance < 0) continue;
      const ClearanceJoint& contact = joints_[static_cast<std::size_t>(joint.clearance)];
      cuts[k].load = {};
      complete = add_contacts(contact, cuts[k].journal, bristles.data() + bristle, bristle_rates.data() + bristle, cuts[k].load) && complete;
      cuts[k].reaction = cuts[k].b.R * cuts[k].load.force;
      cuts[k].moment = cuts[k].b.R * cuts[k].load.moment;
      bristle += static_cast<std::size_t>(contact.bristle_count());
    }
    return complete;
  }

  [[nodiscard]] RPSUP_INLINE const Frame<double, double>& frame_of(int joint) const {
    return joint < 0 ? ground_ : frames[static_cast<std::size_t>(joint)];
  }

  /// What moves each joint's body as its frame moves, less the contacts' loads on it.
  RPSUP_INLINE void calc_needed_forces() {
    Shapes::outwards(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      needed_[i] = joint.moves ? calc_body_force(joint, frames[i]) : given_[i];
    });
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      const TreeCutJoint& joint = model_.cut_joints[k];
      if (joint.clearance < 0) continue;
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
    }
  }

  RPSUP_INLINE void calc_free_accelerations() {
    Shapes::outwards(model_, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
      const auto first = static_cast<std::size_t>(joint.first);
      for (std::size_t k = 0; k < static_cast<std::size_t>(joint.count()); ++k)
        tau_[first + k] =
            joint.sprung ? -(joint.numbers().stiffness[k] * q[first + k] + joint.numbers().damping[k] * qd[first + k]) : 0.0;
    });
    solve();
  }

  RPSUP_INLINE void solve() {
    for (std::size_t i = 0; i < needed_.size(); ++i) scratch_.forces[i] = needed_[i];
    bodies.solve(axes.data(), tau_.data(), scratch_, qdd.data());
  }

  /// (Phi_q M^-1 Phi_q^T) lambda = -(Phi_q qdd_0 + bias) - 2 alpha Phi_d - beta^2 Phi, with qdd_0 the accelerations without constraints.
  RPSUP_INLINE bool solve_multipliers(const DrivenMotion* drives) {
    calc_rows(drives);
    if (model_.least_multipliers && is_apart()) return false;
    const int n = model_.coordinates;
    matrix_.start(rows, model_.free);
    for (int k = 0; k < matrix_.acting_count(); ++k) {
      const double* row = rows.row(matrix_.acting(k));
      scratch_.forces.fill({});
      bodies.solve(axes.data(), row, scratch_, response_.data() + k * n);
      for (int l = 0; l <= k; ++l) {
        double entry = 0.0;
        for (const int i : model_.free) entry += row[i] * response_[static_cast<std::size_t>(l * n + i)];
        matrix_.entry(k, l) = entry;
      }
    }
    if (!matrix_.factor()) return false;
    for (std::size_t r = 0; r < lambda.size(); ++r)
      lambda[r] = -(rows.bias[r] + 2.0 * model_.alpha * rows.Phi_d[r] + model_.beta * model_.beta * rows.Phi[r]);
    find_multipliers(qdd.data(), lambda.data(), multiplier_scratch_);
    add_reactions(lambda.data(), tau_.data());
    solve();
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      const TreeCutJoint& joint = model_.cut_joints[k];
      if (joint.first_row < 0) continue;
      const JointReaction<double> reaction = calc_joint_reaction(joint.rows, violations_[k], cuts[k].b.R, lambda.data() + joint.first_row);
      cuts[k].reaction = reaction.force;
      cuts[k].moment = reaction.moment;
    }
    return true;
  }

  /// Where rows depend on each other no singular matrix tells that the loops cannot follow: they come apart.
  [[nodiscard]] RPSUP_INLINE bool is_apart() const {
    constexpr double kApart = 1e-2;  // [m] or [1]
    double largest = 0.0;
    for (int r = 0; r < model_.first_drive_row; ++r) largest = std::max(largest, std::abs(rows.Phi[static_cast<std::size_t>(r)]));
    return !(largest < kApart);
  }

  RPSUP_INLINE void calc_rows(const DrivenMotion* drives) {
    for (std::size_t k = 0; k < cuts.size(); ++k)
      if (model_.cut_joints[k].first_row >= 0) {
        violations_[k] = calc_joint_violation(model_.cut_joints[k].rows, cuts[k].b, cuts[k].j);
        calc_joint_rows(model_, model_.cut_joints[k], frames.data(), axes.data(), cuts[k].b, cuts[k].j, violations_[k], rows);
      }
    if (!model_.couplings.empty()) calc_coupling_rows(model_, q.data(), qd.data(), qdd.data(), rows);
    if (!model_.drive_rows) return;
    for (std::size_t k = 0; k < model_.drives.size(); ++k) {
      const auto d = static_cast<std::size_t>(model_.drives[k]);
      const std::size_t row = static_cast<std::size_t>(model_.first_drive_row) + k;
      rows.Phi[row] = q[d] - drives[k].q;
      rows.Phi_d[row] = qd[d] - drives[k].qd;
      rows.bias[row] = -drives[k].qdd;
      rows.row(static_cast<int>(row))[d] = 1.0;
    }
  }

  RPSUP_INLINE void calc_drive_forces() {
    for (std::size_t k = 0; k < model_.drives.size(); ++k) {
      const auto d = static_cast<std::size_t>(model_.drives[k]);
      if (model_.drive_rows) {
        drive_force[k] = lambda[static_cast<std::size_t>(model_.first_drive_row) + k];
        continue;
      }
      const auto index = static_cast<std::size_t>(model_.drive_joints[k]);
      const TreeJoint& joint = model_.joints[index];
      double force = bodies.calc_drive_force(model_.drive_joints[k], axes[index], scratch_);
      if (joint.sprung) force += joint.stiffness[0] * q[d] + joint.damping[0] * qd[d];
      for (int r = 0; r < rows.count; ++r) force -= rows.row(r)[d] * lambda[static_cast<std::size_t>(r)];
      drive_force[k] = force;
    }
  }

  RPSUP_INLINE void calc_losses() {
    losses = {};
    for (const CutJointMotion<double, double>& cut : cuts) {
      losses.impact += cut.load.impact_power;
      losses.friction += cut.load.friction_power;
    }
    Shapes::outwards(model_, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.sprung) return;
      for (std::size_t k = 0; k < static_cast<std::size_t>(joint.count()); ++k) {
        const double rate = qd[static_cast<std::size_t>(joint.first) + k];
        losses.structural += joint.numbers().damping[k] * (rate * rate);
      }
    });
  }

  [[nodiscard]] RPSUP_INLINE bool is_out_of_range() const {
    bool out = false;
    for (std::size_t k = 0; k < cuts.size(); ++k) out = out || cuts[k].load.out_of_range;
    return out;
  }

  [[nodiscard]] RPSUP_INLINE bool is_finite() const {
    double sum = 0.0;
    for (const int i : model_.free) sum += qdd[static_cast<std::size_t>(i)] * 0.0;
    return sum == 0.0;
  }

 private:
  const TreeModel& model_;
  const std::vector<ClearanceJoint>& joints_;
  const Frame<double, double> ground_;
  typename ArticulatedBodies<Shapes>::template Scratch<double> scratch_;
  Buffer<double> tau_;
  Buffer<double> sines_, cosines_;              ///< one a coordinate
  Buffer<SpatialForce<double>> given_;          ///< needed by the bodies that move with time only
  Buffer<SpatialForce<double>> needed_;
  Buffer<double> response_;                     ///< M^-1 Phi_q^T, row after row of Phi
  Buffer<JointViolation<double, double>> violations_;  ///< one a cut joint; of ideal ones
  MultiplierMatrix matrix_;                     ///< factored
  MultiplierMatrix::Scratch<double> multiplier_scratch_;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
