// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/dynamics/constraint_rows.h"
#include "engine/math/buffer.h"
#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

constexpr double kSingularPivot = 1e-12;  ///< a pivot so small, of its diagonal entry: the loop stands at the end of its reach

/// The lower triangle of a symmetric matrix, factored in place: L L^T. False if a pivot is below `singular` of its diagonal entry.
/// Without loops where n is known: they take as long as what they repeat.
/// @param stride  from row to row
[[nodiscard]] RPSUP_INLINE bool factor_cholesky(int n, int stride, double singular, double* A) {
#pragma GCC unroll 8
  for (int c = 0; c < n; ++c) {
    double* row_c = A + c * stride;
    double pivot = row_c[c];
#pragma GCC unroll 8
    for (int k = 0; k < c; ++k) pivot -= row_c[k] * row_c[k];
    if (!(pivot > singular * row_c[c])) return false;
    const double inverse = 1.0 / std::sqrt(pivot);
    row_c[c] = inverse;  // what solving needs
#pragma GCC unroll 8
    for (int r = c + 1; r < n; ++r) {
      double* row = A + r * stride;
      double sum = row[c];
#pragma GCC unroll 8
      for (int k = 0; k < c; ++k) sum -= row[k] * row_c[k];
      row[c] = sum * inverse;
    }
  }
  return true;
}

/// x <- (L L^T)^-1 x. @tparam T  a number, or several side by side
template <typename T>
RPSUP_INLINE void solve_cholesky(int n, int stride, const double* L, T* x) {
#pragma GCC unroll 8
  for (int r = 0; r < n; ++r) {
#pragma GCC unroll 8
    for (int k = 0; k < r; ++k) x[r] -= L[r * stride + k] * x[k];
    x[r] = L[r * stride + r] * x[r];
  }
#pragma GCC unroll 8
  for (int r = n - 1; r >= 0; --r) {
#pragma GCC unroll 8
    for (int k = r + 1; k < n; ++k) x[r] -= L[k * stride + r] * x[k];
    x[r] = L[r * stride + r] * x[r];
  }
}

/// Phi_q M^-1 Phi_q^T of so many constraints that do not depend on each other.
template <int n>
class IndependentMatrix {
 public:
  RPSUP_INLINE explicit IndependentMatrix(const TreeModel&) {}

  /// Room for solve(): needs none.
  template <typename T>
  struct Scratch {
    RPSUP_INLINE explicit Scratch(const TreeModel&) {}
  };

  [[nodiscard]] static constexpr int acting_count() { return n; }
  [[nodiscard]] static constexpr int acting(int k) { return k; }

  /// Visits the places -1, -1 + width and so on of columns that are set together. That at -1 is none of the matrix.
  template <int width, typename Visit>
  RPSUP_INLINE static void each_place(const Visit& visit) {
    [&]<int... group>(std::integer_sequence<int, group...>) RPSUP_INLINE_LAMBDA {
      (visit(std::integral_constant<int, group * width - 1>()), ...);
    }(std::make_integer_sequence<int, (n + width) / width>());
  }
  /// Of a row the entries from a place on, one a lane.
  RPSUP_INLINE void set(int k, int place, const Directions& entries) { entries.store(A_ + k * kStride + 1 + place); }

  [[nodiscard]] RPSUP_INLINE bool factor() { return factor_cholesky(n, kStride, kSingularPivot, A_ + 1); }
  template <typename T>
  RPSUP_INLINE void solve(T* x, Scratch<T>&) const {
    solve_cholesky(n, kStride, A_ + 1, x);
  }

 private:
  static constexpr int kStride = (n + Directions::kCount) / Directions::kCount * Directions::kCount;
  double A_[n * kStride];  ///< each row behind a number that is none of the matrix
};

/// A = Phi_q M^-1 Phi_q^T, of which the multipliers are found.
///
/// Where constraints depend on each other (Mechanism::least_multipliers) many multipliers do the same. Of these the least are taken: those
/// of the least sum of (lambda_r / w_r)^2, where w counts the force of a joint, and its moment, each by what it moves. They are the limit, for
/// a vanishing e, of
///
///     (S + e 1) x = w b,  lambda = w x,   S = w A w,  w_r = 1 / sqrt(largest A_ss of the rows s of the same joint and kind)
///
/// and for a small e repeating with what is left of b gets there. So a mechanism also passes the positions in which it gains a freedom for
/// an instant: its rows, all of a joint measured alike, fade there. Rows that move nothing at all, as those out of the plane of a flat
/// mechanism, have no part in it.
class MultiplierMatrix {
 public:
  explicit MultiplierMatrix(const TreeModel& model)
      : count_(model.rows), dependent_(model.least_multipliers), acting_count_(count_), acting_(room(count_)), A_(room(count_ * count_)),
        S_(room(dependent_ ? count_ * count_ : 0)), weight_(room(dependent_ ? count_ : 0)), block_(room(count_)), largest_(room(count_)) {
    for (int r = 0; r < count_; ++r) acting_[room(r)] = block_[room(r)] = r;
    for (const TreeCutJoint& joint : model.cut_joints) {
      if (joint.first_row < 0) continue;
      for (int k = 0; k < joint.rows.count(); ++k)
        block_[room(joint.first_row + k)] = joint.first_row + (k < joint.rows.positions ? 0 : joint.rows.positions);
    }
  }

  /// Room for solve().
  template <typename T>
  struct Scratch {
    explicit Scratch(const TreeModel& model) : known(room(model.rows)), rest(room(model.rows)), solution(room(model.rows)) {}
    Buffer<T> known, rest, solution;
  };

  /// Where rows may depend on each other: finds out which have a part.
  RPSUP_INLINE void start(const ConstraintEntries& entries, const std::vector<int>& free) {
    constexpr double kIdle = 1e-10;  // of a row's entries, [m/rad] or [1]
    acting_count_ = 0;
    for (int r = 0; r < count_; ++r) {
      double largest = 0.0;
      for (const int i : free) largest = std::max(largest, std::abs(entries.row(r)[i]));
      if (largest > kIdle) acting_[room(acting_count_++)] = r;
    }
  }

  /// Rows that have a part: their number, and which one the k-th of them is.
  [[nodiscard]] RPSUP_INLINE int acting_count() const { return acting_count_; }
  [[nodiscard]] RPSUP_INLINE int acting(int k) const { return acting_[room(k)]; }

  /// As IndependentMatrix has them, of the rows that have a part.
  template <int width, typename Visit>
  RPSUP_INLINE void each_place(const Visit& visit) const {
    for (int place = -1; place < acting_count_; place += width) visit(place);
  }
  RPSUP_INLINE void set(int k, int place, const Directions& entries) {
    double numbers[Directions::kCount];
    entries.store(numbers);
    for (int l = std::max(place, 0); l < std::min(place + Directions::kCount, k + 1); ++l) entry(k, l) = numbers[l - place];
  }

  /// False if the matrix is singular, and no dependence is expected.
  [[nodiscard]] RPSUP_INLINE bool factor() {
    if (dependent_) scale();
    return factor_cholesky(acting_count_, acting_count_, dependent_ ? 0.0 : kSingularPivot, A_.data());
  }

  /// x <- A^-1 x. @tparam T  a number, or several side by side
  template <typename T>
  RPSUP_INLINE void solve(T* x, Scratch<T>& scratch) const {
    if (!dependent_) return solve_cholesky(count_, count_, A_.data(), x);
    const int n = acting_count_;
    T* known = scratch.known.data();
    const T* solution = scratch.solution.data();
    for (int k = 0; k < n; ++k) known[k] = weight_[room(k)] * x[acting(k)];
    // What contradicts itself in `known`, be it a rounding, would come out times 1 / e: it is what S makes nothing of.
    repeat_solve(scratch);
    multiply(solution, known);
    repeat_solve(scratch);
    for (int r = 0; r < count_; ++r) x[r] = {};
    for (int k = 0; k < n; ++k) x[acting(k)] = weight_[room(k)] * solution[k];
  }

 private:
  /// scratch.solution <- S^-1 scratch.known, by (S + e 1)^-1 again and again for what is left.
  template <typename T>
  RPSUP_INLINE void repeat_solve(Scratch<T>& scratch) const {
    constexpr int kRepeats = 3;
    const int n = acting_count_;
    T* rest = scratch.rest.data();
    T* solution = scratch.solution.data();
    for (int k = 0; k < n; ++k) {
      rest[k] = scratch.known[room(k)];
      solution[k] = {};
    }
    for (int repeat = 0; repeat <= kRepeats; ++repeat) {
      solve_cholesky(n, n, A_.data(), rest);
      for (int k = 0; k < n; ++k) solution[k] += rest[k];
      if (repeat == kRepeats) break;
      multiply(solution, rest);
      for (int k = 0; k < n; ++k) rest[k] = scratch.known[room(k)] - rest[k];
    }
  }

  /// product <- S x
  template <typename T>
  RPSUP_INLINE void multiply(const T* x, T* product) const {
    const int n = acting_count_;
    for (int k = 0; k < n; ++k) {
      product[k] = {};
      for (int l = 0; l < n; ++l) product[k] += S_[room(k * n + l)] * x[l];
    }
  }

  [[nodiscard]] static std::size_t room(int n) { return static_cast<std::size_t>(n); }
  /// Of two rows that have a part, the second no later one than the first.
  [[nodiscard]] RPSUP_INLINE double& entry(int k, int l) { return A_[room(k * acting_count_ + l)]; }

  /// A <- S + e 1, the lower triangle.
  RPSUP_INLINE void scale() {
    constexpr double kAdded = 1e-9;  // e
    const int n = acting_count_;
    largest_.fill(0.0);
    for (int k = 0; k < n; ++k) {
      double& largest = largest_[room(block_[room(acting(k))])];
      largest = std::max(largest, entry(k, k));
    }
    for (int k = 0; k < n; ++k) weight_[room(k)] = 1.0 / std::sqrt(largest_[room(block_[room(acting(k))])]);
    for (int k = 0; k < n; ++k)
      for (int l = 0; l <= k; ++l) {
        const double scaled = weight_[room(k)] * weight_[room(l)] * entry(k, l);
        S_[room(k * n + l)] = S_[room(l * n + k)] = scaled;
        entry(k, l) = scaled + (k == l ? kAdded : 0.0);
      }
  }

  int count_;
  bool dependent_;
  int acting_count_;
  Buffer<int> acting_;
  Buffer<double> A_;                 ///< row after row; then its factor, or that of S + e 1
  Buffer<double> S_, weight_;
  Buffer<int> block_;                ///< of each row: the first one of its joint and kind
  Buffer<double> largest_;           ///< diagonal entry of each block
};

/// Of constraints of a tree with such shapes.
template <typename Shapes>
struct MatrixOf {
  using Type = MultiplierMatrix;
};
template <typename Shapes>
  requires Shapes::known
struct MatrixOf<Shapes> {
  using Type = IndependentMatrix<Shapes::row_count>;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
