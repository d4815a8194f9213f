// SPDX-License-Identifier: Apache-2.0
// Compiled once for each instruction set: RPSUP_INSTRUCTION_SET is its name.
#include "engine/dynamics/kernel/newton/newton_matrix.h"

#include <cstddef>
#include <utility>

#include "engine/math/complex.h"
#include "engine/math/finite.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

namespace {

constexpr int kLanes = RowLanes::kCount;
static_assert(kLanes <= 4, "behind the rates of a state stand no more than the three losses, which are read with them");

/// The first of several numbers that are taken at once, the i-th among them.
constexpr int start_of(int i) { return i / kLanes * kLanes; }

RPSUP_INLINE RowLanes widen(double x) { return RowLanes::all(x); }
RPSUP_INLINE Complex<RowLanes> widen(const Complex<double>& x) { return {RowLanes::all(x.real), RowLanes::all(x.imag)}; }

RPSUP_INLINE RowLanes add_to(const RowLanes& a, const RowLanes& real) { return a + real; }
RPSUP_INLINE Complex<RowLanes> add_to(const Complex<RowLanes>& a, const RowLanes& real) { return {a.real + real, a.imag}; }

RPSUP_INLINE RowLanes pick(const double* from, const int* which) {
  RowLanes picked;
  for (int lane = 0; lane < kLanes; ++lane) picked.set(lane, from[which[lane]]);
  return picked;
}
RPSUP_INLINE RowLanes pick(NumbersAt<double> from, const int* which) { return pick(from.at, which); }
RPSUP_INLINE Complex<RowLanes> pick(NumbersAt<Complex<double>> from, const int* which) { return {pick(from.real, which), pick(from.imag, which)}; }

/// Numbers that have just been stored one by one, or in smaller blocks: taken as a block, they would have to get to memory first.
RPSUP_INLINE RowLanes collect(const double* from) {
  RowLanes numbers;
  for (int lane = 0; lane < kLanes; ++lane) numbers.set(lane, from[lane]);
  return numbers;
}
RPSUP_INLINE RowLanes collect(NumbersAt<double> from, int i) { return collect(from.at + i); }
RPSUP_INLINE Complex<RowLanes> collect(NumbersAt<Complex<double>> from, int i) { return {collect(from.real + i), collect(from.imag + i)}; }

/// Those of the numbers from entry i on that stand behind entry k; zeros elsewhere.
RPSUP_INLINE RowLanes keep_behind(const RowLanes& numbers, int i, int k) {
  RowLanes places;
  for (int lane = 0; lane < kLanes; ++lane) places.set(lane, i + lane);
  return choose_greater(places, RowLanes::all(k), numbers, RowLanes{});
}
RPSUP_INLINE Complex<RowLanes> keep_behind(const Complex<RowLanes>& numbers, int i, int k) {
  return {keep_behind(numbers.real, i, k), keep_behind(numbers.imag, i, k)};
}

/// y -= factor x from entry `from`, or those that are taken with it, to the entry `last`
template <typename Scalar>
RPSUP_INLINE void subtract_scaled(const Scalar& factor, NumbersAt<Scalar> x, int from, int last, NumbersAt<Scalar> y) {
  for (int i = start_of(from); i <= last; i += kLanes) y.store(i, y.load(i) - factor * x.load(i));
}

/// Sizes of StateJacobian: free coordinates, rows of a column before the works, rows of a column, and from one row of pairs of bristles to the next.
struct AnySizes {
  int n, rows, column, pairs;
};
/// Known to the compiler, with few bristles.
template <int coordinates>
struct SizesOfFew {
  static constexpr int n = coordinates, rows = StateJacobian::in_blocks(n), column = rows + StateJacobian::kFewestWorks;
  static constexpr int pairs = StateJacobian::kBlock;
};
/// The same with many bristles.
template <int coordinates>
struct SizesOfMany {
  static constexpr int n = coordinates, rows = SizesOfFew<n>::rows, column = SizesOfFew<n>::column;
  int pairs;
};

/// Calls f with the sizes of J: of the rigid linkage and of the flexible one of four elements the compiler knows them.
template <typename Function>
auto with_sizes(const StateJacobian& J, const Function& f) {
  const bool usual = J.stride == J.first_work + StateJacobian::kFewestWorks, few = J.pair_stride == StateJacobian::kBlock;
  if (usual && J.free == 5) return few ? f(SizesOfFew<5>()) : f(SizesOfMany<5>{J.pair_stride});
  if (usual && J.free == 14) return few ? f(SizesOfFew<14>()) : f(SizesOfMany<14>{J.pair_stride});
  return f(AnySizes{J.free, J.first_work, J.stride, J.pair_stride});
}

/// Calls f(0), f(1), ... of the free coordinates; with each index known to the compiler if their number is.
template <typename Sizes, typename Function>
RPSUP_INLINE void each_coordinate(const Sizes&, const Function& f) {
  [&]<int... k>(std::integer_sequence<int, k...>) RPSUP_INLINE_LAMBDA { (f(k), ...); }(std::make_integer_sequence<int, Sizes::n>{});
}
template <typename Function>
RPSUP_INLINE void each_coordinate(const AnySizes& size, const Function& f) {
  for (int k = 0; k < size.n; ++k) f(k);
}

/// Bristles of several pairs: own_z^-1 of what is known of them. @param inverse  its rows
template <typename Scalar, typename WideScalar>
RPSUP_INLINE void answer(const RowsAt<Scalar>& inverse, int pair, const WideScalar& first, const WideScalar& second, NumbersAt<Scalar> firsts,
                         NumbersAt<Scalar> seconds) {
  const auto of = [&](int row) RPSUP_INLINE_LAMBDA { return inverse.row(row).load(pair); };
  const WideScalar answer_first = of(0) * first + of(1) * second, answer_second = of(2) * first + of(3) * second;
  firsts.store(pair, answer_first);
  seconds.store(pair, answer_second);
}

/// @returns sum + by_z z of some outputs. @param by_z  of them, by the first bristle; the others stand a column further each
template <typename Sizes, typename Scalar, typename WideScalar>
[[nodiscard]] RPSUP_INLINE WideScalar add_effects(const Sizes& size, WideScalar sum, const double* by_z, int pairs, NumbersAt<Scalar> firsts,
                                                  NumbersAt<Scalar> seconds) {
  for (int p = 0; p < pairs; ++p, by_z += 2 * size.column)
    sum += RowLanes::load(by_z) * widen(firsts[p]) + RowLanes::load(by_z + size.column) * widen(seconds[p]);
  return sum;
}

}  // namespace

template <typename Scalar>
ShiftedJacobian<Scalar>::ShiftedJacobian(const StateJacobian& J)
    : J_(J),
      own_inverse_(4, J.pair_stride),
      response_(2 * J.free, J.pair_stride),
      lower_(J.free, J.first_work),
      upper_(J.free, J.first_work),
      condensed_w_(J.free, J.stride - J.first_work),
      inverse_pivot_(1, J.first_work),
      order_(static_cast<std::size_t>(J.first_work)),
      bristle_(2, J.pair_stride),
      scaled_q_(1, J.first_work),
      v_(1, J.first_work),
      known_(1, J.stride) {}

template <typename Scalar>
bool ShiftedJacobian<Scalar>::factor(const Scalar& shift) {
  return with_sizes(J_, [&](const auto& size) {
    reduce(size, shift);
    return factor_reduced(size);
  });
}

template <typename Scalar>
void ShiftedJacobian<Scalar>::solve_in_place(NumbersAt<Scalar> x) {
  with_sizes(J_, [&](const auto& size) { solve_sized(size, x); });
}

template <typename Scalar>
template <typename Sizes>
RPSUP_INLINE void ShiftedJacobian<Scalar>::invert_own(const Sizes& size, const Scalar& shift) {
  const double* by_own = J_.matrices->rates_by_own.data();
  const RowsAt<Scalar> inverse = own_inverse_.rows(size.pairs);
  const int pairs = J_.pairs;
  const WideScalar shifts = widen(shift);
  for (int p = 0; p < pairs; p += kLanes) {
    const auto own = [&](int row) RPSUP_INLINE_LAMBDA { return RowLanes::load(by_own + row * size.pairs + p); };
    const WideScalar a00 = add_to(shifts, -own(0)), a11 = add_to(shifts, -own(3));
    const RowLanes a01 = -own(1), a10 = -own(2);
    const WideScalar inverse_determinant = 1.0 / add_to(a00 * a11, -(a01 * a10));
    inverse.row(0).store(p, a11 * inverse_determinant);
    inverse.row(1).store(p, -a01 * inverse_determinant);
    inverse.row(2).store(p, -a10 * inverse_determinant);
    inverse.row(3).store(p, a00 * inverse_determinant);
  }
}

/// own_z^-1 K_z
template <typename Scalar>
template <typename Sizes>
RPSUP_INLINE void ShiftedJacobian<Scalar>::find_response(const Sizes& size, const Scalar& inverse_shift) {
  const double *by_q = J_.matrices->rates_by_q.data(), *by_v = J_.matrices->rates_by_v.data();
  const RowsAt<Scalar> inverse = own_inverse_.rows(size.pairs), response = response_.rows(size.pairs);
  const int pairs = J_.pairs;
  const auto K = [&](int i) RPSUP_INLINE_LAMBDA { return RowLanes::load(by_v + i) + RowLanes::load(by_q + i) * widen(inverse_shift); };
  for (int p = 0; p < pairs; p += kLanes)
    for (int j = 0; j < size.n; ++j) {
      const int first = 2 * j * size.pairs + p;
      answer(inverse, p, K(first), K(first + size.pairs), response.row(2 * j), response.row(2 * j + 1));
    }
}

/// The bristles' own part and the matrix of the free coordinates.
template <typename Scalar>
template <typename Sizes>
RPSUP_INLINE void ShiftedJacobian<Scalar>::reduce(const Sizes& size, const Scalar& shift) {
  const Scalar inverse_shift = 1.0 / shift;
  inverse_shift_ = inverse_shift;
  invert_own(size, shift);
  find_response(size, inverse_shift);
  const StateJacobian::Matrices& J = *J_.matrices;
  const double *by_v = J.by_v.data(), *by_q = J.by_q.data(), *by_z = J.by_bristle.data();
  const RowsAt<Scalar> lower = lower_.rows(size.rows), condensed_w = condensed_w_.rows(size.column - size.rows);
  const RowsAt<Scalar> response = response_.rows(size.pairs);
  const int pairs = J_.pairs, works = J_.works;
  for (int j = 0; j < size.n; ++j) {
    const auto condensed = [&](int row) RPSUP_INLINE_LAMBDA {
      const int i = j * size.column + row;
      const WideScalar K = RowLanes::load(by_v + i) + RowLanes::load(by_q + i) * widen(inverse_shift);
      return add_effects(size, K, by_z + row, pairs, response.row(2 * j), response.row(2 * j + 1));
    };
    const NumbersAt<Scalar> column = lower.row(j), column_w = condensed_w.row(j);
    for (int i = 0; i < size.n; i += kLanes) column.store(i, -condensed(i));
    for (int k = 0; k < works; k += kLanes) column_w.store(k, condensed(size.rows + k));
    column.set(j, shift + column[j]);
  }
}

/// Gauss with partial pivoting. Each column of U is divided by its pivot, so that substituting waits for no division; L and U stand apart, with zeros
/// elsewhere, so that several rows can be taken at once.
template <typename Scalar>
template <typename Sizes>
RPSUP_INLINE bool ShiftedJacobian<Scalar>::factor_reduced(const Sizes& size) {
  const RowsAt<Scalar> lower = lower_.rows(size.rows), upper = upper_.rows(size.rows);
  const NumbersAt<Scalar> inverse_pivot = inverse_pivot_.first();
  int* order = order_.data();
  for (int k = 0; k < size.rows; ++k) order[k] = k;
  bool regular = true;
  each_coordinate(size, [&](int k) RPSUP_INLINE_LAMBDA {
    const NumbersAt<Scalar> column = lower.row(k), above = upper.row(k);
    int pivot = k;
    double largest = size_of(column[k]);
    for (int i = k + 1; i < size.n; ++i) {
      if (!(size_of(column[i]) > largest)) [[likely]] continue;
      largest = size_of(column[i]);
      pivot = i;
    }
    if (pivot != k) {
      std::swap(order[k], order[pivot]);
      for (int j = 0; j < size.n; ++j) {
        const Scalar moved = lower.row(j)[k];
        lower.row(j).set(k, lower.row(j)[pivot]);
        lower.row(j).set(pivot, moved);
      }
    }
    regular = regular && largest > 0.0 && is_number(largest);
    const Scalar inverse = 1.0 / column[k];
    inverse_pivot.set(k, inverse);
    for (int i = 0; i < size.n; i += kLanes) {
      const WideScalar scaled = inverse * column.load(i);
      column.store(i, keep_behind(scaled, i, k));
      above.store(i, scaled - keep_behind(scaled, i, k - 1));
    }
    for (int j = k + 1; j < size.n; ++j) subtract_scaled(lower.row(j)[k], column, k + 1, size.n - 1, lower.row(j));
  });
  return regular;
}

/// v <- of the reduced matrix's inverse and `known`
template <typename Scalar>
template <typename Sizes>
RPSUP_INLINE void ShiftedJacobian<Scalar>::solve_reduced(const Sizes& size, NumbersAt<Scalar> known, NumbersAt<Scalar> v) {
  const RowsAt<Scalar> lower = lower_.rows(size.rows), upper = upper_.rows(size.rows);
  const NumbersAt<Scalar> inverse_pivot = inverse_pivot_.first();
  const int* order = order_.data();
  for (int i = 0; i < size.n; i += kLanes) v.store(i, pick(known, order + i));
  each_coordinate(size, [&](int k) RPSUP_INLINE_LAMBDA { subtract_scaled(v[k], lower.row(k), k + 1, size.n - 1, v); });
  each_coordinate(size, [&](int from_last) RPSUP_INLINE_LAMBDA {
    const int k = size.n - 1 - from_last;
    subtract_scaled(v[k], upper.row(k), 0, k - 1, v);
  });
  for (int i = 0; i < size.n; i += kLanes) v.store(i, inverse_pivot.load(i) * v.load(i));
}

/// own_z^-1 (z + by_q q / shift), several pairs at once: the last one stands for those that are missing.
template <typename Scalar>
template <typename Sizes>
RPSUP_INLINE void ShiftedJacobian<Scalar>::start_bristles(const Sizes& size, NumbersAt<Scalar> z, NumbersAt<Scalar> scaled_q) {
  const int* acting = J_.acting.data();
  const double* by_q = J_.matrices->rates_by_q.data();
  const RowsAt<Scalar> inverse = own_inverse_.rows(size.pairs), bristle = bristle_.rows(size.pairs);
  const int pairs = J_.pairs;
  for (int p = 0; p < pairs; p += kLanes) {
    int first_of[kLanes], second_of[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) {
      const int* pair = acting + 2 * (p + lane < pairs ? p + lane : pairs - 1);
      first_of[lane] = pair[0];
      second_of[lane] = pair[1];
    }
    WideScalar first = pick(z, first_of), second = pick(z, second_of);
    for (int j = 0; j < size.n; ++j) {
      const WideScalar by = widen(scaled_q[j]);
      first += RowLanes::load(by_q + 2 * j * size.pairs + p) * by;
      second += RowLanes::load(by_q + (2 * j + 1) * size.pairs + p) * by;
    }
    answer(inverse, p, first, second, bristle.row(0), bristle.row(1));
  }
}

/// Adds the bristles' response to the free rates.
template <typename Scalar>
template <typename Sizes>
RPSUP_INLINE void ShiftedJacobian<Scalar>::add_response(const Sizes& size, NumbersAt<Scalar> v) {
  const RowsAt<Scalar> response = response_.rows(size.pairs), bristle = bristle_.rows(size.pairs);
  const int pairs = J_.pairs;
  for (int p = 0; p < pairs; p += kLanes) {
    WideScalar first = bristle.row(0).load(p), second = bristle.row(1).load(p);
    for (int j = 0; j < size.n; ++j) {
      const WideScalar by = widen(v[j]);
      first += response.row(2 * j).load(p) * by;
      second += response.row(2 * j + 1).load(p) * by;
    }
    bristle.row(0).store(p, first);
    bristle.row(1).store(p, second);
  }
}

template <typename Scalar>
template <typename Sizes>
RPSUP_INLINE void ShiftedJacobian<Scalar>::solve_sized(const Sizes& size, NumbersAt<Scalar> state) {
  const int bristles = J_.bristles, pairs = J_.pairs, works = J_.works;
  const int* acting = J_.acting.data();
  const double *by_q = J_.matrices->by_q.data(), *by_z = J_.matrices->by_bristle.data();
  const NumbersAt<Scalar> rates = state.from(size.n), z = rates.from(size.n), work = z.from(bristles);
  const NumbersAt<Scalar> scaled_q = scaled_q_.first(), v = v_.first(), known = known_.first(), known_w = known.from(size.rows);
  const RowsAt<Scalar> bristle = bristle_.rows(size.pairs), condensed_w = condensed_w_.rows(size.column - size.rows);
  const Scalar inverse_shift = inverse_shift_;

  for (int i = 0; i < size.n; i += kLanes) scaled_q.store(i, inverse_shift * collect(state, i));
  start_bristles(size, z, scaled_q);
  const auto add_known = [&](WideScalar sum, int row) RPSUP_INLINE_LAMBDA {
    for (int j = 0; j < size.n; ++j) sum += RowLanes::load(by_q + j * size.column + row) * widen(scaled_q[j]);
    return add_effects(size, sum, by_z + row, pairs, bristle.row(0), bristle.row(1));
  };
  for (int i = 0; i < size.n; i += kLanes) known.store(i, add_known(collect(rates, i), i));  // what lies behind the rates has no effect on them
  solve_reduced(size, known, v);
  for (int k = 0; k < works; k += kLanes) {
    WideScalar sum = add_known(widen(Scalar{}), size.rows + k);
    for (int j = 0; j < size.n; ++j) sum += condensed_w.row(j).load(k) * widen(v[j]);
    known_w.store(k, sum);
  }
  add_response(size, v);
  for (int i = 0; i < size.n; ++i) {
    state.set(i, scaled_q[i] + inverse_shift * v[i]);
    rates.set(i, v[i]);
  }
  for (int b = 0; b < bristles; ++b) z.set(b, inverse_shift * z[b]);
  for (int p = 0; p < pairs; ++p) {
    z.set(acting[2 * p], bristle.row(0)[p]);
    z.set(acting[2 * p + 1], bristle.row(1)[p]);
  }
  for (int k = 0; k < works; ++k) work.set(k, inverse_shift * (work[k] + known_w[k]));
}

template class ShiftedJacobian<double>;
template class ShiftedJacobian<Complex<double>>;

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
