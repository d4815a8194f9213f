// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/math/instruction_set.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Cholesky factorisation A = L L^T in place, in the lower triangle; the diagonal of L is stored inverted.
/// False if a pivot is below `singular` times its diagonal entry. The loops are unrolled where n is a
/// constant.
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
    row_c[c] = inverse;  
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

/// x <- (L L^T)^-1 x. @tparam T  a number, or a pack
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

/// Least pivot of A = L D L^T, a positive semidefinite matrix with diagonal entries up to one, or the first
/// pivot that is not positive. Overwrites the lower triangle.
[[nodiscard]] RPSUP_INLINE double calc_least_pivot(int n, double* A) {
  double least = 1.0;
  for (int c = 0; c < n; ++c) {
    const double pivot = A[c * n + c];
    if (!(pivot > 0.0)) return pivot;
    least = std::min(least, pivot);
    for (int r = c + 1; r < n; ++r) {
      const double factor = A[r * n + c] / pivot;
      for (int k = c + 1; k <= r; ++k) A[r * n + k] -= factor * A[k * n + c];
    }
  }
  return least;
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
