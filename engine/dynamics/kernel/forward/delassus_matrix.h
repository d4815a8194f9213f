// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/dynamics/constraint_rows.h"
#include "engine/dynamics/kernel/forward/cholesky.h"
#include "engine/math/buffer.h"
#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// A pivot below this share of its diagonal entry counts as zero: the mechanism stands in a singular
/// position.
constexpr double kSingularPivot = 1e-12;
/// The column before the first one of the matrix: the unconstrained motion, which ConstraintSolver solves for
/// together with the columns.
constexpr int kUnconstrained = -1;

/// Delassus matrix of n independent constraints, n a compile-time constant: factored by Cholesky.
template <int n>
class FullRankDelassus {
 public:
  RPSUP_INLINE explicit FullRankDelassus(const TreeModel&) {}

  /// Workspace of solve(): none.
  template <typename T>
  struct Workspace {
    RPSUP_INLINE explicit Workspace(const TreeModel&) {}
  };

  [[nodiscard]] static constexpr int active_count() { return n; }
  [[nodiscard]] static constexpr int active_row(int k) { return k; }

  /// Visits the first columns of packs: kUnconstrained, kUnconstrained + width and so on.
  template <int width, typename Visit>
  RPSUP_INLINE static void for_each_pack_of_columns(const Visit& visit) {
    [&]<int... group>(std::integer_sequence<int, group...>) RPSUP_INLINE_LAMBDA {
      (visit(std::integral_constant<int, group * width - 1>()), ...);
    }(std::make_integer_sequence<int, (n + width) / width>());
  }
  /// Sets the entries of row k in a pack of columns, one a lane.
  RPSUP_INLINE void set(int k, int column, const TangentPack& entries) {
    entries.store(A_ + k * kStride + 1 + column);
  }

  [[nodiscard]] RPSUP_INLINE bool factor() { return factor_cholesky(n, kStride, kSingularPivot, A_ + 1); }
  template <typename T>
  RPSUP_INLINE void solve(T* x, Workspace<T>&) const {
    solve_cholesky(n, kStride, A_ + 1, x);
  }

 private:
  static constexpr int kStride = (n + TangentPack::kCount) / TangentPack::kCount * TangentPack::kCount;
  double A_[n * kStride];  ///< row by row, each behind an entry of column kUnconstrained, which is not used
};

/// Delassus matrix A = Phi_q M^-1 Phi_q^T of any constraints, Eq. (K12).
///
/// Redundant constraints (Mechanism::minimum_norm_multipliers) make A singular, and A lambda = b has many
/// solutions. The minimum-norm one is taken: that of the least sum of (lambda_r / w_r)^2, with a weight w for
/// the rows of a joint's force, and one for those of its moment. With S = w A w, it is found by iterated
/// Tikhonov regularisation, Eq. (K13):
///
///     nu <- nu + (S + e 1)^-1 (w b - S nu),   lambda = w nu
///     w_r = 1 / sqrt(largest A_ss of the rows s of the same joint and kind)
///
/// which is the proximal point iteration (J. Carpentier, R. Budhiraja, N. Mansard, 2021). Its first step
/// alone is Tikhonov's solution, whose limit for e -> 0 is the minimum-norm one. So a mechanism passes
/// positions in which it gains a freedom for an instant: there rows of a joint, all with one weight, fade
/// together. Inactive rows, which no coordinate moves (those out of the plane of a flat mechanism), are left
/// out, and where the rest is independent, S is factored as it is.
class DelassusMatrix {
 public:
  explicit DelassusMatrix(const TreeModel& model)
      : count_(model.rows),
        redundant_(model.minimum_norm_multipliers),
        active_count_(count_),
        active_(count_),
        A_(count_ * count_),
        S_(redundant_ ? count_ * count_ : 0),
        G_(S_.size()),
        weight_(redundant_ ? count_ : 0),
        weight_of_G_(weight_.size()),
        block_(count_),
        largest_(count_) {
    for (int r = 0; r < count_; ++r) active_[r] = block_[r] = r;
    for (const TreeCutJoint& joint : model.cut_joints) {
      if (joint.first_row < 0) continue;
      for (int k = 0; k < joint.rows.count(); ++k)
        block_[joint.first_row + k] =
            joint.first_row + (k < joint.rows.positions ? 0 : joint.rows.positions);
    }
  }

  /// Workspace of solve().
  template <typename T>
  struct Workspace {
    explicit Workspace(const TreeModel& model)
        : rhs(model.rows), remainder(model.rows), solution(model.rows) {}
    Buffer<T> rhs, remainder, solution;
  };

  /// Of redundant constraints: finds the active rows.
  RPSUP_INLINE void find_active_rows(const ConstraintJacobian& jacobian, const std::vector<int>& free) {
    constexpr double kInactive = 1e-10;  // of a row's entries, [m/rad] or [1]
    active_count_ = 0;
    for (int r = 0; r < count_; ++r) {
      double largest = 0.0;
      for (const int i : free) largest = std::max(largest, std::abs(jacobian.row(r)[i]));
      if (largest > kInactive) active_[active_count_++] = r;
    }
  }

  /// The active rows: their number, and the k-th of them.
  [[nodiscard]] RPSUP_INLINE int active_count() const { return active_count_; }
  [[nodiscard]] RPSUP_INLINE int active_row(int k) const { return active_[k]; }

  /// As those of FullRankDelassus, of the active rows.
  template <int width, typename Visit>
  RPSUP_INLINE void for_each_pack_of_columns(const Visit& visit) const {
    for (int column = kUnconstrained; column < active_count_; column += width) visit(column);
  }
  RPSUP_INLINE void set(int k, int column, const TangentPack& entries) {
    double numbers[TangentPack::kCount];
    entries.store(numbers);
    for (int l = std::max(column, 0); l < std::min(column + TangentPack::kCount, k + 1); ++l)
      entry(k, l) = numbers[l - column];
  }

  /// False if the matrix of constraints that should be independent is singular.
  /// @param jacobian  of redundant constraints
  [[nodiscard]] RPSUP_INLINE bool factor(const ConstraintJacobian& jacobian, const std::vector<int>& free) {
    const int n = active_count_;
    if (!redundant_) return factor_cholesky(n, n, kSingularPivot, A_.data());
    weigh(A_, weight_);
    for (int k = 0; k < n; ++k)
      for (int l = 0; l <= k; ++l) S_[k * n + l] = S_[l * n + k] = entry(k, l);
    regularised_ = !are_independent(jacobian, free);
    for (int k = 0; k < n; ++k) entry(k, k) += regularised_ ? kEpsilon : 0.0;
    return factor_cholesky(n, n, 0.0, A_.data());
  }

  /// x <- A^-1 x, or the minimum-norm solution. @tparam T  a number, or a pack
  template <typename T>
  RPSUP_INLINE void solve(T* x, Workspace<T>& work) const {
    if (!redundant_) return solve_cholesky(count_, count_, A_.data(), x);
    const int n = active_count_;
    T* scaled = work.rhs.data();
    for (int k = 0; k < n; ++k) scaled[k] = weight_[k] * x[active_row(k)];
    if (regularised_) {
      // (K14): S times a first solution is the projection of the right-hand side on the range of S. The part
      // outside, if only by rounding, would be amplified by 1 / e.
      solve_regularised(work);
      multiply(work.solution.data(), scaled);
      solve_regularised(work);
      for (int k = 0; k < n; ++k) scaled[k] = work.solution[k];
    } else {
      solve_cholesky(n, n, A_.data(), scaled);
    }
    for (int r = 0; r < count_; ++r) x[r] = {};
    for (int k = 0; k < n; ++k) x[active_row(k)] = weight_[k] * scaled[k];
  }

 private:
  static constexpr double kEpsilon = 1e-9;  ///< e

  /// work.solution <- S^+ work.rhs, of least norm, by the iteration (K13).
  template <typename T>
  RPSUP_INLINE void solve_regularised(Workspace<T>& work) const {
    constexpr int kRefinements = 3;
    const int n = active_count_;
    T* remainder = work.remainder.data();
    T* solution = work.solution.data();
    for (int k = 0; k < n; ++k) {
      remainder[k] = work.rhs[k];
      solution[k] = {};
    }
    for (int iteration = 0; iteration <= kRefinements; ++iteration) {
      solve_cholesky(n, n, A_.data(), remainder);
      for (int k = 0; k < n; ++k) solution[k] += remainder[k];
      if (iteration == kRefinements) break;
      multiply(solution, remainder);
      for (int k = 0; k < n; ++k) remainder[k] = work.rhs[k] - remainder[k];
    }
  }

  /// product <- S x
  template <typename T>
  RPSUP_INLINE void multiply(const T* x, T* product) const {
    const int n = active_count_;
    for (int k = 0; k < n; ++k) {
      product[k] = {};
      for (int l = 0; l < n; ++l) product[k] += S_[k * n + l] * x[l];
    }
  }

  /// Entry of the k-th and l-th active rows, l <= k.
  [[nodiscard]] RPSUP_INLINE double& entry(int k, int l) { return A_[k * active_count_ + l]; }

  /// Weighs the rows of a symmetric matrix so that the largest diagonal entry of each block becomes one.
  RPSUP_INLINE void weigh(Buffer<double>& matrix, Buffer<double>& weight) {
    const int n = active_count_;
    largest_.fill(0.0);
    for (int k = 0; k < n; ++k) {
      double& largest = largest_[block_[active_row(k)]];
      largest = std::max(largest, matrix[k * n + k]);
    }
    for (int k = 0; k < n; ++k) weight[k] = 1.0 / std::sqrt(largest_[block_[active_row(k)]]);
    for (int k = 0; k < n; ++k)
      for (int l = 0; l <= k; ++l) matrix[k * n + l] *= weight[k] * weight[l];
  }

  /// G_ <- Phi_q V Phi_q^T, weighed as S, where V divides each column by the square of its largest entry:
  /// the Delassus matrix if M were diagonal, with these squares.
  RPSUP_INLINE void calc_geometry(const ConstraintJacobian& jacobian, const std::vector<int>& free) {
    const int n = active_count_;
    G_.fill(0.0);
    for (const int i : free) {
      double largest = 0.0;
      for (int k = 0; k < n; ++k) largest = std::max(largest, std::abs(jacobian.row(active_row(k))[i]));
      if (largest == 0.0) continue;
      for (int k = 0; k < n; ++k)
        for (int l = 0; l <= k; ++l)
          G_[k * n + l] +=
              jacobian.row(active_row(k))[i] * jacobian.row(active_row(l))[i] / (largest * largest);
    }
    weigh(G_, weight_of_G_);
  }

  /// @returns whether the active rows are independent, far from a change point. That is one of the geometry,
  /// G: light links among heavy ones give S small eigenvalues in any position.
  RPSUP_INLINE bool are_independent(const ConstraintJacobian& jacobian, const std::vector<int>& free) {
    const int n = active_count_;
    // The least eigenvalue of a chain of loops can be smaller than the least pivot by a factor of n^2.
    const double least = std::min(1e-7 * n * n, 1e-3);
    std::copy_n(S_.data(), n * n, G_.data());
    const double pivot_of_S = calc_least_pivot(n, G_.data());
    if (pivot_of_S > least) return true;
    calc_geometry(jacobian, free);
    return pivot_of_S > kSingularPivot && calc_least_pivot(n, G_.data()) > least;
  }

  int count_;
  bool redundant_;
  bool regularised_ = false;         ///< whether A_ is the factor of S + e 1
  int active_count_;
  Buffer<int> active_;
  Buffer<double> A_;                 ///< row by row; then its Cholesky factor, or that of S + e 1
  Buffer<double> S_, G_;             ///< G_ is workspace of calc_least_pivot() as well
  Buffer<double> weight_, weight_of_G_;
  Buffer<int> block_;                ///< of each row: the first row of the same joint and kind
  Buffer<double> largest_;           ///< diagonal entry of each block of rows
};

/// The Delassus matrix of a topology.
template <typename Topology>
struct DelassusOf {
  using Type = DelassusMatrix;
};
template <typename Topology>
  requires Topology::is_static
struct DelassusOf<Topology> {
  using Type = FullRankDelassus<Topology::row_count>;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
