// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <utility>

#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// A number with its derivatives in several directions: forward differentiation, exact to rounding. A
/// calculation with such numbers yields its derivatives, too, from the same lines of code.
template <int count>
struct DualOf {
  double value;
  LaneBlock<count> d;

  DualOf() = default;
  RPSUP_INLINE DualOf(double constant) : value(constant), d{} {}  // NOLINT: a constant is a dual number
  RPSUP_INLINE DualOf(double v, const LaneBlock<count>& lanes) : value(v), d(lanes) {}

  RPSUP_INLINE DualOf& operator+=(const DualOf& b) {
    value += b.value;
    d = d + b.d;
    return *this;
  }
  RPSUP_INLINE DualOf& operator+=(double b) {
    value += b;
    return *this;
  }
  RPSUP_INLINE DualOf& operator-=(const DualOf& b) {
    value -= b.value;
    d = d - b.d;
    return *this;
  }
  RPSUP_INLINE DualOf& operator-=(double b) {
    value -= b;
    return *this;
  }

  [[nodiscard]] RPSUP_INLINE friend DualOf operator-(const DualOf& a) { return {-a.value, -a.d}; }
  [[nodiscard]] RPSUP_INLINE friend DualOf operator+(const DualOf& a, const DualOf& b) {
    return {a.value + b.value, a.d + b.d};
  }
  [[nodiscard]] RPSUP_INLINE friend DualOf operator-(const DualOf& a, const DualOf& b) {
    return {a.value - b.value, a.d - b.d};
  }
  [[nodiscard]] RPSUP_INLINE friend DualOf operator*(const DualOf& a, const DualOf& b) {
    return {a.value * b.value, combine(a.value, b.d, b.value, a.d)};
  }
  [[nodiscard]] RPSUP_INLINE friend DualOf operator+(const DualOf& a, double b) { return {a.value + b, a.d}; }
  [[nodiscard]] RPSUP_INLINE friend DualOf operator+(double a, const DualOf& b) { return {a + b.value, b.d}; }
  [[nodiscard]] RPSUP_INLINE friend DualOf operator-(const DualOf& a, double b) { return {a.value - b, a.d}; }
  [[nodiscard]] RPSUP_INLINE friend DualOf operator-(double a, const DualOf& b) {
    return {a - b.value, -b.d};
  }
  [[nodiscard]] RPSUP_INLINE friend DualOf operator*(double a, const DualOf& b) {
    return {a * b.value, a * b.d};
  }
  [[nodiscard]] RPSUP_INLINE friend DualOf operator*(const DualOf& a, double b) { return b * a; }

  /// f(a) with the derivative f'(a).
  [[nodiscard]] RPSUP_INLINE friend DualOf chain(const DualOf& a, double f, double df) {
    return {f, df * a.d};
  }

  [[nodiscard]] RPSUP_INLINE friend DualOf operator/(const DualOf& a, const DualOf& b) {
    const double inverse = 1.0 / b.value;
    const double quotient = a.value * inverse;
    return {quotient, inverse * (a.d - quotient * b.d)};
  }
  [[nodiscard]] RPSUP_INLINE friend DualOf operator/(double a, const DualOf& b) {
    return chain(b, a / b.value, -a / (b.value * b.value));
  }
  [[nodiscard]] RPSUP_INLINE friend DualOf operator/(const DualOf& a, double b) { return (1.0 / b) * a; }

  [[nodiscard]] RPSUP_INLINE friend DualOf sqrt(const DualOf& a) {
    const double root = std::sqrt(a.value);
    return chain(a, root, root > 0.0 ? 0.5 / root : 0.0);
  }
  [[nodiscard]] RPSUP_INLINE friend DualOf exp(const DualOf& a) {
    const double e = std::exp(a.value);
    return chain(a, e, e);
  }
  [[nodiscard]] RPSUP_INLINE friend DualOf sin(const DualOf& a) {
    return chain(a, std::sin(a.value), std::cos(a.value));
  }
  /// Angle of (x, y), not both zero.
  [[nodiscard]] RPSUP_INLINE friend DualOf atan2(const DualOf& y, const DualOf& x) {
    const double inverse = 1.0 / (x.value * x.value + y.value * y.value);
    return {std::atan2(y.value, x.value), combine(inverse * x.value, y.d, -inverse * y.value, x.d)};
  }
};
using Dual = DualOf<Lanes::kCount>;

[[nodiscard]] RPSUP_INLINE double sqrt(double a) { return std::sqrt(a); }
[[nodiscard]] RPSUP_INLINE double exp(double a) { return std::exp(a); }
[[nodiscard]] RPSUP_INLINE double sin(double a) { return std::sin(a); }
[[nodiscard]] RPSUP_INLINE double atan2(double y, double x) { return std::atan2(y, x); }
[[nodiscard]] RPSUP_INLINE double chain(double /*a*/, double f, double /*df*/) { return f; }

/// The number alone: for decisions, which have no derivative.
[[nodiscard]] RPSUP_INLINE double value_of(double a) { return a; }
template <int count>
[[nodiscard]] RPSUP_INLINE double value_of(const DualOf<count>& a) { return a.value; }
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> value_of(const LaneBlock<count>& a) { return a; }
template <typename T>
using ValueOf = decltype(value_of(std::declval<T>()));

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
