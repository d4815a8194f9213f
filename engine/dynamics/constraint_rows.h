#pragma once

#include <cmath>

#include "engine/dynamics/tree_model.h"
#include "engine/kinematics/frame_recursion.h"
#include "engine/math/buffer.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Rows of the constraints Phi(q, t) = 0: five for each ideal cut joint, one for each drive that is enforced by a multiplier.
///
///     p_J - p_B = 0 (3),  z_b . x_j = 0,  z_b . y_j = 0,    q_d - q_d(t) = 0
///
/// The multipliers are the forces that the rows exert: of an ideal joint on its journal (in W), of a drive on its coordinate.
template <typename P, typename V>
struct ConstraintRows {
  explicit ConstraintRows(const TreeModel& model)
      : count(model.rows),
        coordinates(model.coordinates),
        Phi(static_cast<std::size_t>(count)),
        Phi_d(static_cast<std::size_t>(count)),
        bias(static_cast<std::size_t>(count)),
        Phi_q(static_cast<std::size_t>(count * coordinates)) {}

  [[nodiscard]] RPSUP_INLINE P* row(int r) { return Phi_q.data() + r * coordinates; }
  [[nodiscard]] RPSUP_INLINE const P* row(int r) const { return Phi_q.data() + r * coordinates; }

  int count, coordinates;
  Buffer<P> Phi;    ///< [m] and [1]
  Buffer<V> Phi_d;  ///< first derivative by time
  Buffer<V> bias;   ///< second derivative without the unknown accelerations
  Buffer<P> Phi_q;  ///< row after row, one entry a coordinate
};

/// Adds to the rows what the chain from the ground to a joint's body does to a point p of it, and to the journal's axes seen along the
/// bearing's.
template <typename P, typename V>
RPSUP_INLINE void add_chain(const TreeModel& model, const Frame<P, V>* frames, const JointAxes<P>* axes, int last, const Vec3<P>& p,
                            const Vec3<P>& x_z, const Vec3<P>& y_z, double sign, int first_row, ConstraintRows<P, V>& rows) {
  for (int i = last; i >= 0; i = model.joints[static_cast<std::size_t>(i)].parent) {
    const TreeJoint& joint = model.joints[static_cast<std::size_t>(i)];
    const bool rotates = joint.rotates();
    const Vec3<P> arm = p - frames[i].p;
    for (int k = 0; k < joint.count(); ++k) {
      const Vec3<P> axis = sign * axes[i].axis[k];
      const Vec3<P> v = rotates ? cross(axis, arm) : axis;
      const int at = joint.first + k;
      rows.row(first_row)[at] += v.x;
      rows.row(first_row + 1)[at] += v.y;
      rows.row(first_row + 2)[at] += v.z;
      if (!rotates) continue;
      rows.row(first_row + 3)[at] += dot(axis, x_z);
      rows.row(first_row + 4)[at] += dot(axis, y_z);
    }
  }
}

/// @param b, j  bearing and journal with their accelerations
template <typename P, typename V>
RPSUP_INLINE void calc_joint_rows(const TreeModel& model, const TreeCutJoint& joint, const Frame<P, V>* frames, const JointAxes<P>* axes,
                                  const Frame<P, V>& b, const Frame<P, V>& j, ConstraintRows<P, V>& rows) {
  const int first = joint.first_row;
  const auto k = static_cast<std::size_t>(first);
  const auto set = [&](auto& to, const auto& v) {
    to[k] = v.x;
    to[k + 1] = v.y;
    to[k + 2] = v.z;
  };
  set(rows.Phi, j.p - b.p);
  set(rows.Phi_d, j.v - b.v);
  set(rows.bias, j.vd - b.vd);
  const Vec3<P>& z = b.R.z;
  const Vec3<V> w = j.w - b.w;
  const auto set_axis = [&](std::size_t at, const Vec3<P>& x) {
    const Vec3<P> x_z = cross(x, z);
    rows.Phi[at] = dot(z, x);
    rows.Phi_d[at] = dot(w, x_z);
    rows.bias[at] = dot(j.wd - b.wd, x_z) + dot(w, cross(cross(j.w, x), z) + cross(x, cross(b.w, z)));
  };
  set_axis(k + 3, j.R.x);
  set_axis(k + 4, j.R.y);
  for (int i = 0; i < 5 * rows.coordinates; ++i) rows.row(first)[i] = P(0.0);
  const Vec3<P> x_z = cross(j.R.x, z);
  const Vec3<P> y_z = cross(j.R.y, z);
  add_chain(model, frames, axes, joint.journal_joint, j.p, x_z, y_z, 1.0, first, rows);
  add_chain(model, frames, axes, joint.bearing_joint, b.p, x_z, y_z, -1.0, first, rows);
}

/// The lower triangle of a symmetric matrix, factored in place: L L^T. False if a pivot is below `singular` of its diagonal entry.
template <typename P>
[[nodiscard]] RPSUP_INLINE bool factor_cholesky(int n, double singular, P* A) {
  for (int c = 0; c < n; ++c) {
    P pivot = A[c * n + c];
    for (int k = 0; k < c; ++k) pivot -= A[c * n + k] * A[c * n + k];
    if (!(value_of(pivot) > singular * value_of(A[c * n + c]))) return false;
    const P inverse = 1.0 / sqrt(pivot);
    A[c * n + c] = inverse;  // what solving needs
    for (int r = c + 1; r < n; ++r) {
      P sum = A[r * n + c];
      for (int k = 0; k < c; ++k) sum -= A[r * n + k] * A[c * n + k];
      A[r * n + c] = sum * inverse;
    }
  }
  return true;
}

template <typename P, typename V>
RPSUP_INLINE void solve_cholesky(int n, const P* L, V* x) {
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
