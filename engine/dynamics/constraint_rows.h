#pragma once

#include <cmath>

#include "engine/kinematics/frame_recursion.h"
#include "engine/kinematics/tree_model.h"
#include "engine/math/buffer.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Rows of the constraints Phi(q, t) = 0: five for each ideal cut joint, one for each drive that is enforced by a multiplier.
///
///     p_J - p_B = 0 (3),  z_b . x_j = 0,  z_b . y_j = 0,    q_d - q_d(t) = 0
///
/// The multipliers are the forces that the rows exert: of an ideal joint on its journal (in W), of a drive on its coordinate.
struct ConstraintRows {
  explicit ConstraintRows(const TreeModel& model)
      : count(model.rows),
        coordinates(model.coordinates),
        Phi(static_cast<std::size_t>(count)),
        Phi_d(static_cast<std::size_t>(count)),
        bias(static_cast<std::size_t>(count)),
        Phi_q(static_cast<std::size_t>(count * coordinates)) {}

  [[nodiscard]] RPSUP_INLINE double* row(int r) { return Phi_q.data() + r * coordinates; }
  [[nodiscard]] RPSUP_INLINE const double* row(int r) const { return Phi_q.data() + r * coordinates; }

  int count, coordinates;
  Buffer<double> Phi;    ///< [m] and [1]
  Buffer<double> Phi_d;  ///< first derivative by time
  Buffer<double> bias;   ///< second derivative without the unknown accelerations
  Buffer<double> Phi_q;  ///< row after row, one entry a coordinate
};

/// What an ideal joint's five rows come to.
template <typename P, typename V>
struct JointViolation {
  P Phi[5];
  V Phi_d[5], Phi_dd[5];
  Vec3<P> x_z, y_z;  ///< axes of its fourth and fifth multipliers' moments on the journal: those of {j} across the bearing's
};

/// @param b, j  bearing and journal with their accelerations
template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE JointViolation<P, V> calc_joint_violation(const Frame<P, V>& b, const Frame<P, V>& j) {
  JointViolation<P, V> violation;
  const auto set = [](auto* to, const auto& v) {
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
  };
  set(violation.Phi, j.p - b.p);
  set(violation.Phi_d, j.v - b.v);
  set(violation.Phi_dd, j.vd - b.vd);
  const Vec3<P>& z = b.R.z;
  const Vec3<V> w = j.w - b.w;
  const auto set_axis = [&](int at, const Vec3<P>& x, Vec3<P>& x_z) {
    x_z = cross(x, z);
    violation.Phi[at] = dot(z, x);
    violation.Phi_d[at] = dot(w, x_z);
    violation.Phi_dd[at] = dot(j.wd - b.wd, x_z) + dot(w, cross(cross(j.w, x), z) + cross(x, cross(b.w, z)));
  };
  set_axis(3, j.R.x, violation.x_z);
  set_axis(4, j.R.y, violation.y_z);
  return violation;
}

/// Adds to the rows what the chain from the ground to a joint's body does to a point p of it, and to the journal's axes seen along the
/// bearing's.
RPSUP_INLINE void add_chain(const TreeModel& model, const Frame<double, double>* frames, const JointAxes* axes, int last, const Vec3<double>& p,
                            const JointViolation<double, double>& violation, double sign, int first_row, ConstraintRows& rows) {
  for (int i = last; i >= 0; i = model.joints[static_cast<std::size_t>(i)].parent) {
    const TreeJoint& joint = model.joints[static_cast<std::size_t>(i)];
    const bool rotates = joint.rotates();
    const Vec3<double> arm = p - frames[i].p;
    for (int k = 0; k < joint.count(); ++k) {
      const Vec3<double> axis = sign * axes[i].axis[k];
      const Vec3<double> v = rotates ? cross(axis, arm) : axis;
      const int at = joint.first + k;
      rows.row(first_row)[at] += v.x;
      rows.row(first_row + 1)[at] += v.y;
      rows.row(first_row + 2)[at] += v.z;
      if (!rotates) continue;
      rows.row(first_row + 3)[at] += dot(axis, violation.x_z);
      rows.row(first_row + 4)[at] += dot(axis, violation.y_z);
    }
  }
}

/// @param b, j  bearing and journal with their accelerations
RPSUP_INLINE void calc_joint_rows(const TreeModel& model, const TreeCutJoint& joint, const Frame<double, double>* frames, const JointAxes* axes,
                                  const Frame<double, double>& b, const Frame<double, double>& j, ConstraintRows& rows) {
  const int first = joint.first_row;
  const JointViolation<double, double> violation = calc_joint_violation(b, j);
  for (int r = 0; r < 5; ++r) {
    const auto row = static_cast<std::size_t>(first + r);
    rows.Phi[row] = violation.Phi[r];
    rows.Phi_d[row] = violation.Phi_d[r];
    rows.bias[row] = violation.Phi_dd[r];
  }
  for (int i = 0; i < 5 * rows.coordinates; ++i) rows.row(first)[i] = 0.0;
  add_chain(model, frames, axes, joint.journal_joint, j.p, violation, 1.0, first, rows);
  add_chain(model, frames, axes, joint.bearing_joint, b.p, violation, -1.0, first, rows);
}

/// The lower triangle of a symmetric matrix, factored in place: L L^T. False if a pivot is below `singular` of its diagonal entry.
[[nodiscard]] RPSUP_INLINE bool factor_cholesky(int n, double singular, double* A) {
  for (int c = 0; c < n; ++c) {
    double pivot = A[c * n + c];
    for (int k = 0; k < c; ++k) pivot -= A[c * n + k] * A[c * n + k];
    if (!(pivot > singular * A[c * n + c])) return false;
    const double inverse = 1.0 / std::sqrt(pivot);
    A[c * n + c] = inverse;  // what solving needs
    for (int r = c + 1; r < n; ++r) {
      double sum = A[r * n + c];
      for (int k = 0; k < c; ++k) sum -= A[r * n + k] * A[c * n + k];
      A[r * n + c] = sum * inverse;
    }
  }
  return true;
}

/// x <- (L L^T)^-1 x. @tparam T  a number, or several side by side
template <typename T>
RPSUP_INLINE void solve_cholesky(int n, const double* L, T* x) {
  for (int r = 0; r < n; ++r) {
    for (int k = 0; k < r; ++k) x[r] -= L[r * n + k] * x[k];
    x[r] = L[r * n + r] * x[r];
  }
  for (int r = n - 1; r >= 0; --r) {
    for (int k = r + 1; k < n; ++k) x[r] -= L[k * n + r] * x[k];
    x[r] = L[r * n + r] * x[r];
  }
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
