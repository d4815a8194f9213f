#pragma once

#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// A complex number, or several side by side. (Functions of std::complex would be shared between instruction sets by the linker, and look twice at
/// each product for infinities.)
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
  return Complex<decltype(a.real * b.real)>{a.real * b.real - a.imag * b.imag, a.real * b.imag + a.imag * b.real};
}
template <int count, typename B>
[[nodiscard]] RPSUP_INLINE Complex<LaneBlock<count>> operator*(const LaneBlock<count>& a, const Complex<B>& b) {
  return {a * b.real, a * b.imag};
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

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
