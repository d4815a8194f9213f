// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// A complex number, or several side by side. (Functions of std::complex would be shared between instruction
/// sets by the linker, and look twice at each product for infinities.)
template <typename T>
struct Complex {
  T real{}, imag{};
};

template <typename T>
[[nodiscard]] RPSUP_INLINE Complex<T> operator+(const Complex<T>& a, const Complex<T>& b) {
  return {a.real + b.real, a.imag + b.imag};
}
template <typename T>
[[nodiscard]] RPSUP_INLINE Complex<T> operator+(const T& a, const Complex<T>& b) {
  return {a + b.real, b.imag};
}
template <typename T>
[[nodiscard]] RPSUP_INLINE Complex<T> operator-(const Complex<T>& a, const Complex<T>& b) {
  return {a.real - b.real, a.imag - b.imag};
}
template <typename T>
[[nodiscard]] RPSUP_INLINE Complex<T> operator-(const Complex<T>& a) {
  return {-a.real, -a.imag};
}
template <typename A, typename B>
[[nodiscard]] RPSUP_INLINE auto operator*(const Complex<A>& a, const Complex<B>& b) {
  return Complex<decltype(a.real * b.real)>{a.real * b.real - a.imag * b.imag,
                                            a.real * b.imag + a.imag * b.real};
}
template <int count, typename B>
[[nodiscard]] RPSUP_INLINE Complex<LaneBlock<count>> operator*(const LaneBlock<count>& a,
                                                               const Complex<B>& b) {
  return {a * b.real, a * b.imag};
}
template <typename T>
[[nodiscard]] RPSUP_INLINE Complex<T> operator*(double a, const Complex<T>& b) {
  return {a * b.real, a * b.imag};
}
template <typename T>
[[nodiscard]] RPSUP_INLINE Complex<T> operator*(const Complex<T>& a, double b) {
  return b * a;
}
template <typename T>
[[nodiscard]] RPSUP_INLINE Complex<T> operator/(double a, const Complex<T>& b) {
  const T factor = a / (b.real * b.real + b.imag * b.imag);
  return {factor * b.real, -(factor * b.imag)};
}
template <typename T>
RPSUP_INLINE Complex<T>& operator+=(Complex<T>& a, const Complex<T>& b) {
  return a = a + b;
}
template <typename T>
RPSUP_INLINE Complex<T>& operator-=(Complex<T>& a, const Complex<T>& b) {
  return a = a - b;
}
RPSUP_INLINE Complex<double>& operator*=(Complex<double>& a, const Complex<double>& b) { return a = a * b; }
RPSUP_INLINE Complex<double>& operator/=(Complex<double>& a, const Complex<double>& b) {
  return a = (1.0 / b) * a;
}

/// A measure of size, the cheapest.
[[nodiscard]] RPSUP_INLINE double size_of(double x) { return std::abs(x); }
[[nodiscard]] RPSUP_INLINE double size_of(const Complex<double>& x) {
  return std::abs(x.real) + std::abs(x.imag);
}

/// Several numbers of a kind side by side, and how real ones become such.
template <typename Scalar>
struct NumbersOf;
template <>
struct NumbersOf<double> {
  template <int count>
  using Block = LaneBlock<count>;
  template <int count>
  [[nodiscard]] RPSUP_INLINE static LaneBlock<count> widen(const LaneBlock<count>& real) {
    return real;
  }
};
template <>
struct NumbersOf<Complex<double>> {
  template <int count>
  using Block = Complex<LaneBlock<count>>;
  template <int count>
  [[nodiscard]] RPSUP_INLINE static Complex<LaneBlock<count>> widen(const LaneBlock<count>& real) {
    return {real, LaneBlock<count>{}};
  }
};
/// The number in a lane.
template <int count>
[[nodiscard]] RPSUP_INLINE double number_in(const LaneBlock<count>& block, int lane) {
  return block[lane];
}
template <int count>
[[nodiscard]] RPSUP_INLINE Complex<double> number_in(const Complex<LaneBlock<count>>& block, int lane) {
  return {block.real[lane], block.imag[lane]};
}
template <int count>
RPSUP_INLINE void set_number_in(LaneBlock<count>& block, int lane, double number) {
  block.set(lane, number);
}
template <int count>
RPSUP_INLINE void set_number_in(Complex<LaneBlock<count>>& block, int lane, const Complex<double>& number) {
  block.real.set(lane, number.real);
  block.imag.set(lane, number.imag);
}
/// The sum of all lanes.
[[nodiscard]] RPSUP_INLINE Complex<double> sum(const Complex<Lanes>& block) {
  return {sum(block.real), sum(block.imag)};
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
