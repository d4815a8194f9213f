#pragma once

#include <cmath>

#include "engine/math/instruction_set.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Eight numbers, in the widest parts that the instruction set has. (Left to the compiler, wider ones fall apart badly.)
struct Lanes {
#if defined(__AVX512F__)
  static constexpr int kWidth = 8;
#elif defined(__AVX__)
  static constexpr int kWidth = 4;
#else
  static constexpr int kWidth = 2;
#endif
  static constexpr int kCount = 8;
  static constexpr int kParts = kCount / kWidth;
  using Part = double __attribute__((vector_size(8 * kWidth), aligned(8)));

  Part part[kParts];

  Lanes() = default;
  // Copied part by part: left to the compiler, a copy goes through smaller words, and the next reader waits for it.
  RPSUP_INLINE Lanes(const Lanes& other) { *this = other; }
  RPSUP_INLINE Lanes& operator=(const Lanes& other) {
    for (int i = 0; i < kParts; ++i) part[i] = other.part[i];
    return *this;
  }

  /// @param numbers  eight doubles
  [[nodiscard]] RPSUP_INLINE static Lanes load(const void* numbers) {
    using Stored = double __attribute__((vector_size(8 * kWidth), aligned(8), may_alias));
    Lanes lanes;
    for (int i = 0; i < kParts; ++i) lanes.part[i] = static_cast<const Stored*>(numbers)[i];
    return lanes;
  }
  /// The same number in all lanes.
  [[nodiscard]] RPSUP_INLINE static Lanes all(double number) {
    Lanes lanes;
    for (Part& p : lanes.part) p = number - Part{};
    return lanes;
  }
  /// One in a lane, zero in the others.
  [[nodiscard]] RPSUP_INLINE static Lanes unit(int lane) {
    Lanes lanes{};
    lanes.set(lane, 1.0);
    return lanes;
  }

  [[nodiscard]] RPSUP_INLINE double operator[](int lane) const { return part[lane / kWidth][lane % kWidth]; }
  RPSUP_INLINE void set(int lane, double value) { part[lane / kWidth][lane % kWidth] = value; }
};

template <typename Operation>
[[nodiscard]] RPSUP_INLINE Lanes for_each_part(const Operation& operation) {
  Lanes result;
  for (int i = 0; i < Lanes::kParts; ++i) result.part[i] = operation(i);
  return result;
}
[[nodiscard]] RPSUP_INLINE Lanes operator+(const Lanes& a, const Lanes& b) {
  return for_each_part([&](int i) RPSUP_INLINE_LAMBDA { return a.part[i] + b.part[i]; });
}
[[nodiscard]] RPSUP_INLINE Lanes operator-(const Lanes& a, const Lanes& b) {
  return for_each_part([&](int i) RPSUP_INLINE_LAMBDA { return a.part[i] - b.part[i]; });
}
[[nodiscard]] RPSUP_INLINE Lanes operator-(const Lanes& a) {
  return for_each_part([&](int i) RPSUP_INLINE_LAMBDA { return -a.part[i]; });
}
[[nodiscard]] RPSUP_INLINE Lanes operator*(double s, const Lanes& a) {
  return for_each_part([&](int i) RPSUP_INLINE_LAMBDA { return s * a.part[i]; });
}
[[nodiscard]] RPSUP_INLINE Lanes operator*(const Lanes& a, double s) { return s * a; }
RPSUP_INLINE Lanes& operator+=(Lanes& a, const Lanes& b) { return a = a + b; }
RPSUP_INLINE Lanes& operator-=(Lanes& a, const Lanes& b) { return a = a - b; }
/// Lane by lane.
[[nodiscard]] RPSUP_INLINE Lanes operator*(const Lanes& a, const Lanes& b) {
  return for_each_part([&](int i) RPSUP_INLINE_LAMBDA { return a.part[i] * b.part[i]; });
}
[[nodiscard]] RPSUP_INLINE Lanes operator/(const Lanes& a, const Lanes& b) {
  return for_each_part([&](int i) RPSUP_INLINE_LAMBDA { return a.part[i] / b.part[i]; });
}
/// Lane by lane: a > b ? yes : no
[[nodiscard]] RPSUP_INLINE Lanes choose_greater(const Lanes& a, const Lanes& b, const Lanes& yes, const Lanes& no) {
  return for_each_part([&](int i) RPSUP_INLINE_LAMBDA { return a.part[i] > b.part[i] ? yes.part[i] : no.part[i]; });
}
/// The sum of all lanes, halves first: the same for every instruction set.
[[nodiscard]] RPSUP_INLINE double sum(const Lanes& a) {
  const auto half = [&](int i) RPSUP_INLINE_LAMBDA { return a[i] + a[i + 4]; };
  return (half(0) + half(2)) + (half(1) + half(3));
}
/// s a + t b
[[nodiscard]] RPSUP_INLINE Lanes combine(double s, const Lanes& a, double t, const Lanes& b) {
  return for_each_part([&](int i) RPSUP_INLINE_LAMBDA { return s * a.part[i] + t * b.part[i]; });
}

/// A number with its derivatives in eight directions: forward differentiation, exact to rounding. What is computed with these is
/// computed together with its derivatives, from the same lines of code.
struct Dual {
  double value;
  Lanes d;

  Dual() = default;
  RPSUP_INLINE Dual(double constant) : value(constant), d{} {}  // NOLINT: a constant is a Dual
  RPSUP_INLINE Dual(double v, const Lanes& lanes) : value(v), d(lanes) {}

  RPSUP_INLINE Dual& operator+=(const Dual& b) {
    value += b.value;
    d = d + b.d;
    return *this;
  }
  RPSUP_INLINE Dual& operator+=(double b) {
    value += b;
    return *this;
  }
  RPSUP_INLINE Dual& operator-=(const Dual& b) {
    value -= b.value;
    d = d - b.d;
    return *this;
  }
  RPSUP_INLINE Dual& operator-=(double b) {
    value -= b;
    return *this;
  }
};

[[nodiscard]] RPSUP_INLINE Dual operator-(const Dual& a) { return {-a.value, -a.d}; }
[[nodiscard]] RPSUP_INLINE Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.d + b.d}; }
[[nodiscard]] RPSUP_INLINE Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.d - b.d}; }
[[nodiscard]] RPSUP_INLINE Dual operator*(const Dual& a, const Dual& b) {
  return {a.value * b.value, combine(a.value, b.d, b.value, a.d)};
}
[[nodiscard]] RPSUP_INLINE Dual operator+(const Dual& a, double b) { return {a.value + b, a.d}; }
[[nodiscard]] RPSUP_INLINE Dual operator+(double a, const Dual& b) { return {a + b.value, b.d}; }
[[nodiscard]] RPSUP_INLINE Dual operator-(const Dual& a, double b) { return {a.value - b, a.d}; }
[[nodiscard]] RPSUP_INLINE Dual operator-(double a, const Dual& b) { return {a - b.value, -b.d}; }
[[nodiscard]] RPSUP_INLINE Dual operator*(double a, const Dual& b) { return {a * b.value, a * b.d}; }
[[nodiscard]] RPSUP_INLINE Dual operator*(const Dual& a, double b) { return b * a; }

/// f(a) with the derivative f'(a).
[[nodiscard]] RPSUP_INLINE Dual chain(const Dual& a, double f, double df) { return {f, df * a.d}; }

[[nodiscard]] RPSUP_INLINE Dual operator/(const Dual& a, const Dual& b) {
  const double inverse = 1.0 / b.value;
  const double quotient = a.value * inverse;
  return {quotient, inverse * (a.d - quotient * b.d)};
}
[[nodiscard]] RPSUP_INLINE Dual operator/(double a, const Dual& b) { return chain(b, a / b.value, -a / (b.value * b.value)); }
[[nodiscard]] RPSUP_INLINE Dual operator/(const Dual& a, double b) { return (1.0 / b) * a; }

[[nodiscard]] RPSUP_INLINE Dual sqrt(const Dual& a) {
  const double root = std::sqrt(a.value);
  return chain(a, root, root > 0.0 ? 0.5 / root : 0.0);
}
[[nodiscard]] RPSUP_INLINE Dual exp(const Dual& a) {
  const double e = std::exp(a.value);
  return chain(a, e, e);
}

[[nodiscard]] RPSUP_INLINE Dual sin(const Dual& a) { return chain(a, std::sin(a.value), std::cos(a.value)); }

/// Angle of (x, y), not both zero.
[[nodiscard]] RPSUP_INLINE Dual atan2(const Dual& y, const Dual& x) {
  const double inverse = 1.0 / (x.value * x.value + y.value * y.value);
  return {std::atan2(y.value, x.value), combine(inverse * x.value, y.d, -inverse * y.value, x.d)};
}

[[nodiscard]] RPSUP_INLINE double sqrt(double a) { return std::sqrt(a); }
[[nodiscard]] RPSUP_INLINE double exp(double a) { return std::exp(a); }
[[nodiscard]] RPSUP_INLINE double sin(double a) { return std::sin(a); }
[[nodiscard]] RPSUP_INLINE double atan2(double y, double x) { return std::atan2(y, x); }
[[nodiscard]] RPSUP_INLINE double chain(double /*a*/, double f, double /*df*/) { return f; }

/// The number alone: for decisions, which have no derivative.
[[nodiscard]] RPSUP_INLINE double value_of(double a) { return a; }
[[nodiscard]] RPSUP_INLINE double value_of(const Dual& a) { return a.value; }

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
