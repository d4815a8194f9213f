// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/dynamics/kernel/tangent/state_jacobian.h"
#include "engine/math/buffer.h"
#include "engine/math/number_rows.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The matrix (shift 1 - J) of an implicit step, J the Jacobian of MotionSystem's state equation, with a real or a complex shift.
///
/// Eliminating all that StateJacobian says of J leaves a matrix of the free coordinates' number to be factored. With
/// a = (by_q, by_v, by_z) y for the accelerations, the same for the bristles' rates and those of work and loss, K = by_v + by_q / shift,
/// and x = (q, v, z, w) as given:
///
///     own_z = shift 1 - by_z of the bristles' rates,   response = own_z^-1 K_z,   condensed = K + by_z response
///     known_z = own_z^-1 (z + by_q q / shift),   known = (v, w) + by_q q / shift + by_z known_z
///     (shift 1 - condensed_v) v = known_v,   q = (q + v) / shift,   z = known_z + response v,   w = (known_w + condensed_w v) / shift
///
/// @tparam Scalar  double or Complex<double>
template <typename Scalar>
class ShiftedJacobian {
 public:
  /// @param J  with its matrices; must outlive this, and stay as it is from factor() to the last solve_in_place()
  explicit ShiftedJacobian(const StateJacobian& J);

  /// Factors (shift 1 - J). False if it is singular.
  [[nodiscard]] bool factor(const Scalar& shift);
  /// x <- (shift 1 - J)^-1 x
  void solve_in_place(NumbersAt<Scalar> x);

 private:
  using WideScalar = typename NumbersAt<Scalar>::WideScalar;

  // Sizes: those of J, some of them as the compiler knows them.
  template <typename Sizes>
  void reduce(const Sizes& size, const Scalar& shift);
  template <typename Sizes>
  void invert_own(const Sizes& size, const Scalar& shift);
  template <typename Sizes>
  void find_response(const Sizes& size, const Scalar& inverse_shift);
  template <typename Sizes>
  [[nodiscard]] bool factor_reduced(const Sizes& size);
  template <typename Sizes>
  void solve_sized(const Sizes& size, NumbersAt<Scalar> state);
  template <typename Sizes>
  void start_bristles(const Sizes& size, NumbersAt<Scalar> z, NumbersAt<Scalar> scaled_q);
  template <typename Sizes>
  void solve_reduced(const Sizes& size, NumbersAt<Scalar> known, NumbersAt<Scalar> v);
  template <typename Sizes>
  void add_response(const Sizes& size, NumbersAt<Scalar> v);

  const StateJacobian& J_;
  Scalar inverse_shift_{};
  NumberRows<Scalar> own_inverse_;   ///< own_z^-1 of each pair: rows as rates_by_own
  NumberRows<Scalar> response_;      ///< of each pair's first bristle to a free rate, of its second, ...
  NumberRows<Scalar> lower_;         ///< of the reduced matrix, a row for each column; at first all of it
  NumberRows<Scalar> upper_;         ///< the same, each over its pivot
  NumberRows<Scalar> condensed_w_;   ///< a row for each column
  NumberRows<Scalar> inverse_pivot_;
  Buffer<int> order_;                ///< of the rows, as pivoting has exchanged them
  NumberRows<Scalar> bristle_;       ///< first bristles, second ones
  NumberRows<Scalar> scaled_q_, v_, known_;
};

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
