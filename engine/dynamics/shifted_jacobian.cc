#include "engine/dynamics/shifted_jacobian.h"

#include <cmath>
#include <complex>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "engine/math/instruction_set.h"

namespace engine {

namespace {

using Complex = std::complex<double>;

std::size_t area(int rows, int columns) { return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns); }

/// Two numbers side by side, at any address.
typedef double Pair __attribute__((vector_size(16), aligned(8), may_alias));

RPSUP_INLINE Pair& pair(double* x) { return *reinterpret_cast<Pair*>(x); }
RPSUP_INLINE const Pair& pair(const double* x) { return *reinterpret_cast<const Pair*>(x); }

RPSUP_INLINE double add_up(Pair sum) { return sum[0] + sum[1]; }

/// Sums of the even and of the odd products: the same on every machine.
RPSUP_INLINE Pair begin_sum(double first) { return Pair{first, 0.0}; }
RPSUP_INLINE Pair add_products(Pair sum, const double* a, const double* b, int n) {
  int j = 0;
  for (; j + 1 < n; j += 2) sum += pair(a + j) * pair(b + j);
  if (j < n) sum += Pair{a[j], 0.0} * Pair{b[j], 0.0};
  return sum;
}

/// Two complex numbers side by side.
struct ComplexPair {
  Pair real, imag;
};
RPSUP_INLINE ComplexPair operator+(ComplexPair a, ComplexPair b) { return {a.real + b.real, a.imag + b.imag}; }
RPSUP_INLINE ComplexPair operator+(Pair a, ComplexPair b) { return {a + b.real, b.imag}; }
RPSUP_INLINE ComplexPair operator-(ComplexPair a, Pair b) { return {a.real - b, a.imag}; }
RPSUP_INLINE ComplexPair operator-(Complex a, Pair b) { return {a.real() - b, a.imag() - Pair{}}; }
RPSUP_INLINE ComplexPair operator*(Pair a, ComplexPair b) { return {a * b.real, a * b.imag}; }
RPSUP_INLINE ComplexPair operator*(Pair a, Complex b) { return {a * b.real(), a * b.imag()}; }
RPSUP_INLINE ComplexPair operator*(ComplexPair a, ComplexPair b) {
  return {a.real * b.real - a.imag * b.imag, a.real * b.imag + a.imag * b.real};
}
RPSUP_INLINE ComplexPair operator*(ComplexPair a, Complex b) {
  return {a.real * b.real() - a.imag * b.imag(), a.real * b.imag() + a.imag * b.real()};
}
RPSUP_INLINE ComplexPair operator/(double a, ComplexPair b) {
  const Pair factor = a / (b.real * b.real + b.imag * b.imag);
  return {factor * b.real, -factor * b.imag};
}

RPSUP_INLINE ComplexPair begin_sum(Complex first) { return {begin_sum(first.real()), begin_sum(first.imag())}; }
template <typename Scalar>
RPSUP_INLINE ComplexPair add_products(ComplexPair sum, const Scalar* a, const Complex* b, int n) {
  Complex products;
  for (int j = 0; j < n; ++j) products += a[j] * b[j];
  return sum + begin_sum(products);
}
RPSUP_INLINE Complex add_up(ComplexPair sum) { return {add_up(sum.real), add_up(sum.imag)}; }

RPSUP_INLINE Pair pair_at(NumbersAt<double> numbers, int i) { return pair(numbers.at + i); }
RPSUP_INLINE ComplexPair pair_at(NumbersAt<Complex> numbers, int i) { return {pair(numbers.real + i), pair(numbers.imag + i)}; }
RPSUP_INLINE void set_pair(NumbersAt<double> numbers, int i, Pair value) { pair(numbers.at + i) = value; }
RPSUP_INLINE void set_pair(NumbersAt<Complex> numbers, int i, ComplexPair value) {
  pair(numbers.real + i) = value.real;
  pair(numbers.imag + i) = value.imag;
}

/// y -= factor x from entry `from`, or the pair that holds it, to the one before entry `to`
RPSUP_INLINE void subtract_scaled(double factor, const double* x, int from, int to, double* y) {
  const Pair both{factor, factor};
  for (int j = from & ~1; j < to; j += 2) pair(y + j) -= both * pair(x + j);
}
RPSUP_INLINE void subtract_scaled(Complex factor, const Complex* x, int from, int to, Complex* y) {
  for (int j = from; j < to; ++j) y[j] -= factor * x[j];
}

/// A measure of size, the cheapest.
RPSUP_INLINE double size_of(double x) { return std::abs(x); }
RPSUP_INLINE double size_of(Complex x) { return std::abs(x.real()) + std::abs(x.imag()); }

/// Calls f(0), ..., f(n - 1); with each index known to the compiler if n is.
template <int N, typename Function>
RPSUP_INLINE void for_each(int n, const Function& f) {
  if constexpr (N > 0)
    [&]<int... k>(std::integer_sequence<int, k...>) { (f(k), ...); }(std::make_integer_sequence<int, N>{});
  else
    for (int k = 0; k < n; ++k) f(k);
}

RPSUP_INLINE Pair put_together(double a, double b) { return Pair{a, b}; }
RPSUP_INLINE ComplexPair put_together(Complex a, Complex b) { return {Pair{a.real(), b.real()}, Pair{a.imag(), b.imag()}}; }

/// Adds what all bristles do to an output.
template <typename Sum, typename Scalar>
RPSUP_INLINE Sum add_effects(Sum sum, const Linearisation& J, int output, NumbersAt<Scalar> firsts, NumbersAt<Scalar> seconds) {
  const double* by = J.by_bristle + 2 * output * J.stride;
  for (int p = 0; p < J.pairs; p += 2) sum = sum + pair(by + p) * pair_at(firsts, p) + pair(by + J.stride + p) * pair_at(seconds, p);
  return sum;
}

/// Room for n entries in whole pairs.
constexpr int whole_pairs(int n) { return n + (n & 1); }

/// Sizes that the compiler may unroll: the rigid linkage's and the flexible one's of four elements.
template <typename Function>
decltype(auto) with_size(int n, const Function& f) {
  if (n == 5) return f.template operator()<5>();
  if (n == 14) return f.template operator()<14>();
  return f.template operator()<0>();
}

}  // namespace

template <typename Scalar>
void ShiftedJacobian<Scalar>::Rows::resize(int rows, int columns) {
  columns_ = columns;
  size_ = rows * columns_;
  numbers_.resize(static_cast<std::size_t>(size_) * sizeof(Scalar) / sizeof(double));
}

template <typename Scalar>
NumbersAt<Scalar> ShiftedJacobian<Scalar>::Rows::row(int i) {
  double* first = numbers_.data() + i * columns_;
  if constexpr (std::is_same_v<Scalar, double>)
    return {first};
  else
    return {first, first + size_};
}

template <typename Scalar>
ShiftedJacobian<Scalar>::ShiftedJacobian(int free_coordinates, int bristles, int drives) : free_(free_coordinates), bristles_(bristles) {
  const int outputs = free_ + drives + 3;
  const int stride = calc_pair_stride(bristles);
  K_.resize(area(outputs, free_));
  bristle_inverse_.resize(4, stride);
  response_.resize(2 * free_, stride);
  lu_.resize(area(whole_pairs(free_), whole_pairs(free_)));
  inverse_pivot_.resize(area(free_, 1));
  order_.resize(area(free_, 1));
  scaled_q_.resize(area(whole_pairs(free_), 1));
  solution_.resize(area(whole_pairs(free_), 1));
  known_.resize(area(free_, 1));
  bristle_.resize(2, stride);
}

template <typename Scalar>
bool ShiftedJacobian<Scalar>::factor(const StateJacobian& J, Scalar shift) {
  return with_size(free_, [&]<int N>() {
    reduce<N>(J.derivatives(), shift);
    return factor_reduced<N>();
  });
}

template <typename Scalar>
void ShiftedJacobian<Scalar>::solve_in_place(const StateJacobian& J, NumbersAt<Scalar> x) {
  with_size(free_, [&]<int N>() { solve_sized<N>(J.derivatives(), x); });
}

/// Bristles of two pairs from p on: own_z^-1 of what is known of them.
template <typename Scalar>
template <typename Wide>
RPSUP_INLINE void ShiftedJacobian<Scalar>::answer(int p, Wide first, Wide second, NumbersAt<Scalar> firsts, NumbersAt<Scalar> seconds) {
  set_pair(firsts, p, pair_at(bristle_inverse_.row(0), p) * first + pair_at(bristle_inverse_.row(1), p) * second);
  set_pair(seconds, p, pair_at(bristle_inverse_.row(2), p) * first + pair_at(bristle_inverse_.row(3), p) * second);
}

template <typename Scalar>
RPSUP_INLINE void ShiftedJacobian<Scalar>::invert_own(const Linearisation& J, Scalar shift) {
  const double* by_own = J.rates_by_own;
  for (int p = 0; p < J.pairs; p += 2) {
    const auto a00 = shift - pair(by_own + p), a11 = shift - pair(by_own + 3 * J.stride + p);
    const Pair a01 = -pair(by_own + J.stride + p), a10 = -pair(by_own + 2 * J.stride + p);
    const auto inverse_determinant = 1.0 / (a00 * a11 - a01 * a10);
    set_pair(bristle_inverse_.row(0), p, a11 * inverse_determinant);
    set_pair(bristle_inverse_.row(1), p, -a01 * inverse_determinant);
    set_pair(bristle_inverse_.row(2), p, -a10 * inverse_determinant);
    set_pair(bristle_inverse_.row(3), p, a00 * inverse_determinant);
  }
}

/// own_z^-1 K_z of a coordinate.
template <typename Scalar>
RPSUP_INLINE void ShiftedJacobian<Scalar>::find_response(const Linearisation& J, int coordinate) {
  const double* by_q = J.rates_by_q + 2 * coordinate * J.stride;
  const double* by_v = J.rates_by_v + 2 * coordinate * J.stride;
  const Scalar inverse_shift = inverse_shift_;
  const NumbersAt<Scalar> firsts = response_.row(2 * coordinate), seconds = response_.row(2 * coordinate + 1);
  for (int p = 0; p < J.pairs; p += 2)
    answer(p, pair(by_v + p) + pair(by_q + p) * inverse_shift, pair(by_v + J.stride + p) + pair(by_q + J.stride + p) * inverse_shift, firsts,
           seconds);
}

/// K, the bristles' own part and the matrix of the free coordinates.
template <typename Scalar>
template <int N>
void ShiftedJacobian<Scalar>::reduce(const Linearisation& J, Scalar shift) {
  const int n = size<N>();
  const int entries = J.outputs * n;
  inverse_shift_ = 1.0 / shift;
  const Scalar inverse_shift = inverse_shift_;
  Scalar* K = K_.data();
  for (int k = 0; k < entries; ++k) K[k] = J.by_v[k] + inverse_shift * J.by_q[k];

  invert_own(J, shift);
  const int stride = whole_pairs(n);
  Scalar* lu = lu_.data();
  for_each<N>(n, [&](int j) RPSUP_INLINE_LAMBDA {
    find_response(J, j);
    const NumbersAt<Scalar> firsts = response_.row(2 * j), seconds = response_.row(2 * j + 1);
    for (int i = 0; i < n; ++i) lu[j * stride + i] = -add_up(add_effects(begin_sum(K[i * n + j]), J, i, firsts, seconds));
    lu[j * stride + j] += shift;
  });
}

/// Gauss with partial pivoting, in place. Each column of U is then divided by its pivot, so that substituting waits for no division, and the
/// diagonal is zero, so that a column can be taken in whole pairs.
template <typename Scalar>
template <int N>
bool ShiftedJacobian<Scalar>::factor_reduced() {
  const int n = size<N>();
  const int stride = whole_pairs(n);
  Scalar* lu = lu_.data();
  int* order = order_.data();
  for (int k = 0; k < n; ++k) order[k] = k;
  bool regular = true;
  for_each<N>(n, [&](int k) RPSUP_INLINE_LAMBDA {
    Scalar* column = lu + k * stride;
    int pivot = k;
    double largest = size_of(column[k]);
    for (int i = k + 1; i < n; ++i) {
      if (!(size_of(column[i]) > largest)) [[likely]] continue;
      largest = size_of(column[i]);
      pivot = i;
    }
    if (pivot != k) {
      std::swap(order[k], order[pivot]);
      for (int j = 0; j < n; ++j) std::swap(lu[j * stride + k], lu[j * stride + pivot]);
    }
    regular = regular && largest > 0.0 && std::isfinite(largest);
    const Scalar inverse = 1.0 / column[k];
    inverse_pivot_.data()[k] = inverse;
    for (int i = 0; i < n; ++i) column[i] *= inverse;
    column[k] = Scalar{};
    for (int j = k + 1; j < n; ++j) subtract_scaled(lu[j * stride + k], column, k + 1, n, lu + j * stride);
  });
  return regular;
}

/// x <- of the reduced matrix's inverse and `known`, whose entries are not kept.
template <typename Scalar>
template <int N>
void ShiftedJacobian<Scalar>::solve_reduced(const Scalar* known, Scalar* x) const {
  const int n = size<N>();
  const int stride = whole_pairs(n);
  const Scalar* lu = lu_.data();
  for (int k = 0; k < n; ++k) x[k] = known[order_.data()[k]];
  if (stride > n) x[n] = Scalar{};
  for_each<N>(n, [&](int k) RPSUP_INLINE_LAMBDA { subtract_scaled(x[k], lu + k * stride, k + 1, n, x); });
  for_each<N>(n, [&](int k) RPSUP_INLINE_LAMBDA { subtract_scaled(x[n - 1 - k], lu + (n - 1 - k) * stride, 0, n - 1 - k, x); });
  for (int k = 0; k < n; ++k) x[k] *= inverse_pivot_.data()[k];
}

/// own_z^-1 known_z, two pairs at once; the last one stands for one that is missing.
template <typename Scalar>
template <int N>
RPSUP_INLINE void ShiftedJacobian<Scalar>::start_bristles(const Linearisation& J, NumbersAt<Scalar> z, const Scalar* q, NumbersAt<Scalar> firsts,
                                                          NumbersAt<Scalar> seconds) {
  for (int p = 0; p < J.pairs; p += 2) {
    const int* own = J.bristles + 2 * p;
    const int* next = p + 1 < J.pairs ? own + 2 : own;
    auto first = put_together(z[own[0]], z[next[0]]), second = put_together(z[own[1]], z[next[1]]);
    for_each<N>(size<N>(), [&](int j) RPSUP_INLINE_LAMBDA {
      const double* by_q = J.rates_by_q + 2 * j * J.stride + p;
      first = first + pair(by_q) * q[j];
      second = second + pair(by_q + J.stride) * q[j];
    });
    answer(p, first, second, firsts, seconds);
  }
}

/// Adds the bristles' response to the free rates.
template <typename Scalar>
template <int N>
RPSUP_INLINE void ShiftedJacobian<Scalar>::add_response(int pairs, const Scalar* v, NumbersAt<Scalar> firsts, NumbersAt<Scalar> seconds) {
  for (int p = 0; p < pairs; p += 2) {
    auto first = pair_at(firsts, p), second = pair_at(seconds, p);
    for_each<N>(size<N>(), [&](int j) RPSUP_INLINE_LAMBDA {
      first = first + pair_at(response_.row(2 * j), p) * v[j];
      second = second + pair_at(response_.row(2 * j + 1), p) * v[j];
    });
    set_pair(firsts, p, first);
    set_pair(seconds, p, second);
  }
}

template <typename Scalar>
template <int N>
void ShiftedJacobian<Scalar>::solve_sized(const Linearisation& J, NumbersAt<Scalar> state) {
  // Of a size that the compiler knows, these stay in registers.
  Scalar q_room[N + 1], v_room[N + 1];
  const int n = size<N>();
  Scalar* q = N > 0 ? q_room : scaled_q_.data();
  Scalar* v = N > 0 ? v_room : solution_.data();
  const Scalar inverse_shift = inverse_shift_;
  const NumbersAt<Scalar> z = state.from(2 * n), work = z.from(bristles_);
  const NumbersAt<Scalar> firsts = bristle_.row(0), seconds = bristle_.row(1);
  Scalar* known = known_.data();

  for (int i = 0; i < n; ++i) q[i] = inverse_shift * state[i];
  start_bristles<N>(J, z, q, firsts, seconds);
  for (int i = 0; i < n; ++i) known[i] = add_up(add_effects(add_products(begin_sum(state[n + i]), J.by_q + i * n, q, n), J, i, firsts, seconds));
  solve_reduced<N>(known, v);
  add_response<N>(J.pairs, v, firsts, seconds);
  for (int k = n; k < J.outputs; ++k) {
    const auto by_free = add_products(add_products(begin_sum(work[k - n]), J.by_q + k * n, q, n), K_.data() + k * n, v, n);
    work.set(k - n, inverse_shift * add_up(add_effects(by_free, J, k, firsts, seconds)));
  }
  for (int b = 0; b < bristles_; ++b) z.set(b, inverse_shift * z[b]);
  for (int p = 0; p < J.pairs; ++p) {
    z.set(J.bristles[2 * p], firsts[p]);
    z.set(J.bristles[2 * p + 1], seconds[p]);
  }
  for (int i = 0; i < n; ++i) {
    state.set(i, q[i] + inverse_shift * v[i]);
    state.set(n + i, v[i]);
  }
}

template class ShiftedJacobian<double>;
template class ShiftedJacobian<Complex>;

}  // namespace engine
