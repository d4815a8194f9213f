#pragma once

#include <cstddef>

#include "engine/dynamics/state_jacobian.h"
#include "engine/math/buffer.h"
#include "engine/math/complex.h"
#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Rows of a matrix that are taken at once. However many: what is computed with each of them is the same.
using RowLanes = LaneBlock<kWidestPart < StateJacobian::kBlock ? kWidestPart : StateJacobian::kBlock>;

/// Where a vector of numbers stands: complex ones as two, so that several of them stand side by side.
template <typename Scalar>
struct NumbersAt;
template <>
struct NumbersAt<double> {
  using WideScalar = RowLanes;
  double* at;

  [[nodiscard]] RPSUP_INLINE double operator[](int i) const { return at[i]; }
  RPSUP_INLINE void set(int i, double value) const { at[i] = value; }
  [[nodiscard]] RPSUP_INLINE RowLanes load(int i) const { return RowLanes::load(at + i); }
  RPSUP_INLINE void store(int i, const RowLanes& values) const { values.store(at + i); }
  [[nodiscard]] RPSUP_INLINE NumbersAt from(int i) const { return {at + i}; }
};
template <>
struct NumbersAt<Complex<double>> {
  using WideScalar = Complex<RowLanes>;
  double *real, *imag;

  [[nodiscard]] RPSUP_INLINE Complex<double> operator[](int i) const { return {real[i], imag[i]}; }
  RPSUP_INLINE void set(int i, const Complex<double>& value) const {
    real[i] = value.real;
    imag[i] = value.imag;
  }
  [[nodiscard]] RPSUP_INLINE Complex<RowLanes> load(int i) const { return {RowLanes::load(real + i), RowLanes::load(imag + i)}; }
  RPSUP_INLINE void store(int i, const Complex<RowLanes>& values) const {
    values.real.store(real + i);
    values.imag.store(imag + i);
  }
  [[nodiscard]] RPSUP_INLINE NumbersAt from(int i) const { return {real + i, imag + i}; }
};

/// Where rows of numbers stand.
template <typename Scalar>
struct RowsAt {
  NumbersAt<Scalar> first;
  int stride;

  [[nodiscard]] RPSUP_INLINE NumbersAt<Scalar> row(int i) const { return first.from(i * stride); }
};

/// Rows of numbers; of complex ones all real parts, then all imaginary ones.
template <typename Scalar>
class NumberRows {
 public:
  NumberRows(int rows, int stride)
      : size_(static_cast<std::size_t>(rows) * static_cast<std::size_t>(stride)), numbers_(size_ * sizeof(Scalar) / sizeof(double)) {}

  /// To be asked for before anything is stored: the compiler must take what is stored for a change of these, too.
  /// @param stride  the same, which the compiler may know
  [[nodiscard]] RPSUP_INLINE RowsAt<Scalar> rows(int stride) {
    if constexpr (sizeof(Scalar) == sizeof(double))
      return {{numbers_.data()}, stride};
    else
      return {{numbers_.data(), numbers_.data() + size_}, stride};
  }
  [[nodiscard]] RPSUP_INLINE NumbersAt<Scalar> first() { return rows(0).first; }

 private:
  std::size_t size_;
  Buffer<double> numbers_;
};

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
