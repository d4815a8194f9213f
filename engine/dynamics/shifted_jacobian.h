#pragma once

#include <vector>

#include "engine/dynamics/state_jacobian.h"

namespace engine {

/// The matrix (shift 1 - J) of an implicit step, J the Jacobian of MotionSystem's state equation, with a real or a complex shift.
///
/// Eliminating all that StateJacobian says of J leaves a matrix of the free coordinates' number to be factored. With
/// a = (by_q, by_v, by_z) y for the accelerations, the same for the bristles' rates and those of work and loss, K = by_v + by_q / shift,
/// and x = (q, v, z, w) as given:
///
///     known = (v, z, w) + by_q q / shift,   own_z = shift 1 - by_z of the bristles' rates
///     (shift 1 - K_v - by_z_v own_z^-1 K_z) v = known_v + by_z_v own_z^-1 known_z
///     q = (q + v) / shift,   z = own_z^-1 (known_z + K_z v),   w = (known_w + K_w v + by_z_w z) / shift
///
/// @tparam Scalar  double or std::complex<double>
template <typename Scalar>
class ShiftedJacobian {
 public:
  ShiftedJacobian(int free_coordinates, int bristles, int drives);

  /// Factors (shift 1 - J). False if it is singular.
  [[nodiscard]] bool factor(const StateJacobian& J, Scalar shift);
  /// x <- (shift 1 - J)^-1 x. @param J  as factor() had it
  void solve_in_place(const StateJacobian& J, Scalar* x);

 private:
  // N: the number of free coordinates as the compiler knows it, 0 if it does not.
  template <int N>
  void reduce(const StateJacobian& J, Scalar shift);
  template <int N>
  bool factor_reduced();
  template <int N>
  void solve_sized(const StateJacobian& J, Scalar* state);
  template <int N>
  void solve_reduced(const Scalar* known, Scalar* x) const;
  template <int N>
  [[nodiscard]] int size() const {
    return N > 0 ? N : free_;
  }

  int free_;
  Scalar inverse_shift_{};
  std::vector<Scalar> K_;                         ///< rows as by_v
  std::vector<Scalar> bristle_inverse_;           ///< own_z^-1: 2 x 2 for each pair of acting bristles, row after row
  std::vector<Scalar> response_;                  ///< of the acting bristles to the free rates, own_z^-1 K_z
  std::vector<Scalar> lu_;                        ///< free x free, column after column in whole pairs; those of U over their pivots
  std::vector<Scalar> inverse_pivot_;
  std::vector<int> order_;                        ///< of the rows, as pivoting has exchanged them
  std::vector<Scalar> scaled_q_, solution_, known_, bristle_;  ///< parts of a solution
};

}  // namespace engine
