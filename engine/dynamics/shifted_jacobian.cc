#include "engine/dynamics/shifted_jacobian.h"

#include <cmath>
#include <cstddef>
#include <utility>

namespace engine {

namespace {

std::size_t area(int rows, int columns) { return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns); }

/// Two numbers side by side, at any address.
typedef double Pair __attribute__((vector_size(16), aligned(8), may_alias));

[[gnu::always_inline]] inline Pair& pair(double* x) { return *reinterpret_cast<Pair*>(x); }
[[gnu::always_inline]] inline const Pair& pair(const double* x) { return *reinterpret_cast<const Pair*>(x); }

/// Sums of the even and of the odd products: the same on every machine.
[[gnu::always_inline]] inline Pair add_products(Pair sum, const double* a, const double* b, int n) {
  int j = 0;
  for (; j + 1 < n; j += 2) sum += pair(a + j) * pair(b + j);
  if (j < n) sum += Pair{a[j], 0.0} * Pair{b[j], 0.0};
  return sum;
}

[[gnu::always_inline]] inline double add_up(Pair sum) { return sum[0] + sum[1]; }

[[gnu::always_inline]] inline double dot(const double* a, const double* b, int n) { return add_up(add_products(Pair{0.0, 0.0}, a, b, n)); }

/// y -= factor x from the pair that holds entry `from` to the one before entry `to`
[[gnu::always_inline]] inline void subtract_scaled(double factor, const double* x, int from, int to, double* y) {
  const Pair both{factor, factor};
  for (int j = from & ~1; j < to; j += 2) pair(y + j) -= both * pair(x + j);
}

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

ShiftedJacobian::ShiftedJacobian(int free_coordinates, int bristles, int drives)
    : free_(free_coordinates), bristles_(bristles), rates_of_work_(drives + 3) {
  const int outputs = free_ + bristles_ + rates_of_work_;
  by_q_.resize(area(outputs, free_));
  by_v_.resize(area(outputs, free_));
  by_bristle_.resize(area(outputs, bristles_));
  by_t_.resize(area(outputs, 1));
  acting_.resize(area(bristles_, 1));
  derivatives_ = {outputs, 0, acting_.data(), by_q_.data(), by_v_.data(), by_t_.data(), by_bristle_.data()};
  K_.resize(by_v_.size() + 1);  // one more: rows are read in pairs
  bristle_inverse_.resize(area(bristles_, 2));
  response_.resize(area(bristles_, free_) + 1);
  lu_.resize(area(whole_pairs(free_), whole_pairs(free_)));
  inverse_pivot_.resize(area(free_, 1));
  order_.resize(area(free_, 1));
  scaled_q_.resize(area(whole_pairs(free_), 1));
  solution_.resize(area(whole_pairs(free_), 1));
  known_.resize(area(outputs, 1));
  bristle_.resize(area(bristles_, 1));
}

void ShiftedJacobian::calc_time_derivative(Eigen::VectorXd& by_t) const {
  const int acting = derivatives_.bristle_count;
  by_t.setZero(2 * free_ + bristles_ + rates_of_work_);
  double* to = by_t.data() + free_;
  const double* from = by_t_.data();
  for (int i = 0; i < free_; ++i) to[i] = from[i];
  for (int b = 0; b < acting; ++b) to[free_ + acting_.data()[b]] = from[free_ + b];
  for (int i = 0; i < rates_of_work_; ++i) to[free_ + bristles_ + i] = from[free_ + acting + i];
}

bool ShiftedJacobian::factor(double shift) {
  return with_size(free_, [&]<int N>() { return factor_sized<N>(shift); });
}

void ShiftedJacobian::solve_in_place(Eigen::VectorXd& x) {
  with_size(free_, [&]<int N>() { solve_sized<N>(x.data()); });
}

template <int N>
bool ShiftedJacobian::factor_sized(double shift) {
  reduce<N>(shift);
  return factor_reduced<N>();
}

/// K, the bristles' own part and the matrix of the free coordinates.
template <int N>
void ShiftedJacobian::reduce(double shift) {
  const int n = size<N>();
  const int acting = derivatives_.bristle_count;
  const int entries = (n + acting + rates_of_work_) * n;
  inverse_shift_ = 1.0 / shift;
  const double inverse_shift = inverse_shift_;
  const double* by_q = by_q_.data();
  const double* by_v = by_v_.data();
  double* K = K_.data();
  for (int k = 0; k < entries; ++k) K[k] = by_v[k] + inverse_shift * by_q[k];

  double* response = response_.data();
  for (int b = 0; b < acting; b += 2) {
    const double* by_own = by_bristle_.data() + (n + b) * bristles_ + b;
    const double a00 = shift - by_own[0], a01 = -by_own[1];
    const double a10 = -by_own[bristles_], a11 = shift - by_own[bristles_ + 1];
    const double inverse_determinant = 1.0 / (a00 * a11 - a01 * a10);
    double* inverse = bristle_inverse_.data() + 2 * b;
    inverse[0] = a11 * inverse_determinant;
    inverse[1] = -a01 * inverse_determinant;
    inverse[2] = -a10 * inverse_determinant;
    inverse[3] = a00 * inverse_determinant;
    const double* first = K + (n + b) * n;
    const double* second = first + n;
    for (int j = 0; j < n; ++j) {
      response[b * n + j] = inverse[0] * first[j] + inverse[1] * second[j];
      response[(b + 1) * n + j] = inverse[2] * first[j] + inverse[3] * second[j];
    }
  }

  const int stride = whole_pairs(n);
  double* lu = lu_.data();
  for (int i = 0; i < n; ++i) {
    const double* by_bristle = by_bristle_.data() + i * bristles_;
    for_each<whole_pairs(N) / 2>(stride / 2, [&](int half) {
      const int j = 2 * half;
      Pair entry = pair(K + i * n + j);
      for (int b = 0; b < acting; ++b) entry += by_bristle[b] * pair(response + b * n + j);
      lu[j * stride + i] = -entry[0];
      lu[(j + 1) * stride + i] = -entry[1];
    });
    lu[i * stride + i] += shift;
  }
}

/// Gauss with partial pivoting, in place. Each column of U is then divided by its pivot, so that substituting waits for no division, and the
/// diagonal is zero, so that a column can be taken in whole pairs.
template <int N>
bool ShiftedJacobian::factor_reduced() {
  const int n = size<N>();
  const int stride = whole_pairs(n);
  double* lu = lu_.data();
  int* order = order_.data();
  for (int k = 0; k < n; ++k) order[k] = k;
  bool regular = true;
  for_each<N>(n, [&](int k) {
    double* column = lu + k * stride;
    int pivot = k;
    double largest = std::abs(column[k]);
    for (int i = k + 1; i < n; ++i) {
      if (!(std::abs(column[i]) > largest)) [[likely]] continue;
      largest = std::abs(column[i]);
      pivot = i;
    }
    if (pivot != k) {
      std::swap(order[k], order[pivot]);
      for (int j = 0; j < n; ++j) std::swap(lu[j * stride + k], lu[j * stride + pivot]);
    }
    regular = regular && largest > 0.0 && std::isfinite(largest);
    const double inverse = 1.0 / column[k];
    inverse_pivot_.data()[k] = inverse;
    for (int i = 0; i < stride; i += 2) pair(column + i) *= inverse;
    column[k] = 0.0;
    for (int j = k + 1; j < n; ++j) subtract_scaled(lu[j * stride + k], column, k + 1, n, lu + j * stride);
  });
  return regular;
}

/// x <- of the reduced matrix's inverse and `known`, whose entries are not kept.
template <int N>
void ShiftedJacobian::solve_reduced(const double* known, double* x) const {
  const int n = size<N>();
  const int stride = whole_pairs(n);
  const double* lu = lu_.data();
  for (int k = 0; k < n; ++k) x[k] = known[order_.data()[k]];
  if (stride > n) x[n] = 0.0;
  for_each<N>(n, [&](int k) { subtract_scaled(x[k], lu + k * stride, k + 1, n, x); });
  for_each<N>(n, [&](int k) { subtract_scaled(x[n - 1 - k], lu + (n - 1 - k) * stride, 0, n - 1 - k, x); });
  for (int k = 0; k < n; ++k) x[k] *= inverse_pivot_.data()[k];
}

template <int N>
void ShiftedJacobian::solve_sized(double* state) {
  // Of a size that the compiler knows, these stay in registers.
  double q_room[N + 1], v_room[N + 1];
  const int n = size<N>();
  double* q = N > 0 ? q_room : scaled_q_.data();
  double* v = N > 0 ? v_room : solution_.data();
  const int acting = derivatives_.bristle_count;
  const double inverse_shift = inverse_shift_;
  double* z = state + 2 * n;
  double* work = z + bristles_;
  double* known = known_.data();
  double* bristle = bristle_.data();
  const double* by_q = by_q_.data();
  const double* by_bristle = by_bristle_.data();
  const double* K = K_.data();
  const auto answer = [&](int b) {
    const double* inverse = bristle_inverse_.data() + 2 * b;
    bristle[b] = inverse[0] * known[n + b] + inverse[1] * known[n + b + 1];
    bristle[b + 1] = inverse[2] * known[n + b] + inverse[3] * known[n + b + 1];
  };

  for (int i = 0; i < n; ++i) q[i] = inverse_shift * state[i];
  for (int b = 0; b < acting; ++b) known[n + b] = z[acting_.data()[b]] + dot(by_q + (n + b) * n, q, n);
  for (int b = 0; b < acting; b += 2) answer(b);
  for (int i = 0; i < n; ++i)
    known[i] = add_up(add_products(add_products(Pair{state[n + i], 0.0}, by_q + i * n, q, n), by_bristle + i * bristles_, bristle, acting));
  solve_reduced<N>(known, v);
  for (int b = 0; b < acting; ++b) known[n + b] += dot(K + (n + b) * n, v, n);
  for (int b = 0; b < acting; b += 2) answer(b);
  const int first = n + acting;
  for (int k = first; k < first + rates_of_work_; ++k) {
    const Pair by_free = add_products(add_products(Pair{work[k - first], 0.0}, by_q + k * n, q, n), K + k * n, v, n);
    work[k - first] = inverse_shift * add_up(add_products(by_free, by_bristle + k * bristles_, bristle, acting));
  }
  for (int b = 0; b < bristles_; ++b) z[b] *= inverse_shift;
  for (int b = 0; b < acting; ++b) z[acting_.data()[b]] = bristle[b];
  for (int i = 0; i < n; ++i) {
    state[i] = q[i] + inverse_shift * v[i];
    state[n + i] = v[i];
  }
}

}  // namespace engine
