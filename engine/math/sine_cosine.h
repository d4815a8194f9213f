#pragma once

#include <cmath>
#include <cstddef>

#include "engine/math/dual.h"
#include "engine/math/instruction_set.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Numbers are taken in blocks of so many, side by side.
constexpr int kSineBlock = Lanes::kWidth;
/// The least multiple of a block that holds n numbers.
[[nodiscard]] constexpr std::size_t in_sine_blocks(std::size_t n) { return (n + kSineBlock - 1) / kSineBlock * kSineBlock; }

/// Sine and cosine of a block of numbers below kLargestAngle, to less than one unit in the last place, the same with every instruction set.
/// Source: fdlibm's __kernel_sin, __kernel_cos and __ieee754_rem_pio2 (Sun Microsystems, 1993): polynomials for |y| <= pi / 4 and their coefficients,
/// pi / 2 in two parts of which the first, of 33 bits, has exact multiples.
RPSUP_INLINE void calc_sine_block(const double* x, double* sine, double* cosine) {
  using Part = double __attribute__((vector_size(8 * kSineBlock), aligned(8), may_alias));
  using Bits = long long __attribute__((vector_size(8 * kSineBlock), aligned(8), may_alias));
  constexpr double kRound = 6755399441055744.0;  // 1.5 * 2^52: added, the sum's last bits are the nearest integer
  constexpr double kHalfPiHead = 1.57079632673412561417, kHalfPiTail = 6.07710050650619224932e-11;

  const Part angle = *reinterpret_cast<const Part*>(x);
  const Part shifted = angle * (2.0 / 3.14159265358979323846) + kRound;
  const Part quadrant = shifted - kRound;
  const Part head = angle - quadrant * kHalfPiHead;
  const Part less = quadrant * kHalfPiTail;
  const Part y = head - less;
  const Part tail = (head - y) - less;

  // The polynomials by pairs: shorter chains of products that wait for each other.
  const Part z = y * y;
  const Part zz = z * z;
  const Part s_low = 8.33333333332248946124e-03 + z * -1.98412698298579493134e-04;
  const Part s_high = (2.75573137070700676789e-06 + z * -2.50507602534068634195e-08) + zz * 1.58969099521155010221e-10;
  const Part cube = z * y;
  const Part s = y - ((z * (0.5 * tail - cube * (s_low + zz * s_high)) - tail) - cube * -1.66666666666666324348e-01);
  const Part c_low = 4.16666666666666019037e-02 + z * -1.38888888888741095749e-03;
  const Part c_middle = 2.48015872894767294178e-05 + z * -2.75573143513906633035e-07;
  const Part c_high = 2.08757232129817482790e-09 + z * -1.13596475577881948265e-11;
  const Part c_tail = z * (c_low + zz * (c_middle + zz * c_high));
  const Part half = 0.5 * z;
  const Part near = 1.0 - half;
  const Part c = near + (((1.0 - near) - half) + (z * c_tail - y * tail));

  const Bits turns = reinterpret_cast<Bits>(shifted);
  const Bits odd = -(turns & 1);  // all ones where sine and cosine change places
  const Bits s_bits = reinterpret_cast<Bits>(s);
  const Bits c_bits = reinterpret_cast<Bits>(c);
  *reinterpret_cast<Bits*>(sine) = ((s_bits & ~odd) | (c_bits & odd)) ^ ((turns & 2) << 62);
  *reinterpret_cast<Bits*>(cosine) = ((c_bits & ~odd) | (s_bits & odd)) ^ (((turns + 1) & 2) << 62);
}

/// Sines and cosines of n numbers. @param x, sine, cosine  with room for in_sine_blocks(n); what is beyond n in x has no meaning
RPSUP_INLINE void calc_sines_and_cosines(const double* x, std::size_t n, double* sine, double* cosine) {
  constexpr double kLargestAngle = 1e6;  // some 2^19 quarter turns: their product with 33 bits is exact
  bool small = true;
  for (std::size_t i = 0; i < n; ++i) small = small && std::abs(x[i]) < kLargestAngle;
  if (small) [[likely]] {
    for (std::size_t i = 0; i < n; i += kSineBlock) calc_sine_block(x + i, sine + i, cosine + i);
    return;
  }
  for (std::size_t i = 0; i < n; ++i) {
    sine[i] = std::sin(x[i]);
    cosine[i] = std::cos(x[i]);
  }
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
