// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "engine/kinematics/frame_recursion.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/buffer.h"
#include "engine/model/drive_law.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Residuals of the constraints Phi(q, t) = 0, row by row: the rows of each ideal cut joint (see CutRows),
/// then a row for each coupling, then a row for each drive that is enforced by a multiplier.
///
///     cut joint   p_J - p_B = 0 (three rows), or x_b . (p_J - p_B) = 0 and y_b . (p_J - p_B) = 0;
///                 the first rows.axes of z_b . x_j = 0, z_b . y_j = 0, x_b . y_j = 0
///     coupling    q_a - ratio q_b = 0
///     drive       q_d - q_d(t) = 0
///
/// A multiplier is the force of its row: that of an ideal joint acts on the journal (in W), that of a drive
/// on its coordinate.
/// @tparam Rows  an array of one number a row: Buffer<double>, or FixedBuffer where the number of rows is
/// known at compile time
template <typename Rows>
struct ConstraintResiduals {
  RPSUP_INLINE explicit ConstraintResiduals(const TreeModel& model)
      : Phi(model.rows), Phi_d(Phi.size()), bias(Phi.size()) {}

  Rows Phi;    ///< [m] and [1]
  Rows Phi_d;  ///< first derivative by time
  Rows bias;   ///< second derivative by time but for the unknown accelerations: Phi_dd = Phi_q qdd + bias
};

/// Jacobian Phi_q of the constraints, row by row, one entry a coordinate. The rows of couplings and drives
/// are constant.
struct ConstraintJacobian {
  explicit ConstraintJacobian(const TreeModel& model)
      : count(model.rows),
        coordinates(model.coordinates),
        Phi_q(count * coordinates) {
    for (std::size_t k = 0; k < model.couplings.size(); ++k) {
      double* entries = row(model.first_coupling_row + static_cast<int>(k));
      entries[model.couplings[k].coordinate] = 1.0;
      entries[model.couplings[k].follows] = -model.couplings[k].ratio;
    }
    if (!model.drive_rows) return;
    for (std::size_t k = 0; k < model.drives.size(); ++k)
      row(model.first_drive_row + static_cast<int>(k))[model.drives[k]] = 1.0;
  }

  [[nodiscard]] RPSUP_INLINE double* row(int r) { return Phi_q.data() + r * coordinates; }
  [[nodiscard]] RPSUP_INLINE const double* row(int r) const { return Phi_q.data() + r * coordinates; }

  int count, coordinates;
  Buffer<double> Phi_q;
};

/// Residuals of the rows of one ideal cut joint, and their derivatives by time.
template <typename P, typename V>
struct JointResidual {
  P Phi[6];
  V Phi_d[6], Phi_dd[6];
  Vec3<P> moment_axis[3];  ///< of each row of axes: moment on the journal by a unit multiplier
};

/// @param b, j  frames of bearing and journal; Phi_dd is of their accelerations wd, vd
template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE JointResidual<P, V> calc_joint_residual(const CutRows& rows, const Frame<P, V>& b,
                                                                   const Frame<P, V>& j) {
  JointResidual<P, V> residual;
  const Vec3<P> d = j.p - b.p;
  const Vec3<V> v = j.v - b.v, a = j.vd - b.vd;
  if (rows.positions == 3) {
    const auto set = [](auto* to, const auto& from) {
      to[0] = from.x;
      to[1] = from.y;
      to[2] = from.z;
    };
    set(residual.Phi, d);
    set(residual.Phi_d, v);
    set(residual.Phi_dd, a);
  } else {
    const Vec3<V> v_b = v - cross(b.w, d);  // the rate of d in the bearing's frame
    const Vec3<V> v_b_d = a - cross(b.wd, d) - cross(b.w, v);
    const auto set_along = [&](int at, const Vec3<P>& u) {
      residual.Phi[at] = dot(u, d);
      residual.Phi_d[at] = dot(u, v_b);
      residual.Phi_dd[at] = dot(cross(b.w, u), v_b) + dot(u, v_b_d);
    };
    set_along(0, b.R.x);
    set_along(1, b.R.y);
  }
  const Vec3<V> w = j.w - b.w;
  const auto set_axis = [&](int k, const Vec3<P>& z, const Vec3<P>& x) {
    const int at = rows.positions + k;
    const Vec3<P> x_z = cross(x, z);
    residual.moment_axis[k] = x_z;
    residual.Phi[at] = dot(z, x);
    residual.Phi_d[at] = dot(w, x_z);
    residual.Phi_dd[at] = dot(j.wd - b.wd, x_z) + dot(w, cross(cross(j.w, x), z) + cross(x, cross(b.w, z)));
  };
  if (rows.axes > 0) set_axis(0, b.R.z, j.R.x);
  if (rows.axes > 1) set_axis(1, b.R.z, j.R.y);
  if (rows.axes > 2) set_axis(2, b.R.x, j.R.y);
  return residual;
}

/// Reaction of an ideal joint: force on the journal, and moment about the point where the force acts.
template <typename T>
struct JointReaction {
  Vec3<T> force, moment;
};

/// The reaction of a joint's multipliers. @param R_b  of the bearing  @tparam T  a number, or a pack
template <typename P, typename V, typename T>
[[nodiscard]] RPSUP_INLINE JointReaction<Mixed<T, P>> calc_joint_reaction(const CutRows& rows,
                                                                          const JointResidual<P, V>& residual,
                                                                          const Mat3<P>& R_b,
                                                                          const T* multipliers) {
  JointReaction<Mixed<T, P>> reaction;
  if (rows.positions == 3) {
    reaction.force.x += multipliers[0];
    reaction.force.y += multipliers[1];
    reaction.force.z += multipliers[2];
  } else {
    reaction.force = multipliers[0] * R_b.x + multipliers[1] * R_b.y;
  }
  for (int k = 0; k < rows.axes; ++k)
    reaction.moment += multipliers[rows.positions + k] * residual.moment_axis[k];
  return reaction;
}

/// The transpose of calc_joint_reaction(): r <- r - Phi_q qdd, for the rows of a joint.
/// @param angular, linear  accelerations of the journal, and of the point where the reaction acts on it, less
/// those of the bearing
/// @param r  of the joint's rows
template <typename T>
RPSUP_INLINE void subtract_joint_acceleration(const CutRows& rows,
                                              const JointResidual<double, double>& residual,
                                              const Mat3<double>& R_b, const Vec3<T>& angular,
                                              const Vec3<T>& linear, T* r) {
  if (rows.positions == 3) {
    r[0] -= linear.x;
    r[1] -= linear.y;
    r[2] -= linear.z;
  } else {
    r[0] -= dot(R_b.x, linear);
    r[1] -= dot(R_b.y, linear);
  }
  for (int k = 0; k < rows.axes; ++k) r[rows.positions + k] -= dot(residual.moment_axis[k], angular);
}

/// Point where the reaction acts on the bearing: the bearing's centre, or the journal's where it may slide.
template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE const Vec3<P>& bearing_point(const CutRows& rows, const Frame<P, V>& b,
                                                        const Frame<P, V>& j) {
  return rows.positions == 3 ? b.p : j.p;
}

/// Adds the columns of a chain to a joint's rows of Phi_q: the chain's coordinates move the point p of its
/// last body, and rotate it.
/// @param last  joint of the chain's last body  @param sign  1 for the journal's chain, -1 for the bearing's
RPSUP_INLINE void add_chain_jacobian(const TreeModel& model, const Frame<double, double>* frames,
                                     const JointAxes* axes, const TreeCutJoint& joint, int last,
                                     const Vec3<double>& p, const Mat3<double>& R_b,
                                     const JointResidual<double, double>& residual, double sign,
                                     ConstraintJacobian& entries) {
  double* row[6];
  for (int k = 0; k < joint.rows.count(); ++k) row[k] = entries.row(joint.first_row + k);
  for (int i = last; i >= 0; i = model.joints[i].parent) {
    const TreeJoint& carrier = model.joints[i];
    const bool rotates = carrier.rotates();
    const Vec3<double> offset = p - frames[i].p;
    for (int k = 0; k < carrier.count(); ++k) {
      const Vec3<double> axis = sign * axes[i].axis[k];
      const Vec3<double> v = rotates ? cross(axis, offset) : axis;
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
      for (int m = 0; m < joint.rows.axes; ++m)
        row[joint.rows.positions + m][at] += dot(axis, residual.moment_axis[m]);
    }
  }
}

/// Copies the residuals of a joint into its rows.
template <typename Rows>
RPSUP_INLINE void set_joint_residual(const CutRows& of, int first,
                                     const JointResidual<double, double>& residual,
                                     ConstraintResiduals<Rows>& rows) {
  for (int r = 0; r < of.count(); ++r) {
    const int row = first + r;
    rows.Phi[row] = residual.Phi[r];
    rows.Phi_d[row] = residual.Phi_d[r];
    rows.bias[row] = residual.Phi_dd[r];
  }
}

/// Computes the rows of Phi_q of a joint. @param b, j  frames of bearing and journal
RPSUP_INLINE void calc_joint_jacobian(const TreeModel& model, const TreeCutJoint& joint,
                                      const Frame<double, double>* frames, const JointAxes* axes,
                                      const Frame<double, double>& b, const Frame<double, double>& j,
                                      const JointResidual<double, double>& residual,
                                      ConstraintJacobian& entries) {
  for (int r = 0; r < joint.rows.count(); ++r) {
    double* row = entries.row(joint.first_row + r);
    for (int i = 0; i < entries.coordinates; ++i) row[i] = 0.0;
  }
  add_chain_jacobian(model, frames, axes, joint, joint.journal_joint, j.p, b.R, residual, 1.0, entries);
  add_chain_jacobian(model, frames, axes, joint, joint.bearing_joint, bearing_point(joint.rows, b, j), b.R,
                     residual, -1.0, entries);
}

/// q_a - ratio q_b. With rates or accelerations in the place of q: the row's derivatives by time.
[[nodiscard]] RPSUP_INLINE double calc_coupling_residual(const Coupling& coupling, const double* q) {
  return q[coupling.coordinate] - coupling.ratio * q[coupling.follows];
}

/// @param q, qd, qdd  one entry a coordinate; qdd of driven ones only
template <typename Rows>
RPSUP_INLINE void calc_coupling_residuals(const TreeModel& model, const double* q, const double* qd,
                                          const double* qdd, ConstraintResiduals<Rows>& rows) {
  const auto given = [&](int coordinate) RPSUP_INLINE_LAMBDA {
    return model.is_eliminated(coordinate) ? qdd[coordinate] : 0.0;
  };
  for (std::size_t k = 0; k < model.couplings.size(); ++k) {
    const Coupling& coupling = model.couplings[k];
    const std::size_t row = model.first_coupling_row + k;
    rows.Phi[row] = calc_coupling_residual(coupling, q);
    rows.Phi_d[row] = calc_coupling_residual(coupling, qd);
    rows.bias[row] = given(coupling.coordinate) - coupling.ratio * given(coupling.follows);
  }
}

/// Residuals of the drives that are enforced by multipliers, if any.
template <typename Rows>
RPSUP_INLINE void calc_drive_residuals(const TreeModel& model, const double* q, const double* qd,
                                       const DrivenMotion* drives, ConstraintResiduals<Rows>& rows) {
  if (!model.drive_rows) return;
  for (std::size_t k = 0; k < model.drives.size(); ++k) {
    const int d = model.drives[k];
    const std::size_t row = model.first_drive_row + k;
    rows.Phi[row] = q[d] - drives[k].q;
    rows.Phi_d[row] = qd[d] - drives[k].qd;
    rows.bias[row] = -drives[k].qdd;
  }
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
