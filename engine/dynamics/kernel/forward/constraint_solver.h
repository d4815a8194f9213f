// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <type_traits>

#include "engine/dynamics/constraint_rows.h"
#include "engine/dynamics/kernel/forward/articulated_bodies.h"
#include "engine/dynamics/kernel/forward/delassus_matrix.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/buffer.h"
#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// An ideal cut joint at one instant, as its multipliers act on it.
struct ClosedJoint {
  JointViolation<double, double> violation;
  Mat3<double> R_b;                       ///< of the bearing
  Vec3<double> bearing_arm, journal_arm;  ///< from the bodies' origins to where the reaction acts on them
};

/// What a tree needs that is not known when the program is compiled: its rows may be of coordinates, and may depend on each other.
struct AnyRows {
  explicit AnyRows(const TreeModel& model)
      : entries(model), tau(static_cast<std::size_t>(model.coordinates)), responses(tau.size()) {}

  ConstraintEntries entries;           ///< set only where rows may depend on each other
  Buffer<Directions> tau, responses;   ///< one a coordinate
};
struct KnownRows {
  RPSUP_INLINE explicit KnownRows(const TreeModel&) {}
};

/// What moves the bodies if there are no multipliers, as ArticulatedBodies::solve() takes it.
struct FreeMotion {
  const SpatialForce<double>* needed;  ///< one a joint
  const double* tau;                   ///< one a coordinate
  const RodMotion* rods;               ///< one a joint, of known shapes
};

/// The constraints of closed loops and enforced drives, solved for their multipliers lambda:
///
///     (Phi_q M^-1 Phi_q^T) lambda = wanted - Phi_q qdd_0
///
/// without Phi_q: a joint's rows say which forces their multipliers exert on two bodies, and what they make of the accelerations of these two.
/// (Only to find idle rows among those that depend on each other it is computed, see MultiplierMatrix::start.)
template <typename Shapes>
class LoopEquations {
  using Bodies = ArticulatedBodies<Shapes>;
  using Matrix = typename MatrixOf<Shapes>::Type;
  template <typename T>
  using RowRoom = typename Shapes::template RowRoom<T>;

 public:
  /// Room for solve() and find_multipliers().
  template <typename T>
  using Scratch = typename Matrix::template Scratch<T>;

  RPSUP_INLINE explicit LoopEquations(const TreeModel& model)
      : rows(model),
        general(model),
        lambda(static_cast<std::size_t>(model.rows)),
        joints(model.cut_joints.size()),
        model_(model),
        matrix_(model),
        bodies_scratch_(model),
        lacking_(lambda.size()),
        units_(lambda.size()),
        rest_(lambda.size()) {}

  ConstraintRows<RowRoom<double>> rows;
  std::conditional_t<Shapes::known, KnownRows, AnyRows> general;
  RowRoom<double> lambda;                                 ///< the rows' multipliers
  typename Shapes::template CutRoom<ClosedJoint> joints;  ///< ideal cut joints

  /// Computes the multipliers of a motion from the joints as they stand. False if the loops cannot follow.
  /// @param multipliers  in: wanted
  [[nodiscard]] RPSUP_INLINE bool solve(const Bodies& bodies, const JointAxes* axes, const FreeMotion& motion, double* multipliers,
                                        Scratch<double>& scratch) {
    if (!factor(bodies, axes, motion)) return false;
    for (std::size_t r = 0; r < lacking_.size(); ++r) multipliers[r] += lacking_[r];
    matrix_.solve(multipliers, scratch);
    return true;
  }

  /// What accelerations lack of those that are wanted, as multipliers. After solve().
  /// @param multipliers  in: wanted  @tparam T  a number, or several side by side
  template <typename T>
  RPSUP_INLINE void find_multipliers(const SpatialAcceleration<T>* accelerations, const T* qdd, T* multipliers, Scratch<T>& scratch) const {
    subtract_answers(accelerations, qdd, multipliers);
    matrix_.solve(multipliers, scratch);
  }

  /// What multipliers exert: joints on bodies, the others on coordinates.
  template <typename T>
  RPSUP_INLINE void add_reactions(const T* multipliers, SpatialForce<T>* needed, T* tau) const {
    load_bodies(multipliers, needed);
    if constexpr (!Shapes::known) load_coordinates(multipliers, tau);
  }

 private:
  /// Of the acting rows the columns of the matrix, and before the first of them the motion without multipliers: as many at once as there are
  /// directions.
  [[nodiscard]] RPSUP_INLINE bool factor(const Bodies& bodies, const JointAxes* axes, const FreeMotion& motion) {
    if constexpr (!Shapes::known)
      if (model_.least_multipliers) matrix_.start(general.entries, model_.free);
    const int count = matrix_.acting_count();
    matrix_.template each_place<Directions::kCount>([&](auto place) RPSUP_INLINE_LAMBDA {
      calc_responses(bodies, axes, motion, place);
      for (int k = std::max<int>(place, 0); k < count; ++k) matrix_.set(k, place, rest_[static_cast<std::size_t>(matrix_.acting(k))]);
    });
    return matrix_.factor();
  }

  /// rest_ <- Phi_q M^-1 Phi_q^T, of the acting rows from a place on the columns, side by side; at place -1 the motion, and lacking_ of it.
  RPSUP_INLINE void calc_responses(const Bodies& bodies, const JointAxes* axes, const FreeMotion& motion, int place) {
    auto& forces = bodies_scratch_.forces;
    forces.fill({});
    if (place < 0)
      for (std::size_t i = 0; i < forces.size(); ++i)
        forces[i] = {as_first<Directions>(motion.needed[i].force), as_first<Directions>(motion.needed[i].moment)};
    units_.fill({});
    for (int k = std::max(place, 0); k < std::min(place + Directions::kCount, matrix_.acting_count()); ++k)
      units_[static_cast<std::size_t>(matrix_.acting(k))] = -Directions::unit(k - place);
    load_bodies(units_.data(), forces.data());
    rest_.fill({});
    if constexpr (Shapes::known) {
      static constexpr double no_tau[Shapes::n_q]{};
      bodies.solve_bodies_lanes(axes, place < 0 ? motion.tau : no_tau, bodies_scratch_, place < 0 ? motion.rods : nullptr);
      subtract_accelerations(bodies_scratch_.accelerations.data(), rest_.data());
    } else {
      general.tau.fill({});
      if (place < 0)
        for (std::size_t i = 0; i < general.tau.size(); ++i) general.tau[i] = Directions::first(motion.tau[i]);
      load_coordinates(units_.data(), general.tau.data());
      bodies.solve_lanes(axes, general.tau.data(), bodies_scratch_, general.responses.data());
      subtract_answers(bodies_scratch_.accelerations.data(), general.responses.data(), rest_.data());
    }
    if (place < 0)
      for (std::size_t r = 0; r < lacking_.size(); ++r) lacking_[r] = rest_[r][0];
  }

  /// Takes what the joints' multipliers exert from what each joint's body needs.
  template <typename T>
  RPSUP_INLINE void load_bodies(const T* multipliers, SpatialForce<T>* needed) const {
    Shapes::cut_joints(model_, [&](std::size_t k, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (joint.has_clearance()) return;
      const ClosedJoint& closed = joints[k];
      const JointReaction<T> reaction = calc_joint_reaction(joint.rows, closed.violation, closed.R_b, multipliers + joint.numbers().first_row);
      if (joint.journal_joint >= 0) {
        SpatialForce<T>& on_journal = needed[joint.journal_joint];
        on_journal.force -= reaction.force;
        on_journal.moment -= reaction.moment;
        if (joint.journal.shifted) on_journal.moment -= cross(closed.journal_arm, reaction.force);
      }
      if (joint.bearing_joint >= 0) {
        SpatialForce<T>& on_bearing = needed[joint.bearing_joint];
        on_bearing.force += reaction.force;
        on_bearing.moment += reaction.moment + cross(closed.bearing_arm, reaction.force);
      }
    });
  }

  /// Driven coordinates, too: their drives bear it.
  template <typename T>
  RPSUP_INLINE void load_coordinates(const T* multipliers, T* tau) const {
    for (std::size_t k = 0; k < model_.couplings.size(); ++k) {
      const Coupling& coupling = model_.couplings[k];
      const T& multiplier = multipliers[static_cast<std::size_t>(model_.first_coupling_row) + k];
      tau[coupling.coordinate] += multiplier;
      tau[coupling.follows] -= coupling.ratio * multiplier;
    }
    if (!model_.drive_rows) return;
    for (std::size_t k = 0; k < model_.drives.size(); ++k) tau[model_.drives[k]] += multipliers[static_cast<std::size_t>(model_.first_drive_row) + k];
  }

  /// rest <- rest - Phi_q qdd. @param accelerations  of each joint's body, by the free coordinates
  template <typename T>
  RPSUP_INLINE void subtract_answers(const SpatialAcceleration<T>* accelerations, const T* qdd, T* rest) const {
    subtract_accelerations(accelerations, rest);
    if constexpr (!Shapes::known) subtract_coordinates(qdd, rest);
  }

  template <typename T>
  RPSUP_INLINE void subtract_accelerations(const SpatialAcceleration<T>* accelerations, T* rest) const {
    Shapes::cut_joints(model_, [&](std::size_t k, const auto& joint) RPSUP_INLINE_LAMBDA {
      if (joint.has_clearance()) return;
      const ClosedJoint& closed = joints[k];
      const SpatialAcceleration<T> b = see_at(accelerations, joint.bearing_joint, closed.bearing_arm);
      const SpatialAcceleration<T> j = see_at(accelerations, joint.journal_joint, closed.journal_arm);
      subtract_joint_answer(joint.rows, closed.violation, closed.R_b, j.angular - b.angular, j.linear - b.linear, rest + joint.numbers().first_row);
    });
  }

  template <typename T>
  RPSUP_INLINE void subtract_coordinates(const T* qdd, T* rest) const {
    const auto free = [&](int coordinate) RPSUP_INLINE_LAMBDA { return model_.is_eliminated(coordinate) ? T{} : qdd[coordinate]; };
    for (std::size_t k = 0; k < model_.couplings.size(); ++k) {
      const Coupling& coupling = model_.couplings[k];
      rest[static_cast<std::size_t>(model_.first_coupling_row) + k] -= free(coupling.coordinate) - coupling.ratio * free(coupling.follows);
    }
    if (!model_.drive_rows) return;
    for (std::size_t k = 0; k < model_.drives.size(); ++k) rest[static_cast<std::size_t>(model_.first_drive_row) + k] -= qdd[model_.drives[k]];
  }

  /// Of a joint's body, at the end of an arm from its origin.
  template <typename T>
  [[nodiscard]] RPSUP_INLINE SpatialAcceleration<T> see_at(const SpatialAcceleration<T>* accelerations, int joint, const Vec3<double>& arm) const {
    if (joint < 0 || !model_.joints[static_cast<std::size_t>(joint)].moves) return {};
    const SpatialAcceleration<T>& body = accelerations[joint];
    return {body.angular, body.linear + cross(body.angular, arm)};
  }

  const TreeModel& model_;
  Matrix matrix_;                  ///< factored
  typename Bodies::template Scratch<Directions> bodies_scratch_;
  RowRoom<double> lacking_;        ///< -Phi_q qdd_0
  RowRoom<Directions> units_, rest_;
};
/// There are none.
struct NoLoops {
  RPSUP_INLINE explicit NoLoops(const TreeModel&) {}

  template <typename T>
  using Scratch = NoLoops;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
