// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "engine/math/buffer.h"
#include "engine/math/complex.h"
#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Numbers in a block: rows of numbers have room for whole ones.
inline constexpr int kRowBlock = 4;
[[nodiscard]] constexpr int in_row_blocks(int numbers) {
  return (numbers + kRowBlock - 1) / kRowBlock * kRowBlock;
}

/// Numbers of a row that are taken at once. Their count does not change any result.
using RowLanes = LaneBlock<kWidestPart < kRowBlock ? kWidestPart : kRowBlock>;

/// Address of a vector of numbers; of complex ones two, so that several parts of a kind stand side by side.
template <typename Scalar>
struct NumbersAt;
template <>
struct NumbersAt<double> {
  using WideScalar = NumbersOf<double>::Block<RowLanes::kCount>;
  double* at;

  [[nodiscard]] RPSUP_INLINE double operator[](int i) const { return at[i]; }
  RPSUP_INLINE void set(int i, double value) const { at[i] = value; }
  [[nodiscard]] RPSUP_INLINE RowLanes load(int i) const { return RowLanes::load(at + i); }
  RPSUP_INLINE void store(int i, const RowLanes& values) const { values.store(at + i); }
  [[nodiscard]] RPSUP_INLINE NumbersAt from(int i) const { return {at + i}; }
};
template <>
struct NumbersAt<Complex<double>> {
  using WideScalar = NumbersOf<Complex<double>>::Block<RowLanes::kCount>;
  double *real, *imag;

  [[nodiscard]] RPSUP_INLINE Complex<double> operator[](int i) const { return {real[i], imag[i]}; }
  RPSUP_INLINE void set(int i, const Complex<double>& value) const {
    real[i] = value.real;
    imag[i] = value.imag;
  }
  [[nodiscard]] RPSUP_INLINE Complex<RowLanes> load(int i) const {
    return {RowLanes::load(real + i), RowLanes::load(imag + i)};
  }
  RPSUP_INLINE void store(int i, const Complex<RowLanes>& values) const {
    values.real.store(real + i);
    values.imag.store(imag + i);
  }
  [[nodiscard]] RPSUP_INLINE NumbersAt from(int i) const { return {real + i, imag + i}; }
};

/// Address of rows of numbers, and the distance from row to row.
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
      : size_(static_cast<std::size_t>(rows) * static_cast<std::size_t>(stride)),
        numbers_(size_ * sizeof(Scalar) / sizeof(double)) {}

  /// To be asked for before anything is stored: the compiler must take what is stored for a change of these,
  /// too.
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

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
