// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/kinematics/frame_recursion.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/buffer.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Rows of the constraints Phi(q, t) = 0: those of each ideal cut joint (see CutRows), one for each coupling, one for each drive that is
/// enforced by a multiplier.
///
///     p_J - p_B = 0 (3), or x_b . (p_J - p_B) = 0, y_b . (p_J - p_B) = 0;   of z_b . x_j = 0, z_b . y_j = 0, x_b . y_j = 0 as many as are held
///     q_a - ratio q_b = 0,    q_d - q_d(t) = 0
///
/// The multipliers are the forces that the rows exert: of an ideal joint on its journal (in W), of a drive on its coordinate.
///
/// @tparam Rows  an array of one number a row: Buffer<double>, or FixedBuffer where the number of rows is known at compile time
template <typename Rows>
struct ConstraintRows {
  RPSUP_INLINE explicit ConstraintRows(const TreeModel& model)
      : Phi(static_cast<std::size_t>(model.rows)), Phi_d(Phi.size()), bias(Phi.size()) {}

  Rows Phi;    ///< [m] and [1]
  Rows Phi_d;  ///< first derivative by time
  Rows bias;   ///< second derivative without the unknown accelerations
};

/// Phi_q, row after row, one entry a coordinate. Those of couplings and drives never change.
struct ConstraintEntries {
  explicit ConstraintEntries(const TreeModel& model)
      : count(model.rows), coordinates(model.coordinates), Phi_q(static_cast<std::size_t>(count * coordinates)) {
    for (std::size_t k = 0; k < model.couplings.size(); ++k) {
      double* entries = row(model.first_coupling_row + static_cast<int>(k));
      entries[model.couplings[k].coordinate] = 1.0;
      entries[model.couplings[k].follows] = -model.couplings[k].ratio;
    }
    if (!model.drive_rows) return;
    for (std::size_t k = 0; k < model.drives.size(); ++k) row(model.first_drive_row + static_cast<int>(k))[model.drives[k]] = 1.0;
  }

  [[nodiscard]] RPSUP_INLINE double* row(int r) { return Phi_q.data() + r * coordinates; }
  [[nodiscard]] RPSUP_INLINE const double* row(int r) const { return Phi_q.data() + r * coordinates; }

  int count, coordinates;
  Buffer<double> Phi_q;
};

/// What an ideal joint's rows come to.
template <typename P, typename V>
struct JointViolation {
  P Phi[6];
  V Phi_d[6], Phi_dd[6];
  Vec3<P> turn[3];  ///< of each row of axes: the moment that its multiplier, being one, exerts on the journal
};

/// @param b, j  bearing and journal with their accelerations
template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE JointViolation<P, V> calc_joint_violation(const CutRows& rows, const Frame<P, V>& b, const Frame<P, V>& j) {
  JointViolation<P, V> violation;
  const Vec3<P> d = j.p - b.p;
  const Vec3<V> v = j.v - b.v, a = j.vd - b.vd;
  if (rows.positions == 3) {
    const auto set = [](auto* to, const auto& from) {
      to[0] = from.x;
      to[1] = from.y;
      to[2] = from.z;
    };
    set(violation.Phi, d);
    set(violation.Phi_d, v);
    set(violation.Phi_dd, a);
  } else {
    const Vec3<V> seen = v - cross(b.w, d);  // by the bearing
    const Vec3<V> changing = a - cross(b.wd, d) - cross(b.w, v);
    const auto set_along = [&](int at, const Vec3<P>& u) {
      violation.Phi[at] = dot(u, d);
      violation.Phi_d[at] = dot(u, seen);
      violation.Phi_dd[at] = dot(cross(b.w, u), seen) + dot(u, changing);
    };
    set_along(0, b.R.x);
    set_along(1, b.R.y);
  }
  const Vec3<V> w = j.w - b.w;
  const auto set_axis = [&](int k, const Vec3<P>& z, const Vec3<P>& x) {
    const int at = rows.positions + k;
    const Vec3<P> x_z = cross(x, z);
    violation.turn[k] = x_z;
    violation.Phi[at] = dot(z, x);
    violation.Phi_d[at] = dot(w, x_z);
    violation.Phi_dd[at] = dot(j.wd - b.wd, x_z) + dot(w, cross(cross(j.w, x), z) + cross(x, cross(b.w, z)));
  };
  if (rows.axes > 0) set_axis(0, b.R.z, j.R.x);
  if (rows.axes > 1) set_axis(1, b.R.z, j.R.y);
  if (rows.axes > 2) set_axis(2, b.R.x, j.R.y);
  return violation;
}

/// Force on the journal, and moment about the point where it acts, of an ideal joint's multipliers.
template <typename T>
struct JointReaction {
  Vec3<T> force, moment;
};

/// @param R_b  of the bearing  @tparam T  a number, or several side by side
template <typename P, typename V, typename T>
[[nodiscard]] RPSUP_INLINE JointReaction<Mixed<T, P>> calc_joint_reaction(const CutRows& rows, const JointViolation<P, V>& violation,
                                                                          const Mat3<P>& R_b, const T* multipliers) {
  JointReaction<Mixed<T, P>> reaction;
  if (rows.positions == 3) {
    reaction.force.x += multipliers[0];
    reaction.force.y += multipliers[1];
    reaction.force.z += multipliers[2];
  } else {
    reaction.force = multipliers[0] * R_b.x + multipliers[1] * R_b.y;
  }
  for (int k = 0; k < rows.axes; ++k) reaction.moment += multipliers[rows.positions + k] * violation.turn[k];
  return reaction;
}

/// The other way round: takes what a joint's rows make of accelerations from `rest`.
/// @param angular, linear  accelerations of the journal, and of its point where the reaction acts, less those of the bearing and its point
template <typename T>
RPSUP_INLINE void subtract_joint_answer(const CutRows& rows, const JointViolation<double, double>& violation, const Mat3<double>& R_b,
                                        const Vec3<T>& angular, const Vec3<T>& linear, T* rest) {
  if (rows.positions == 3) {
    rest[0] -= linear.x;
    rest[1] -= linear.y;
    rest[2] -= linear.z;
  } else {
    rest[0] -= dot(R_b.x, linear);
    rest[1] -= dot(R_b.y, linear);
  }
  for (int k = 0; k < rows.axes; ++k) rest[rows.positions + k] -= dot(violation.turn[k], angular);
}

/// Where the force on the bearing acts: at its own centre, or where the journal has slid to.
template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE const Vec3<P>& bearing_point(const CutRows& rows, const Frame<P, V>& b, const Frame<P, V>& j) {
  return rows.positions == 3 ? b.p : j.p;
}

/// Adds to the rows what the chain from the ground to a joint's body does to a point p of it, and to the journal's axes seen along the
/// bearing's.
RPSUP_INLINE void add_chain(const TreeModel& model, const Frame<double, double>* frames, const JointAxes* axes, const TreeCutJoint& joint, int last,
                            const Vec3<double>& p, const Mat3<double>& R_b, const JointViolation<double, double>& violation, double sign,
                            ConstraintEntries& entries) {
  double* row[6];
  for (int k = 0; k < joint.rows.count(); ++k) row[k] = entries.row(joint.first_row + k);
  for (int i = last; i >= 0; i = model.joints[static_cast<std::size_t>(i)].parent) {
    const TreeJoint& carrier = model.joints[static_cast<std::size_t>(i)];
    const bool rotates = carrier.rotates();
    const Vec3<double> arm = p - frames[i].p;
    for (int k = 0; k < carrier.count(); ++k) {
      const Vec3<double> axis = sign * axes[i].axis[k];
      const Vec3<double> v = rotates ? cross(axis, arm) : axis;
      const int at = carrier.first + k;
      if (joint.rows.positions == 3) {
        row[0][at] += v.x;
        row[1][at] += v.y;
        row[2][at] += v.z;
      } else {
        row[0][at] += dot(v, R_b.x);
        row[1][at] += dot(v, R_b.y);
      }
      if (!rotates) continue;
      for (int turn = 0; turn < joint.rows.axes; ++turn) row[joint.rows.positions + turn][at] += dot(axis, violation.turn[turn]);
    }
  }
}

/// @param violation  of the joint
template <typename Rows>
RPSUP_INLINE void set_joint_rows(const CutRows& of, int first, const JointViolation<double, double>& violation, ConstraintRows<Rows>& rows) {
  for (int r = 0; r < of.count(); ++r) {
    const auto row = static_cast<std::size_t>(first + r);
    rows.Phi[row] = violation.Phi[r];
    rows.Phi_d[row] = violation.Phi_d[r];
    rows.bias[row] = violation.Phi_dd[r];
  }
}

/// @param b, j  bearing and journal  @param violation  of the joint
RPSUP_INLINE void calc_joint_entries(const TreeModel& model, const TreeCutJoint& joint, const Frame<double, double>* frames, const JointAxes* axes,
                                     const Frame<double, double>& b, const Frame<double, double>& j,
                                     const JointViolation<double, double>& violation, ConstraintEntries& entries) {
  for (int r = 0; r < joint.rows.count(); ++r) {
    double* row = entries.row(joint.first_row + r);
    for (int i = 0; i < entries.coordinates; ++i) row[i] = 0.0;
  }
  add_chain(model, frames, axes, joint, joint.journal_joint, j.p, b.R, violation, 1.0, entries);
  add_chain(model, frames, axes, joint, joint.bearing_joint, bearing_point(joint.rows, b, j), b.R, violation, -1.0, entries);
}

/// What a coupling's row is of the coordinates, and its derivatives by time of theirs.
[[nodiscard]] RPSUP_INLINE double calc_coupling_row(const Coupling& coupling, const double* q) {
  return q[coupling.coordinate] - coupling.ratio * q[coupling.follows];
}

/// @param q, qd, qdd  one entry a coordinate; qdd of driven ones only
template <typename Rows>
RPSUP_INLINE void calc_coupling_rows(const TreeModel& model, const double* q, const double* qd, const double* qdd, ConstraintRows<Rows>& rows) {
  const auto given = [&](int coordinate) RPSUP_INLINE_LAMBDA { return model.is_eliminated(coordinate) ? qdd[coordinate] : 0.0; };
  for (std::size_t k = 0; k < model.couplings.size(); ++k) {
    const Coupling& coupling = model.couplings[k];
    const std::size_t row = static_cast<std::size_t>(model.first_coupling_row) + k;
    rows.Phi[row] = calc_coupling_row(coupling, q);
    rows.Phi_d[row] = calc_coupling_row(coupling, qd);
    rows.bias[row] = given(coupling.coordinate) - coupling.ratio * given(coupling.follows);
  }
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
