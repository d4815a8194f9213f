// SPDX-License-Identifier: Apache-2.0
// Compiled once for each instruction set: RPSUP_INSTRUCTION_SET is its name.
#include "engine/dynamics/kernel/newton/newton_matrix.h"

#include <utility>

#include "engine/math/complex.h"
#include "engine/math/finite.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

namespace {

constexpr int kRowLanes = RowLanes::kCount;
static_assert(
    kRowLanes <= 4,
    "a pack that reads the last rates of a state may read the three losses behind them, but no more");

/// Index of the first number of the pack that contains number i.
constexpr int start_of(int i) { return i / kRowLanes * kRowLanes; }

RPSUP_INLINE RowLanes widen(double x) { return RowLanes::all(x); }
RPSUP_INLINE Complex<RowLanes> widen(const Complex<double>& x) {
  return {RowLanes::all(x.real), RowLanes::all(x.imag)};
}

RPSUP_INLINE RowLanes add_to(const RowLanes& a, const RowLanes& real) { return a + real; }
RPSUP_INLINE Complex<RowLanes> add_to(const Complex<RowLanes>& a, const RowLanes& real) {
  return {a.real + real, a.imag};
}

RPSUP_INLINE RowLanes gather(const double* from, const int* which) {
  RowLanes picked;
  for (int lane = 0; lane < kRowLanes; ++lane) picked.set(lane, from[which[lane]]);
  return picked;
}
RPSUP_INLINE RowLanes gather(NumbersAt<double> from, const int* which) { return gather(from.at, which); }
RPSUP_INLINE Complex<RowLanes> gather(NumbersAt<Complex<double>> from, const int* which) {
  return {gather(from.real, which), gather(from.imag, which)};
}

/// Loads numbers one by one that have just been stored one by one: a pack would wait until they have got to
/// memory.
RPSUP_INLINE RowLanes collect(const double* from) {
  RowLanes numbers;
  for (int lane = 0; lane < kRowLanes; ++lane) numbers.set(lane, from[lane]);
  return numbers;
}
RPSUP_INLINE RowLanes collect(NumbersAt<double> from, int i) { return collect(from.at + i); }
RPSUP_INLINE Complex<RowLanes> collect(NumbersAt<Complex<double>> from, int i) {
  return {collect(from.real + i), collect(from.imag + i)};
}

/// The entries below entry k of a pack that begins with entry i; zeros for the others.
RPSUP_INLINE RowLanes keep_below(const RowLanes& numbers, int i, int k) {
  RowLanes indices;
  for (int lane = 0; lane < kRowLanes; ++lane) indices.set(lane, i + lane);
  return choose_greater(indices, RowLanes::all(k), numbers, RowLanes{});
}
RPSUP_INLINE Complex<RowLanes> keep_below(const Complex<RowLanes>& numbers, int i, int k) {
  return {keep_below(numbers.real, i, k), keep_below(numbers.imag, i, k)};
}

/// y -= factor x, from the pack that contains entry `from` to the pack that contains entry `last`.
template <typename Scalar>
RPSUP_INLINE void subtract_scaled(const Scalar& factor, NumbersAt<Scalar> x, int from, int last,
                                  NumbersAt<Scalar> y) {
  for (int i = start_of(from); i <= last; i += kRowLanes) y.store(i, y.load(i) - factor * x.load(i));
}

/// Sizes of a StateJacobian: free coordinates, rows before the powers, rows of a column, and stride of rows
/// of bristle pairs.
struct AnySizes {
  int n, rows, column, pairs;
};
/// The same as compile-time constants, with few bristles.
template <int coordinates>
struct SizesOfFew {
  static constexpr int n = coordinates, rows = StateJacobian::in_blocks(n),
                       column = rows + StateJacobian::kFewestWorks;
  static constexpr int pairs = StateJacobian::kBlock;
};
/// The same but for the bristles, which are many.
template <int coordinates>
struct SizesOfMany {
  static constexpr int n = coordinates, rows = SizesOfFew<n>::rows, column = SizesOfFew<n>::column;
  int pairs;
};

/// Calls f with the sizes of J, as compile-time constants for the paper's linkage: with a rigid coupler, with
/// one of four elements, and with a rigid coupler and an actuator of no, one or two auxiliary coordinates.
template <typename Function>
auto with_sizes(const StateJacobian& J, const Function& f) {
  const bool usual = J.stride == J.first_work + StateJacobian::kFewestWorks,
             few = J.pair_stride == StateJacobian::kBlock;
  if (usual && J.free == 5) return few ? f(SizesOfFew<5>()) : f(SizesOfMany<5>{J.pair_stride});
  if (usual && J.free == 14) return few ? f(SizesOfFew<14>()) : f(SizesOfMany<14>{J.pair_stride});
  if (usual && few && J.free == 6) return f(SizesOfFew<6>());
  if (usual && few && J.free == 7) return f(SizesOfFew<7>());
  if (usual && few && J.free == 8) return f(SizesOfFew<8>());
  return f(AnySizes{J.free, J.first_work, J.stride, J.pair_stride});
}

/// Calls f(0), f(1), ... for the free coordinates, unrolled if their number is a constant.
template <typename Sizes, typename Function>
RPSUP_INLINE void for_each_coordinate(const Sizes&, const Function& f) {
  [&]<int... k>(std::integer_sequence<int, k...>) RPSUP_INLINE_LAMBDA { (f(k), ...); }
  (std::make_integer_sequence<int, Sizes::n>{});
}
template <typename Function>
RPSUP_INLINE void for_each_coordinate(const AnySizes& size, const Function& f) {
  for (int k = 0; k < size.n; ++k) f(k);
}

/// z = (sigma 1 - E)^-1 (first, second) of a pack of bristle pairs. @param inverse  rows of the inverse
template <typename Scalar, typename WideScalar>
RPSUP_INLINE void apply_bristle_inverse(const RowsAt<Scalar>& inverse, int pair, const WideScalar& first,
                                        const WideScalar& second, NumbersAt<Scalar> firsts,
                                        NumbersAt<Scalar> seconds) {
  const auto of = [&](int row) RPSUP_INLINE_LAMBDA { return inverse.row(row).load(pair); };
  const WideScalar z_first = of(0) * first + of(1) * second, z_second = of(2) * first + of(3) * second;
  firsts.store(pair, z_first);
  seconds.store(pair, z_second);
}

/// @returns sum + by_z z of a pack of outputs. @param by_z  of these outputs by the first bristle; by the
/// next ones a column further each
template <typename Sizes, typename Scalar, typename WideScalar>
[[nodiscard]] RPSUP_INLINE WideScalar add_by_z(const Sizes& size, WideScalar sum, const double* by_z,
                                               int pairs, NumbersAt<Scalar> firsts,
                                               NumbersAt<Scalar> seconds) {
  for (int p = 0; p < pairs; ++p, by_z += 2 * size.column)
    sum += RowLanes::load(by_z) * widen(firsts[p]) + RowLanes::load(by_z + size.column) * widen(seconds[p]);
  return sum;
}

}  // namespace

template <typename Scalar>
NewtonMatrix<Scalar>::NewtonMatrix(const StateJacobian& J)
    : J_(J),
      bristle_inverse_(4, J.pair_stride),
      bristle_response_(2 * J.free, J.pair_stride),
      lower_(J.free, J.first_work),
      upper_(J.free, J.first_work),
      condensed_w_(J.free, J.stride - J.first_work),
      inverse_pivot_(1, J.first_work),
      order_(J.first_work),
      bristle_(2, J.pair_stride),
      scaled_q_(1, J.first_work),
      v_(1, J.first_work),
      rhs_(1, J.stride) {}

template <typename Scalar>
bool NewtonMatrix<Scalar>::factor(const Scalar& shift) {
  return with_sizes(J_, [&](const auto& size) {
    condense(size, shift);
    return factor_lu(size);
  });
}

template <typename Scalar>
void NewtonMatrix<Scalar>::solve_in_place(NumbersAt<Scalar> x) {
  with_sizes(J_, [&](const auto& size) { solve_sized(size, x); });
}

template <typename Scalar>
template <typename Sizes>
RPSUP_INLINE void NewtonMatrix<Scalar>::invert_bristle_blocks(const Sizes& size, const Scalar& shift) {
  const double* E = J_.matrices->rates_by_bristle.data();
  const RowsAt<Scalar> inverse = bristle_inverse_.rows(size.pairs);
  const int pairs = J_.pairs;
  const WideScalar shifts = widen(shift);
  for (int p = 0; p < pairs; p += kRowLanes) {
    const auto block = [&](int row) RPSUP_INLINE_LAMBDA { return RowLanes::load(E + row * size.pairs + p); };
    const WideScalar a00 = add_to(shifts, -block(0)), a11 = add_to(shifts, -block(3));
    const RowLanes a01 = -block(1), a10 = -block(2);
    const WideScalar inverse_determinant = 1.0 / add_to(a00 * a11, -(a01 * a10));
    inverse.row(0).store(p, a11 * inverse_determinant);
    inverse.row(1).store(p, -a01 * inverse_determinant);
    inverse.row(2).store(p, -a10 * inverse_determinant);
    inverse.row(3).store(p, a00 * inverse_determinant);
  }
}

/// response = (sigma 1 - E)^-1 K_z, Eq. (K25).
template <typename Scalar>
template <typename Sizes>
RPSUP_INLINE void NewtonMatrix<Scalar>::calc_bristle_response(const Sizes& size,
                                                              const Scalar& inverse_shift) {
  const double *by_q = J_.matrices->rates_by_q.data(), *by_v = J_.matrices->rates_by_v.data();
  const RowsAt<Scalar> inverse = bristle_inverse_.rows(size.pairs),
                       response = bristle_response_.rows(size.pairs);
  const int pairs = J_.pairs;
  const auto K = [&](int i) RPSUP_INLINE_LAMBDA {
    return RowLanes::load(by_v + i) + RowLanes::load(by_q + i) * widen(inverse_shift);
  };
  for (int p = 0; p < pairs; p += kRowLanes)
    for (int j = 0; j < size.n; ++j) {
      const int first = 2 * j * size.pairs + p;
      apply_bristle_inverse(inverse, p, K(first), K(first + size.pairs), response.row(2 * j),
                            response.row(2 * j + 1));
    }
}

/// sigma 1 - condensed_v and condensed_w, Eqs. (K26) and (K27).
template <typename Scalar>
template <typename Sizes>
RPSUP_INLINE void NewtonMatrix<Scalar>::condense(const Sizes& size, const Scalar& shift) {
  const Scalar inverse_shift = 1.0 / shift;
  inverse_shift_ = inverse_shift;
  invert_bristle_blocks(size, shift);
  calc_bristle_response(size, inverse_shift);
  const StateJacobian::Matrices& J = *J_.matrices;
  const double *by_v = J.by_v.data(), *by_q = J.by_q.data(), *by_z = J.by_bristle.data();
  const RowsAt<Scalar> lower = lower_.rows(size.rows),
                       condensed_w = condensed_w_.rows(size.column - size.rows);
  const RowsAt<Scalar> response = bristle_response_.rows(size.pairs);
  const int pairs = J_.pairs, works = J_.works;
  for (int j = 0; j < size.n; ++j) {
    const auto condensed = [&](int row) RPSUP_INLINE_LAMBDA {
      const int i = j * size.column + row;
      const WideScalar K = RowLanes::load(by_v + i) + RowLanes::load(by_q + i) * widen(inverse_shift);
      return add_by_z(size, K, by_z + row, pairs, response.row(2 * j), response.row(2 * j + 1));
    };
    const NumbersAt<Scalar> column = lower.row(j), column_w = condensed_w.row(j);
    for (int i = 0; i < size.n; i += kRowLanes) column.store(i, -condensed(i));
    for (int k = 0; k < works; k += kRowLanes) column_w.store(k, condensed(size.rows + k));
    column.set(j, shift + column[j]);
  }
}

/// LU factorisation with partial pivoting, in place: L in lower_, U in upper_, both stored by columns: row(k)
/// is column k. Each column of U is divided by its pivot, so that substitution waits for no division. The
/// other triangle of each is zero, so that rows are computed in packs.
template <typename Scalar>
template <typename Sizes>
RPSUP_INLINE bool NewtonMatrix<Scalar>::factor_lu(const Sizes& size) {
  const RowsAt<Scalar> lower = lower_.rows(size.rows), upper = upper_.rows(size.rows);
  const NumbersAt<Scalar> inverse_pivot = inverse_pivot_.first();
  int* order = order_.data();
  for (int k = 0; k < size.rows; ++k) order[k] = k;
  bool regular = true;
  for_each_coordinate(size, [&](int k) RPSUP_INLINE_LAMBDA {
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
    for (int i = 0; i < size.n; i += kRowLanes) {
      const WideScalar scaled = inverse * column.load(i);
      column.store(i, keep_below(scaled, i, k));
      above.store(i, scaled - keep_below(scaled, i, k - 1));
    }
    for (int j = k + 1; j < size.n; ++j)
      subtract_scaled(lower.row(j)[k], column, k + 1, size.n - 1, lower.row(j));
  });
  return regular;
}

/// v <- (sigma 1 - condensed_v)^-1 rhs, Eq. (K26).
template <typename Scalar>
template <typename Sizes>
RPSUP_INLINE void NewtonMatrix<Scalar>::solve_lu(const Sizes& size, NumbersAt<Scalar> rhs,
                                                 NumbersAt<Scalar> v) {
  const RowsAt<Scalar> lower = lower_.rows(size.rows), upper = upper_.rows(size.rows);
  const NumbersAt<Scalar> inverse_pivot = inverse_pivot_.first();
  const int* order = order_.data();
  for (int i = 0; i < size.n; i += kRowLanes) v.store(i, gather(rhs, order + i));
  for_each_coordinate(
      size, [&](int k) RPSUP_INLINE_LAMBDA { subtract_scaled(v[k], lower.row(k), k + 1, size.n - 1, v); });
  for_each_coordinate(size, [&](int from_last) RPSUP_INLINE_LAMBDA {
    const int k = size.n - 1 - from_last;
    subtract_scaled(v[k], upper.row(k), 0, k - 1, v);
  });
  for (int i = 0; i < size.n; i += kRowLanes) v.store(i, inverse_pivot.load(i) * v.load(i));
}

/// z_free, Eq. (K25), in packs of bristle pairs; the last pair fills up the last pack.
template <typename Scalar>
template <typename Sizes>
RPSUP_INLINE void NewtonMatrix<Scalar>::calc_free_bristles(const Sizes& size, NumbersAt<Scalar> z,
                                                           NumbersAt<Scalar> scaled_q) {
  const int* acting = J_.acting.data();
  const double* by_q = J_.matrices->rates_by_q.data();
  const RowsAt<Scalar> inverse = bristle_inverse_.rows(size.pairs), bristle = bristle_.rows(size.pairs);
  const int pairs = J_.pairs;
  for (int p = 0; p < pairs; p += kRowLanes) {
    int first_of[kRowLanes], second_of[kRowLanes];
    for (int lane = 0; lane < kRowLanes; ++lane) {
      const int* pair = acting + 2 * (p + lane < pairs ? p + lane : pairs - 1);
      first_of[lane] = pair[0];
      second_of[lane] = pair[1];
    }
    WideScalar first = gather(z, first_of), second = gather(z, second_of);
    for (int j = 0; j < size.n; ++j) {
      const WideScalar by = widen(scaled_q[j]);
      first += RowLanes::load(by_q + 2 * j * size.pairs + p) * by;
      second += RowLanes::load(by_q + (2 * j + 1) * size.pairs + p) * by;
    }
    apply_bristle_inverse(inverse, p, first, second, bristle.row(0), bristle.row(1));
  }
}

/// z = z_free + response v, Eq. (K27).
template <typename Scalar>
template <typename Sizes>
RPSUP_INLINE void NewtonMatrix<Scalar>::add_bristle_response(const Sizes& size, NumbersAt<Scalar> v) {
  const RowsAt<Scalar> response = bristle_response_.rows(size.pairs), bristle = bristle_.rows(size.pairs);
  const int pairs = J_.pairs;
  for (int p = 0; p < pairs; p += kRowLanes) {
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
RPSUP_INLINE void NewtonMatrix<Scalar>::solve_sized(const Sizes& size, NumbersAt<Scalar> state) {
  const int bristles = J_.bristles, pairs = J_.pairs, works = J_.works;
  const int* acting = J_.acting.data();
  const double *by_q = J_.matrices->by_q.data(), *by_z = J_.matrices->by_bristle.data();
  const NumbersAt<Scalar> rates = state.from(J_.layout.v()), z = state.from(J_.layout.bristle()),
                          work = state.from(J_.layout.work());
  const NumbersAt<Scalar> scaled_q = scaled_q_.first(), v = v_.first(), rhs = rhs_.first(),
                          rhs_w = rhs.from(size.rows);
  const RowsAt<Scalar> bristle = bristle_.rows(size.pairs),
                       condensed_w = condensed_w_.rows(size.column - size.rows);
  const Scalar inverse_shift = inverse_shift_;

  for (int i = 0; i < size.n; i += kRowLanes) scaled_q.store(i, inverse_shift * collect(state, i));
  calc_free_bristles(size, z, scaled_q);
  const auto add_rhs = [&](WideScalar sum, int row) RPSUP_INLINE_LAMBDA {
    for (int j = 0; j < size.n; ++j) sum += RowLanes::load(by_q + j * size.column + row) * widen(scaled_q[j]);
    return add_by_z(size, sum, by_z + row, pairs, bristle.row(0), bristle.row(1));
  };
  for (int i = 0; i < size.n; i += kRowLanes)
    rhs.store(i, add_rhs(collect(rates, i), i));  // numbers behind the rates are multiplied by zeros only
  solve_lu(size, rhs, v);
  for (int k = 0; k < works; k += kRowLanes) {
    WideScalar sum = add_rhs(widen(Scalar{}), size.rows + k);
    for (int j = 0; j < size.n; ++j) sum += condensed_w.row(j).load(k) * widen(v[j]);
    rhs_w.store(k, sum);
  }
  add_bristle_response(size, v);
  for (int i = 0; i < size.n; ++i) {
    state.set(i, scaled_q[i] + inverse_shift * v[i]);
    rates.set(i, v[i]);
  }
  for (int b = 0; b < bristles; ++b) z.set(b, inverse_shift * z[b]);
  for (int p = 0; p < pairs; ++p) {
    z.set(acting[2 * p], bristle.row(0)[p]);
    z.set(acting[2 * p + 1], bristle.row(1)[p]);
  }
  for (int k = 0; k < works; ++k) work.set(k, inverse_shift * (work[k] + rhs_w[k]));
}

template class NewtonMatrix<double>;
template class NewtonMatrix<Complex<double>>;

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
