// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/dynamics/kernel/tangent/state_jacobian.h"
#include "engine/math/buffer.h"
#include "engine/math/number_rows.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The Newton matrix sigma 1 - J of an implicit step, J = df/dy of MotionSystem's state equation, condensed
/// to a dense matrix of the free rates and factored. (SUNDIALS calls gamma (sigma 1 - J) M, SciML W.) The
/// shift sigma is real or complex.
///
/// b = (b_q, b_v, b_z, b_w) is the right-hand side; by_q, by_v and by_z are the blocks of accelerations and
/// powers together, rates_by_q, rates_by_v and E those of the bristles' rates. The block elimination is, Eqs.
/// (K24) to (K27):
///
///     response = (sigma 1 - E)^-1 (rates_by_v + rates_by_q / sigma)                                  (K25)
///     z_free = (sigma 1 - E)^-1 (b_z + rates_by_q b_q / sigma)                                       (K25)
///     condensed = by_v + by_q / sigma + by_z response                                                (K26)
///     rhs = (b_v, 0) + by_q b_q / sigma + by_z z_free                                                (K26)
///     (sigma 1 - condensed_v) v = rhs_v                                                              (K26)
///     q = (b_q + v) / sigma,  z = z_free + response v,  w = (b_w + rhs_w + condensed_w v) / sigma    (K27)
///
/// @tparam Scalar  double or Complex<double>
template <typename Scalar>
class NewtonMatrix {
 public:
  /// @param J  with its matrices; must outlive this, and stay as it is from factor() to the last
  /// solve_in_place()
  explicit NewtonMatrix(const StateJacobian& J);

  /// Factors (shift 1 - J). False if it is singular.
  [[nodiscard]] bool factor(const Scalar& shift);
  /// x <- (shift 1 - J)^-1 x
  void solve_in_place(NumbersAt<Scalar> x);

 private:
  using WideScalar = typename NumbersAt<Scalar>::WideScalar;

  // Sizes: those of J, some as compile-time constants.
  template <typename Sizes>
  void condense(const Sizes& size, const Scalar& shift);
  template <typename Sizes>
  void invert_bristle_blocks(const Sizes& size, const Scalar& shift);
  template <typename Sizes>
  void calc_bristle_response(const Sizes& size, const Scalar& inverse_shift);
  template <typename Sizes>
  [[nodiscard]] bool factor_lu(const Sizes& size);
  template <typename Sizes>
  void solve_sized(const Sizes& size, NumbersAt<Scalar> state);
  template <typename Sizes>
  void calc_free_bristles(const Sizes& size, NumbersAt<Scalar> z, NumbersAt<Scalar> scaled_q);
  template <typename Sizes>
  void solve_lu(const Sizes& size, NumbersAt<Scalar> rhs, NumbersAt<Scalar> v);
  template <typename Sizes>
  void add_bristle_response(const Sizes& size, NumbersAt<Scalar> v);

  const StateJacobian& J_;
  Scalar inverse_shift_{};
  NumberRows<Scalar> bristle_inverse_;   ///< (sigma 1 - E)^-1 of each pair: rows as rates_by_bristle
  /// rows 2 j and 2 j + 1: of the first and second bristles to the free rate j
  NumberRows<Scalar> bristle_response_;
  /// L, stored by columns: row(k) is column k. Before factor_lu(): sigma 1 - condensed_v
  NumberRows<Scalar> lower_;
  NumberRows<Scalar> upper_;         ///< U, stored by columns: row(k) is column k, divided by its pivot u_kk
  NumberRows<Scalar> condensed_w_;   ///< stored by columns
  NumberRows<Scalar> inverse_pivot_;
  Buffer<int> order_;                ///< permutation of the rows by pivoting
  NumberRows<Scalar> bristle_;       ///< z_free, then z: a row of first bristles, one of second ones
  NumberRows<Scalar> scaled_q_, v_, rhs_;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
