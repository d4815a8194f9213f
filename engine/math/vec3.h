// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "engine/math/instruction_set.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Vectors and matrices of three whose entries may be numbers or numbers with derivatives, mixed as they
/// come: what depends on positions alone stays a plain number where only velocities vary. Eigen serves
/// everywhere else.
template <typename T>
struct Vec3 {
  T x, y, z;

  RPSUP_INLINE Vec3() : x{}, y{}, z{} {}
  RPSUP_INLINE Vec3(const T& x_, const T& y_, const T& z_) : x(x_), y(y_), z(z_) {}
  // Copied number by number: a copy by wider words, of numbers that have just been written one by one, makes
  // the processor wait for them.
  RPSUP_INLINE Vec3(const Vec3& v) : x(v.x), y(v.y), z(v.z) {}
  RPSUP_INLINE Vec3& operator=(const Vec3& v) {
    x = v.x;
    y = v.y;
    z = v.z;
    return *this;
  }
};

template <typename A, typename B>
using Mixed = decltype(std::declval<A>() * std::declval<B>());
template <typename A, typename B>
using MixedSum = decltype(std::declval<A>() + std::declval<B>());

template <typename A, typename B>
[[nodiscard]] RPSUP_INLINE Vec3<MixedSum<A, B>> operator+(const Vec3<A>& a, const Vec3<B>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename A, typename B>
[[nodiscard]] RPSUP_INLINE Vec3<MixedSum<A, B>> operator-(const Vec3<A>& a, const Vec3<B>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename A>
[[nodiscard]] RPSUP_INLINE Vec3<A> operator-(const Vec3<A>& a) {
  return {-a.x, -a.y, -a.z};
}
template <typename S, typename A>
[[nodiscard]] RPSUP_INLINE Vec3<Mixed<S, A>> operator*(const S& s, const Vec3<A>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <typename A, typename B>
RPSUP_INLINE Vec3<A>& operator+=(Vec3<A>& a, const Vec3<B>& b) {
  a.x += b.x;
  a.y += b.y;
  a.z += b.z;
  return a;
}
template <typename A, typename B>
RPSUP_INLINE Vec3<A>& operator-=(Vec3<A>& a, const Vec3<B>& b) {
  a.x -= b.x;
  a.y -= b.y;
  a.z -= b.z;
  return a;
}
template <typename A, typename B>
[[nodiscard]] RPSUP_INLINE Mixed<A, B> dot(const Vec3<A>& a, const Vec3<B>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename A, typename B>
[[nodiscard]] RPSUP_INLINE Vec3<Mixed<A, B>> cross(const Vec3<A>& a, const Vec3<B>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A matrix by its columns.
template <typename T>
struct Mat3 {
  Vec3<T> x, y, z;
};

template <typename A, typename B>
[[nodiscard]] RPSUP_INLINE Vec3<Mixed<A, B>> operator*(const Mat3<A>& m, const Vec3<B>& v) {
  return v.x * m.x + v.y * m.y + v.z * m.z;
}
template <typename A, typename B>
[[nodiscard]] RPSUP_INLINE Mat3<Mixed<A, B>> operator*(const Mat3<A>& m, const Mat3<B>& n) {
  return {m * n.x, m * n.y, m * n.z};
}
/// m^T v
template <typename A, typename B>
[[nodiscard]] RPSUP_INLINE Vec3<Mixed<A, B>> transpose_times(const Mat3<A>& m, const Vec3<B>& v) {
  return {dot(m.x, v), dot(m.y, v), dot(m.z, v)};
}
template <typename A, typename B>
RPSUP_INLINE Mat3<A>& operator+=(Mat3<A>& a, const Mat3<B>& b) {
  a.x += b.x;
  a.y += b.y;
  a.z += b.z;
  return a;
}

/// A symmetric matrix.
template <typename T>
struct Sym3 {
  T xx{}, yy{}, zz{}, xy{}, xz{}, yz{};
};

template <typename A, typename B>
RPSUP_INLINE Sym3<A>& operator+=(Sym3<A>& a, const Sym3<B>& b) {
  a.xx += b.xx;
  a.yy += b.yy;
  a.zz += b.zz;
  a.xy += b.xy;
  a.xz += b.xz;
  a.yz += b.yz;
  return a;
}
template <typename T>
[[nodiscard]] RPSUP_INLINE Sym3<T> operator*(const T& x, const Sym3<T>& s) {
  return {x * s.xx, x * s.yy, x * s.zz, x * s.xy, x * s.xz, x * s.yz};
}
template <typename A, typename B>
[[nodiscard]] RPSUP_INLINE Vec3<Mixed<A, B>> operator*(const Sym3<A>& s, const Vec3<B>& v) {
  return {s.xx * v.x + s.xy * v.y + s.xz * v.z, s.xy * v.x + s.yy * v.y + s.yz * v.z,
          s.xz * v.x + s.yz * v.y + s.zz * v.z};
}
/// a += u v^T, of which the upper half counts
template <typename A, typename U, typename V>
RPSUP_INLINE void add_half_outer(Sym3<A>& a, const Vec3<U>& u, const Vec3<V>& v) {
  a.xx += u.x * v.x;
  a.yy += u.y * v.y;
  a.zz += u.z * v.z;
  a.xy += u.x * v.y;
  a.xz += u.x * v.z;
  a.yz += u.y * v.z;
}
/// a += s u u^T
template <typename A, typename S, typename U>
RPSUP_INLINE void add_outer(Sym3<A>& a, const S& s, const Vec3<U>& u) {
  add_half_outer(a, s * u, u);
}
/// Inverse of a positive definite one; `determinant` says if it is.
template <typename T>
struct Sym3Inverse {
  Sym3<T> matrix;
  T determinant;
};
template <typename T>
[[nodiscard]] RPSUP_INLINE Sym3Inverse<T> invert(const Sym3<T>& s) {
  const T xx = s.yy * s.zz - s.yz * s.yz;
  const T xy = s.xz * s.yz - s.xy * s.zz;
  const T xz = s.xy * s.yz - s.xz * s.yy;
  const T determinant = s.xx * xx + s.xy * xy + s.xz * xz;
  const T inverse = 1.0 / determinant;
  return {{inverse * xx, inverse * (s.xx * s.zz - s.xz * s.xz), inverse * (s.xx * s.yy - s.xy * s.xy),
           inverse * xy, inverse * xz, inverse * (s.xy * s.xz - s.xx * s.yz)},
          determinant};
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
