// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/dynamics/kernel/tangent/frame_tangent.h"
#include "engine/dynamics/newton_euler.h"
#include "engine/math/complex.h"
#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Row of a matrix with nine columns, one for each number of a frame's tangent (w, wd, vd). The first eight
/// columns are one pack.
template <typename Scalar>
class Row9;
template <>
class Row9<double> {
 public:
  [[nodiscard]] RPSUP_INLINE double operator[](int i) const { return numbers_[i]; }
  [[nodiscard]] RPSUP_INLINE Lanes first8() const { return Lanes::load(numbers_); }
  [[nodiscard]] RPSUP_INLINE double ninth() const { return numbers_[Lanes::kCount]; }
  RPSUP_INLINE void set(const Lanes& first8, double ninth) {
    first8.store(numbers_);
    numbers_[Lanes::kCount] = ninth;
  }

 private:
  double numbers_[Lanes::kCount + 1]{};
};
template <>
class Row9<Complex<double>> {
 public:
  [[nodiscard]] RPSUP_INLINE Complex<double> operator[](int i) const { return {real_[i], imag_[i]}; }
  [[nodiscard]] RPSUP_INLINE Complex<Lanes> first8() const { return {real_.first8(), imag_.first8()}; }
  [[nodiscard]] RPSUP_INLINE Complex<double> ninth() const { return {real_.ninth(), imag_.ninth()}; }
  RPSUP_INLINE void set(const Complex<Lanes>& first8, const Complex<double>& ninth) {
    real_.set(first8.real, ninth.real);
    imag_.set(first8.imag, ninth.imag);
  }

 private:
  Row9<double> real_, imag_;
};

/// The nine numbers (w, wd, vd) of a frame's tangent.
template <typename T>
struct FrameNumbers {
  explicit FrameNumbers(const FrameTangent<T>& f)
      : of{&f.w.x, &f.w.y, &f.w.z, &f.wd.x, &f.wd.y, &f.wd.z, &f.vd.x, &f.vd.y, &f.vd.z} {}
  const T* of[9];
};

/// The six numbers of a force.
template <typename T>
struct ForceNumbers {
  explicit ForceNumbers(SpatialForce<T>& f)
      : of{&f.force.x, &f.force.y, &f.force.z, &f.moment.x, &f.moment.y, &f.moment.z} {}
  T* of[6];
};

/// row . x
template <typename Scalar, typename T>
[[nodiscard]] RPSUP_INLINE T apply_row(const Row9<Scalar>& row, const FrameNumbers<T>& x) {
  T sum = row[0] * *x.of[0];
  for (int k = 1; k < 9; ++k) sum += row[k] * *x.of[k];
  return sum;
}

/// force += P chi. @param P  Body::articulated_tangent
template <typename Scalar, typename T>
RPSUP_INLINE void add_articulated_force(const Row9<Scalar> (&P)[6], const FrameTangent<T>& f,
                                        SpatialForce<T>& force) {
  const FrameNumbers<T> x(f);
  const ForceNumbers<T> numbers(force);
  for (int row = 0; row < 6; ++row) *numbers.of[row] += apply_row(P[row], x);
}

/// One in a lane, zero in the others.
template <typename Scalar, int count>
[[nodiscard]] RPSUP_INLINE auto unit(int lane) {
  return NumbersOf<Scalar>::widen(LaneBlock<count>::unit(lane));
}

/// The unit tangents of a frame: those of the first eight numbers, one a lane.
template <typename Scalar>
[[nodiscard]] auto unit_tangents_first8() {
  const auto one = [](int lane) { return unit<Scalar, Lanes::kCount>(lane); };
  FrameTangent<decltype(one(0))> f;
  f.w = {one(0), one(1), one(2)};
  f.wd = {one(3), one(4), one(5)};
  f.vd = {one(6), one(7), {}};
  return f;
}
/// The unit tangent of the ninth number, in the first of so many lanes.
template <typename Scalar, int count>
[[nodiscard]] auto unit_tangent_ninth() {
  FrameTangent<decltype(unit<Scalar, count>(0))> f;
  f.vd.z = unit<Scalar, count>(0);
  return f;
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
