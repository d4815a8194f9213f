// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>

#include "engine/math/buffer.h"
#include "engine/math/complex.h"
#include "engine/math/finite.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// A square matrix to be factored, Gauss with partial pivoting. (Functions of Eigen would be shared between
/// instruction sets by the linker.)
/// @tparam Scalar  double or Complex<double>
template <typename Scalar>
class DenseMatrix {
 public:
  /// @param capacity  largest number of rows
  explicit DenseMatrix(std::size_t capacity) : entries_(capacity * capacity), order_(capacity) {}

  /// Makes it n x n. Entries are not set.
  void resize(std::size_t n) { n_ = n; }
  [[nodiscard]] std::size_t size() const { return n_; }
  [[nodiscard]] RPSUP_INLINE Scalar& operator()(std::size_t row, std::size_t column) {
    return entries_[row * n_ + column];
  }
  [[nodiscard]] RPSUP_INLINE Scalar operator()(std::size_t row, std::size_t column) const {
    return entries_[row * n_ + column];
  }

  /// L U = P A in place. False if A is singular.
  [[nodiscard]] bool factor() {
    for (std::size_t k = 0; k < n_; ++k) {
      std::size_t pivot = k;
      for (std::size_t i = k + 1; i < n_; ++i)
        if (size_of((*this)(i, k)) > size_of((*this)(pivot, k))) pivot = i;
      order_[k] = pivot;
      if (pivot != k)
        for (std::size_t j = 0; j < n_; ++j) std::swap((*this)(k, j), (*this)(pivot, j));
      const Scalar inverse = 1.0 / (*this)(k, k);
      if (!is_number(size_of(inverse))) return false;
      for (std::size_t i = k + 1; i < n_; ++i) {
        const Scalar factor = (*this)(i, k) *= inverse;
        for (std::size_t j = k + 1; j < n_; ++j) (*this)(i, j) -= factor * (*this)(k, j);
      }
    }
    return true;
  }

  /// x <- A^-1 x after factor().
  void solve_in_place(Scalar* x) const {
    for (std::size_t k = 0; k < n_; ++k) {
      std::swap(x[k], x[order_[k]]);
      for (std::size_t j = 0; j < k; ++j) x[k] -= (*this)(k, j) * x[j];
    }
    for (std::size_t k = n_; k-- > 0;) {
      for (std::size_t j = k + 1; j < n_; ++j) x[k] -= (*this)(k, j) * x[j];
      x[k] /= (*this)(k, k);
    }
  }

  /// x <- A^-T x after factor().
  void solve_transposed_in_place(Scalar* x) const {
    for (std::size_t k = 0; k < n_; ++k) {
      for (std::size_t j = 0; j < k; ++j) x[k] -= (*this)(j, k) * x[j];
      x[k] /= (*this)(k, k);
    }
    for (std::size_t k = n_; k-- > 0;)
      for (std::size_t j = k + 1; j < n_; ++j) x[k] -= (*this)(j, k) * x[j];
    for (std::size_t k = n_; k-- > 0;) std::swap(x[k], x[order_[k]]);
  }

  /// Least pivot over the largest one, after factor(): how far the matrix is from a singular one.
  [[nodiscard]] auto pivot_ratio() const {
    auto least = size_of(Scalar{1.0}), largest = least;
    for (std::size_t k = 0; k < n_; ++k) {
      const auto pivot = size_of((*this)(k, k));
      least = k == 0 || pivot < least ? pivot : least;
      largest = k == 0 || pivot > largest ? pivot : largest;
    }
    return least / largest;
  }

  /// After factor().
  [[nodiscard]] Scalar determinant() const {
    Scalar product{1.0};
    for (std::size_t k = 0; k < n_; ++k) product *= order_[k] == k ? (*this)(k, k) : -(*this)(k, k);
    return product;
  }

 private:
  std::size_t n_ = 0;
  Buffer<Scalar> entries_;       ///< row after row
  Buffer<std::size_t> order_;    ///< row with which each one was exchanged
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
