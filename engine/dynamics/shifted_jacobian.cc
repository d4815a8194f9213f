#include "engine/dynamics/shifted_jacobian.h"

#include <cmath>
#include <complex>
#include <cstddef>
#include <utility>

namespace engine {

namespace {

using Complex = std::complex<double>;

std::size_t area(int rows, int columns) { return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns); }

/// Two numbers side by side, at any address.
typedef double Pair __attribute__((vector_size(16), aligned(8), may_alias));

[[gnu::always_inline]] inline Pair& pair(double* x) { return *reinterpret_cast<Pair*>(x); }
[[gnu::always_inline]] inline const Pair& pair(const double* x) { return *reinterpret_cast<const Pair*>(x); }

/// Sums of the even and of the odd products: the same on every machine.
[[gnu::always_inline]] inline Pair begin_sum(double first) { return Pair{first, 0.0}; }
[[gnu::always_inline]] inline Pair add_products(Pair sum, const double* a, const double* b, int n) {
  int j = 0;
  for (; j + 1 < n; j += 2) sum += pair(a + j) * pair(b + j);
  if (j < n) sum += Pair{a[j], 0.0} * Pair{b[j], 0.0};
  return sum;
}
[[gnu::always_inline]] inline double add_up(Pair sum) { return sum[0] + sum[1]; }

[[gnu::always_inline]] inline Complex begin_sum(Complex first) { return first; }
template <typename Scalar>
[[gnu::always_inline]] inline Complex add_products(Complex sum, const Scalar* a, const Complex* b, int n) {
  for (int j = 0; j < n; ++j) sum += a[j] * b[j];
  return sum;
}
[[gnu::always_inline]] inline Complex add_up(Complex sum) { return sum; }

template <typename A, typename B>
[[gnu::always_inline]] inline B dot(const A* a, const B* b, int n) {
  return add_up(add_products(begin_sum(B{}), a, b, n));
}

/// y -= factor x from entry `from`, or the pair that holds it, to the one before entry `to`
[[gnu::always_inline]] inline void subtract_scaled(double factor, const double* x, int from, int to, double* y) {
  const Pair both{factor, factor};
  for (int j = from & ~1; j < to; j += 2) pair(y + j) -= both * pair(x + j);
}
[[gnu::always_inline]] inline void subtract_scaled(Complex factor, const Complex* x, int from, int to, Complex* y) {
  for (int j = from; j < to; ++j) y[j] -= factor * x[j];
}

/// A measure of size, the cheapest.
[[gnu::always_inline]] inline double size_of(double x) { return std::abs(x); }
[[gnu::always_inline]] inline double size_of(Complex x) { return std::abs(x.real()) + std::abs(x.imag()); }

/// Calls f(0), ..., f(n - 1); with each index known to the compiler if n is.
template <int N, typename Function>
[[gnu::always_inline]] inline void for_each(int n, const Function& f) {
  if constexpr (N > 0)
    [&]<int... k>(std::integer_sequence<int, k...>) { (f(k), ...); }(std::make_integer_sequence<int, N>{});
  else
    for (int k = 0; k < n; ++k) f(k);
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
ShiftedJacobian<Scalar>::ShiftedJacobian(int free_coordinates, int bristles, int drives) : free_(free_coordinates) {
  const int outputs = free_ + bristles + drives + 3;
  K_.resize(area(outputs, free_));
  bristle_inverse_.resize(area(bristles, 2));
  response_.resize(area(bristles, free_));
  lu_.resize(area(whole_pairs(free_), whole_pairs(free_)));
  inverse_pivot_.resize(area(free_, 1));
  order_.resize(area(free_, 1));
  scaled_q_.resize(area(whole_pairs(free_), 1));
  solution_.resize(area(whole_pairs(free_), 1));
  known_.resize(area(outputs, 1));
  bristle_.resize(area(bristles, 1));
}

template <typename Scalar>
bool ShiftedJacobian<Scalar>::factor(const StateJacobian& J, Scalar shift) {
  return with_size(free_, [&]<int N>() {
    reduce<N>(J, shift);
    return factor_reduced<N>();
  });
}

template <typename Scalar>
void ShiftedJacobian<Scalar>::solve_in_place(const StateJacobian& J, Scalar* x) {
  with_size(free_, [&]<int N>() { solve_sized<N>(J, x); });
}

/// K, the bristles' own part and the matrix of the free coordinates.
template <typename Scalar>
template <int N>
void ShiftedJacobian<Scalar>::reduce(const StateJacobian& J, Scalar shift) {
  const int n = size<N>();
  const int bristles = J.bristles();
  const int acting = J.acting();
  const int entries = (n + acting + J.rates_of_work()) * n;
  inverse_shift_ = 1.0 / shift;
  const Scalar inverse_shift = inverse_shift_;
  const double* by_q = J.by_q();
  const double* by_v = J.by_v();
  Scalar* K = K_.data();
  for (int k = 0; k < entries; ++k) K[k] = by_v[k] + inverse_shift * by_q[k];

  Scalar* response = response_.data();
  for (int b = 0; b < acting; b += 2) {
    const double* by_own = J.by_bristle() + (n + b) * bristles + b;
    const Scalar a00 = shift - by_own[0], a01 = -by_own[1];
    const Scalar a10 = -by_own[bristles], a11 = shift - by_own[bristles + 1];
    const Scalar inverse_determinant = 1.0 / (a00 * a11 - a01 * a10);
    Scalar* inverse = bristle_inverse_.data() + 2 * b;
    inverse[0] = a11 * inverse_determinant;
    inverse[1] = -a01 * inverse_determinant;
    inverse[2] = -a10 * inverse_determinant;
    inverse[3] = a00 * inverse_determinant;
    const Scalar* first = K + (n + b) * n;
    const Scalar* second = first + n;
    for (int j = 0; j < n; ++j) {
      response[b * n + j] = inverse[0] * first[j] + inverse[1] * second[j];
      response[(b + 1) * n + j] = inverse[2] * first[j] + inverse[3] * second[j];
    }
  }

  const int stride = whole_pairs(n);
  Scalar* lu = lu_.data();
  for (int i = 0; i < n; ++i) {
    const double* by_bristle = J.by_bristle() + i * bristles;
    for_each<N>(n, [&](int j) {
      Scalar entry = K[i * n + j];
      for (int b = 0; b < acting; ++b) entry += by_bristle[b] * response[b * n + j];
      lu[j * stride + i] = -entry;
    });
    lu[i * stride + i] += shift;
  }
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
  for_each<N>(n, [&](int k) {
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
  for_each<N>(n, [&](int k) { subtract_scaled(x[k], lu + k * stride, k + 1, n, x); });
  for_each<N>(n, [&](int k) { subtract_scaled(x[n - 1 - k], lu + (n - 1 - k) * stride, 0, n - 1 - k, x); });
  for (int k = 0; k < n; ++k) x[k] *= inverse_pivot_.data()[k];
}

template <typename Scalar>
template <int N>
void ShiftedJacobian<Scalar>::solve_sized(const StateJacobian& J, Scalar* state) {
  // Of a size that the compiler knows, these stay in registers.
  Scalar q_room[N + 1], v_room[N + 1];
  const int n = size<N>();
  Scalar* q = N > 0 ? q_room : scaled_q_.data();
  Scalar* v = N > 0 ? v_room : solution_.data();
  const int bristles = J.bristles();
  const int acting = J.acting();
  const Scalar inverse_shift = inverse_shift_;
  Scalar* z = state + 2 * n;
  Scalar* work = z + bristles;
  Scalar* known = known_.data();
  Scalar* bristle = bristle_.data();
  const double* by_q = J.by_q();
  const double* by_bristle = J.by_bristle();
  const Scalar* K = K_.data();
  const auto answer = [&](int b) {
    const Scalar* inverse = bristle_inverse_.data() + 2 * b;
    bristle[b] = inverse[0] * known[n + b] + inverse[1] * known[n + b + 1];
    bristle[b + 1] = inverse[2] * known[n + b] + inverse[3] * known[n + b + 1];
  };

  for (int i = 0; i < n; ++i) q[i] = inverse_shift * state[i];
  for (int b = 0; b < acting; ++b) known[n + b] = z[J.acting_bristles()[b]] + dot(by_q + (n + b) * n, q, n);
  for (int b = 0; b < acting; b += 2) answer(b);
  for (int i = 0; i < n; ++i)
    known[i] = add_up(add_products(add_products(begin_sum(state[n + i]), by_q + i * n, q, n), by_bristle + i * bristles, bristle, acting));
  solve_reduced<N>(known, v);
  for (int b = 0; b < acting; ++b) known[n + b] += dot(K + (n + b) * n, v, n);
  for (int b = 0; b < acting; b += 2) answer(b);
  const int first = n + acting;
  for (int k = first; k < first + J.rates_of_work(); ++k) {
    const auto by_free = add_products(add_products(begin_sum(work[k - first]), by_q + k * n, q, n), K + k * n, v, n);
    work[k - first] = inverse_shift * add_up(add_products(by_free, by_bristle + k * bristles, bristle, acting));
  }
  for (int b = 0; b < bristles; ++b) z[b] *= inverse_shift;
  for (int b = 0; b < acting; ++b) z[J.acting_bristles()[b]] = bristle[b];
  for (int i = 0; i < n; ++i) {
    state[i] = q[i] + inverse_shift * v[i];
    state[n + i] = v[i];
  }
}

template class ShiftedJacobian<double>;
template class ShiftedJacobian<Complex>;

}  // namespace engine
