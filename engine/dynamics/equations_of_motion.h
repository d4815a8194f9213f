#pragma once

#include <variant>
#include <vector>

#include "engine/clearance/continuum_law.h"
#include "engine/clearance/elements_law.h"
#include "engine/clearance/faces_law.h"
#include "engine/dynamics/articulated_bodies.h"
#include "engine/dynamics/constraint_rows.h"
#include "engine/dynamics/equations.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// A cut joint at one instant.
template <typename P, typename V>
struct CutJointMotion {
  Frame<P, V> b, j;                ///< bearing and journal
  RelativeMotion<P, V> journal;    ///< {j} seen from {b}
  JointLoad<V> load;               ///< of a joint with clearance
  Vec3<V> reaction;                ///< force on the journal, in W, [N]
};

/// Work and losses by time.
template <typename V>
struct LossPowers {
  V impact{}, friction{}, structural{};
};

/// The equations of motion of a mechanism at one instant, Eqs. (1)-(13), with room for all that they need.
/// P: scalar of positions and what follows from them; V: scalar of rates and what follows from those too.
/// Shapes: the tree's joints, AnyShapes or known ones.
template <typename P, typename V, typename Shapes>
class EquationsOfMotion {
 public:
  EquationsOfMotion(const TreeModel& model, const std::vector<ClearanceJoint>& joints, std::size_t bristle_room)
      : q(static_cast<std::size_t>(model.coordinates)),
        qd(q.size()),
        qdd(q.size()),
        bristles(bristle_room),
        bristle_rates(bristle_room),
        drive_force(model.drives.size()),
        frames(model.joints.size()),
        axes(model.joints.size()),
        cuts(model.cut_joints.size()),
        model_(model),
        joints_(joints),
        ground_(make_ground<P, V>(model)),
        bodies_(model),
        scratch_(model),
        response_scratch_(model),
        tau_(q.size()),
        turns_(q.size()),
        given_(model.joints.size()),
        needed_(model.joints.size()),
        rows_(model),
        response_(static_cast<std::size_t>(model.rows) * q.size()),
        A_(static_cast<std::size_t>(model.rows * model.rows)),
        lambda_(static_cast<std::size_t>(model.rows)) {}

  /// Computes everything below from q, qd, the driven qdd (free ones: zero) and the bristles.
  [[nodiscard]] RPSUP_INLINE EvaluationStatus evaluate(const DrivenMotion* drives) {
    calc_frames();
    const bool complete = calc_contacts();
    if (!complete) return EvaluationStatus::kBristleMissing;
    calc_needed_forces();
    if (!bodies_.factor(frames.data(), axes.data())) return EvaluationStatus::kNonFinite;
    calc_free_accelerations();
    if (model_.rows > 0 && !solve_multipliers(drives)) return EvaluationStatus::kLocked;
    calc_drive_forces();
    calc_losses();
    return is_finite() ? EvaluationStatus::kOk : EvaluationStatus::kNonFinite;
  }

  // In
  Buffer<P> q;                       ///< one a coordinate, as the following
  Buffer<V> qd, qdd;                 ///< qdd of free coordinates: out
  Buffer<V> bristles;
  bool drives_moved = true;          ///< whether the driven coordinates are others than in the last evaluation
  // Out
  Buffer<V> bristle_rates;
  Buffer<V> drive_force;             ///< one a drive, [N] or [N m]
  Buffer<Frame<P, V>> frames;        ///< of each joint's body, with the accelerations that free coordinates do not add to
  Buffer<JointAxes<P>> axes;
  Buffer<CutJointMotion<P, V>> cuts;
  LossPowers<V> losses;

 private:
  /// All frames, root to tip. The joints that stand on driven ones alone move with time only.
  RPSUP_INLINE void calc_frames() {
    Shapes::outwards(model_, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.rotates() || (!joint.moves && !drives_moved)) return;
      for (int k = 0; k < joint.count(); ++k) turns_[static_cast<std::size_t>(joint.first + k)] = calc_turn(q[static_cast<std::size_t>(joint.first + k)]);
    });
    Shapes::outwards(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.moves && !drives_moved) return;
      const auto first = static_cast<std::size_t>(joint.first);
      Frame<P, V> f = joint.parent < 0 ? ground_ : frames[static_cast<std::size_t>(joint.parent)];
      calc_joint_frame(joint, &q[first], &turns_[first], &qd[first], &qdd[first], f, axes[i]);
      frames[i] = f;
      if (!joint.moves) given_[i] = calc_body_force(joint, f);
    });
  }

  RPSUP_INLINE bool calc_contacts() {
    bool complete = true;
    std::size_t bristle = 0;
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      const TreeCutJoint& joint = model_.cut_joints[k];
      CutJointMotion<P, V>& cut = cuts[k];
      cut.b = place(joint.bearing, frame_of(joint.bearing_joint), joint.clearance < 0);
      cut.j = place(joint.journal, frame_of(joint.journal_joint), joint.clearance < 0);
      calc_relative_motion(cut);
      if (joint.clearance < 0) continue;
      const ClearanceJoint& contact = joints_[static_cast<std::size_t>(joint.clearance)];
      cut.load = {};
      add_faces(contact.faces(), cut.journal, cut.load);
      V* z = bristles.data() + bristle;
      V* zd = bristle_rates.data() + bristle;
      if (const RadialElements* elements = contact.elements())
        complete = add_elements(*elements, cut.journal, z, zd, cut.load) && complete;
      else
        add_continuum(*contact.continuum(), cut.journal, z, zd, cut.load);
      bristle += static_cast<std::size_t>(contact.bristle_count());
      cut.reaction = cut.b.R * cut.load.force;
    }
    return complete;
  }

  [[nodiscard]] RPSUP_INLINE const Frame<P, V>& frame_of(int joint) const { return joint < 0 ? ground_ : frames[static_cast<std::size_t>(joint)]; }

  /// A bearing or journal on its body. @param accelerations  whether they are wanted
  [[nodiscard]] RPSUP_INLINE static Frame<P, V> place(const TreePlacement& placement, const Frame<P, V>& body, bool accelerations) {
    Frame<P, V> placed;
    placed.R = placement.turned ? multiply_constant(body.R, placement.R) : body.R;
    placed.p = body.p;
    placed.w = body.w;
    placed.v = body.v;
    if (accelerations) {
      placed.wd = body.wd;
      placed.vd = body.vd;
    }
    if (!placement.shifted) return placed;
    const Vec3<P> r = rotate_constant(body.R, placement.p, placement.along_x);
    if (accelerations) {
      shift_frame(r, true, placed);
    } else {
      placed.p += r;
      placed.v += cross(body.w, r);
    }
    return placed;
  }

  RPSUP_INLINE static void calc_relative_motion(CutJointMotion<P, V>& cut) {
    const Vec3<P> offset = cut.j.p - cut.b.p;
    const Mat3<P>& R = cut.b.R;
    cut.journal.R = {transpose_times(R, cut.j.R.x), transpose_times(R, cut.j.R.y), transpose_times(R, cut.j.R.z)};
    cut.journal.p = transpose_times(R, offset);
    cut.journal.v = transpose_times(R, cut.j.v - cut.b.v - cross(cut.b.w, offset));
    cut.journal.w = transpose_times(R, cut.j.w - cut.b.w);
  }

  /// What moves each joint's body as its frame moves, less the contacts' loads on it.
  RPSUP_INLINE void calc_needed_forces() {
    Shapes::outwards(model_, [&](std::size_t i, const auto& joint) RPSUP_INLINE_LAMBDA {
      needed_[i] = joint.moves ? calc_body_force(joint, frames[i]) : given_[i];
    });
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      const TreeCutJoint& joint = model_.cut_joints[k];
      if (joint.clearance < 0) continue;
      const CutJointMotion<P, V>& cut = cuts[k];
      const Vec3<V> moment = cut.b.R * cut.load.moment;
      // Both act at the journal's centre: on the journal, and the opposite on the bearing.
      if (joint.journal_joint >= 0) {
        SpatialForce<V>& needed = needed_[static_cast<std::size_t>(joint.journal_joint)];
        needed.force -= cut.reaction;
        needed.moment -= moment;
        if (joint.journal.shifted) needed.moment -= cross(cut.j.p - frames[static_cast<std::size_t>(joint.journal_joint)].p, cut.reaction);
      }
      if (joint.bearing_joint >= 0) {
        SpatialForce<V>& needed = needed_[static_cast<std::size_t>(joint.bearing_joint)];
        needed.force += cut.reaction;
        needed.moment += moment + cross(cut.j.p - frames[static_cast<std::size_t>(joint.bearing_joint)].p, cut.reaction);
      }
    }
  }

  RPSUP_INLINE void calc_free_accelerations() {
    Shapes::outwards(model_, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
      const auto first = static_cast<std::size_t>(joint.first);
      for (std::size_t k = 0; k < static_cast<std::size_t>(joint.count()); ++k)
        tau_[first + k] =
            joint.sprung ? -(joint.numbers().stiffness[k] * q[first + k] + joint.numbers().damping[k] * qd[first + k]) : V(0.0);
    });
    solve();
  }

  RPSUP_INLINE void solve() {
    for (std::size_t i = 0; i < needed_.size(); ++i) scratch_.forces[i] = needed_[i];
    bodies_.solve(axes.data(), tau_.data(), scratch_, qdd.data());
  }

  /// (Phi_q M^-1 Phi_q^T) lambda = -(Phi_q qdd_0 + bias) - 2 alpha Phi_d - beta^2 Phi, with qdd_0 the accelerations without constraints.
  RPSUP_INLINE bool solve_multipliers(const DrivenMotion* drives) {
    calc_rows(drives);
    const int n = model_.coordinates;
    const int count = rows_.count;
    for (int r = 0; r < count; ++r) {
      response_scratch_.forces.fill({});
      bodies_.solve(axes.data(), rows_.row(r), response_scratch_, response_.data() + r * n);
    }
    for (int r = 0; r < count; ++r) {
      V sum = -(rows_.bias[static_cast<std::size_t>(r)] + 2.0 * model_.alpha * rows_.Phi_d[static_cast<std::size_t>(r)] +
                model_.beta * model_.beta * rows_.Phi[static_cast<std::size_t>(r)]);
      for (const int i : model_.free) sum -= rows_.row(r)[i] * qdd[static_cast<std::size_t>(i)];
      lambda_[static_cast<std::size_t>(r)] = sum;
      for (int c = 0; c <= r; ++c) {
        P entry(0.0);
        for (const int i : model_.free) entry += rows_.row(r)[i] * response_[static_cast<std::size_t>(c * n + i)];
        A_[static_cast<std::size_t>(r * count + c)] = entry;
      }
    }
    constexpr double kSingular = 1e-12;  // of a pivot, relative to its row: the loop stands at the end of its reach
    if (!factor_cholesky(count, kSingular, A_.data())) return false;
    solve_cholesky(count, A_.data(), lambda_.data());
    for (int r = 0; r < count; ++r)
      for (const int i : model_.free) tau_[static_cast<std::size_t>(i)] += rows_.row(r)[i] * lambda_[static_cast<std::size_t>(r)];
    solve();
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      const int first = model_.cut_joints[k].first_row;
      if (first < 0) continue;
      const V* force = lambda_.data() + first;
      cuts[k].reaction = {force[0], force[1], force[2]};
    }
    return true;
  }

  RPSUP_INLINE void calc_rows(const DrivenMotion* drives) {
    for (std::size_t k = 0; k < cuts.size(); ++k)
      if (model_.cut_joints[k].first_row >= 0) calc_joint_rows(model_, model_.cut_joints[k], frames.data(), axes.data(), cuts[k].b, cuts[k].j, rows_);
    if (!model_.drive_rows) return;
    for (std::size_t k = 0; k < model_.drives.size(); ++k) {
      const auto d = static_cast<std::size_t>(model_.drives[k]);
      const std::size_t row = static_cast<std::size_t>(model_.first_drive_row) + k;
      rows_.Phi[row] = q[d] - wanted_q(drives[k]);
      rows_.Phi_d[row] = qd[d] - wanted_qd(drives[k]);
      rows_.bias[row] = -wanted_qdd(drives[k]);
      rows_.row(static_cast<int>(row))[d] = P(1.0);
    }
  }

  /// The drives' motion varies in time, and by nothing else.
  RPSUP_INLINE P wanted_q(const DrivenMotion& drive) const { return differentiate(time, drive.q, drive.qd); }
  RPSUP_INLINE V wanted_qd(const DrivenMotion& drive) const { return V(differentiate(time, drive.qd, drive.qdd)); }
  RPSUP_INLINE V wanted_qdd(const DrivenMotion& drive) const { return V(differentiate(time, drive.qdd, drive.qddd)); }

  RPSUP_INLINE void calc_drive_forces() {
    for (std::size_t k = 0; k < model_.drives.size(); ++k) {
      const auto d = static_cast<std::size_t>(model_.drives[k]);
      if (model_.drive_rows) {
        drive_force[k] = lambda_[static_cast<std::size_t>(model_.first_drive_row) + k];
        continue;
      }
      const auto index = static_cast<std::size_t>(model_.drive_joints[k]);
      const TreeJoint& joint = model_.joints[index];
      V force = bodies_.calc_drive_force(model_.drive_joints[k], axes[index], scratch_);
      if (joint.sprung) force += joint.stiffness[0] * q[d] + joint.damping[0] * qd[d];
      for (int r = 0; r < rows_.count; ++r) force -= rows_.row(r)[d] * lambda_[static_cast<std::size_t>(r)];
      drive_force[k] = force;
    }
  }

  RPSUP_INLINE void calc_losses() {
    losses = {};
    for (const CutJointMotion<P, V>& cut : cuts) {
      losses.impact += cut.load.impact_power;
      losses.friction += cut.load.friction_power;
    }
    Shapes::outwards(model_, [&](std::size_t, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (!joint.sprung) return;
      for (std::size_t k = 0; k < static_cast<std::size_t>(joint.count()); ++k) {
        const V& rate = qd[static_cast<std::size_t>(joint.first) + k];
        losses.structural += joint.numbers().damping[k] * (rate * rate);
      }
    });
  }

  [[nodiscard]] RPSUP_INLINE bool is_finite() const {
    double sum = 0.0;
    for (const int i : model_.free) sum += value_of(qdd[static_cast<std::size_t>(i)]) * 0.0;
    return sum == 0.0;
  }

 public:
  P time{};                          ///< carries the direction of time, where it is one

 private:
  const TreeModel& model_;
  const std::vector<ClearanceJoint>& joints_;
  const Frame<P, V> ground_;
  ArticulatedBodies<P, Shapes> bodies_;
  typename ArticulatedBodies<P, Shapes>::template Scratch<V> scratch_;
  typename ArticulatedBodies<P, Shapes>::template Scratch<P> response_scratch_;
  Buffer<V> tau_;
  Buffer<Turn<P>> turns_;            ///< one a coordinate
  Buffer<SpatialForce<V>> given_;    ///< needed by the bodies that move with time only
  Buffer<SpatialForce<V>> needed_;
  ConstraintRows<P, V> rows_;
  Buffer<P> response_;               ///< M^-1 Phi_q^T, row after row of Phi
  Buffer<P> A_;                      ///< Phi_q M^-1 Phi_q^T
  Buffer<V> lambda_;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
