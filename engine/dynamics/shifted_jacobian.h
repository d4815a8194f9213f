#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "engine/dynamics/state_jacobian.h"

namespace engine {

/// Where a vector of numbers stands: complex ones as two, so that several of them stand side by side.
template <typename Scalar>
struct NumbersAt;
template <>
struct NumbersAt<double> {
  double* at;

  [[nodiscard]] double operator[](int i) const { return at[i]; }
  void set(int i, double value) const { at[i] = value; }
  [[nodiscard]] NumbersAt from(int i) const { return {at + i}; }
};
template <>
struct NumbersAt<std::complex<double>> {
  double *real, *imag;

  [[nodiscard]] std::complex<double> operator[](int i) const { return {real[i], imag[i]}; }
  void set(int i, std::complex<double> value) const {
    real[i] = value.real();
    imag[i] = value.imag();
  }
  [[nodiscard]] NumbersAt from(int i) const { return {real + i, imag + i}; }
};

/// The matrix (shift 1 - J) of an implicit step, J the Jacobian of MotionSystem's state equation, with a real or a complex shift.
///
/// Eliminating all that StateJacobian says of J leaves a matrix of the free coordinates' number to be factored. With
/// a = (by_q, by_v, by_z) y for the accelerations, the same for the bristles' rates and those of work and loss, K = by_v + by_q / shift,
/// and x = (q, v, z, w) as given:
///
///     known = (v, z, w) + by_q q / shift,   own_z = shift 1 - by_z of the bristles' rates,   response = own_z^-1 K_z
///     (shift 1 - K_v - by_z_v response) v = known_v + by_z_v own_z^-1 known_z
///     q = (q + v) / shift,   z = own_z^-1 known_z + response v,   w = (known_w + K_w v + by_z_w z) / shift
///
/// @tparam Scalar  double or std::complex<double>
template <typename Scalar>
class ShiftedJacobian {
 public:
  ShiftedJacobian(int free_coordinates, int bristles, int drives);

  /// Factors (shift 1 - J). False if it is singular.
  [[nodiscard]] bool factor(const StateJacobian& J, Scalar shift);
  /// x <- (shift 1 - J)^-1 x. @param J  as factor() had it
  void solve_in_place(const StateJacobian& J, NumbersAt<Scalar> x);

 private:
  /// Rows of numbers; of complex ones all real parts, then all imaginary ones.
  class Rows {
   public:
    void resize(int rows, int columns);
    [[nodiscard]] NumbersAt<Scalar> row(int i);

   private:
    std::ptrdiff_t columns_ = 0, size_ = 0;
    std::vector<double> numbers_;
  };

  // N: the number of free coordinates as the compiler knows it, 0 if it does not.
  template <int N>
  void reduce(const Linearisation& J, Scalar shift);
  void invert_own(const Linearisation& J, Scalar shift);
  void find_response(const Linearisation& J, int coordinate);
  template <typename Wide>
  void answer(int p, Wide first, Wide second, NumbersAt<Scalar> firsts, NumbersAt<Scalar> seconds);
  template <int N>
  bool factor_reduced();
  template <int N>
  void start_bristles(const Linearisation& J, NumbersAt<Scalar> z, const Scalar* q, NumbersAt<Scalar> firsts, NumbersAt<Scalar> seconds);
  template <int N>
  void add_response(int pairs, const Scalar* v, NumbersAt<Scalar> firsts, NumbersAt<Scalar> seconds);
  template <int N>
  void solve_sized(const Linearisation& J, NumbersAt<Scalar> state);
  template <int N>
  void solve_reduced(const Scalar* known, Scalar* x) const;
  template <int N>
  [[nodiscard]] int size() const {
    return N > 0 ? N : free_;
  }

  int free_, bristles_;
  Scalar inverse_shift_{};
  std::vector<Scalar> K_;                         ///< of accelerations and rates of work and loss, rows as by_v
  Rows bristle_inverse_;                          ///< own_z^-1 of each pair: rows as rates_by_own
  Rows response_;                                 ///< of each pair's first bristle to a free rate, of its second, ...
  std::vector<Scalar> lu_;                        ///< free x free, column after column in whole pairs; those of U over their pivots
  std::vector<Scalar> inverse_pivot_;
  std::vector<int> order_;                        ///< of the rows, as pivoting has exchanged them
  std::vector<Scalar> scaled_q_, solution_, known_;  ///< parts of a solution
  Rows bristle_;                                  ///< first bristles, second ones
};

}  // namespace engine
