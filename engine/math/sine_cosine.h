// SPDX-License-Identifier: Apache-2.0 AND SunPro
// Derived from k_sin.c, k_cos.c and e_rem_pio2.c of fdlibm:
// Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved.
// Developed at SunSoft, a Sun Microsystems, Inc. business.
// Permission to use, copy, modify, and distribute this software is freely granted, provided that this notice
// is preserved.

#pragma once

#include <cmath>
#include <cstddef>

#include "engine/math/instruction_set.h"
#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Numbers are taken in blocks of so many, side by side.
constexpr int kSineBlock = kWidestPart;
using SineBlock = LaneBlock<kSineBlock>;
/// The least multiple of a block that holds n numbers.
[[nodiscard]] constexpr std::size_t in_sine_blocks(std::size_t n) {
  return (n + kSineBlock - 1) / kSineBlock * kSineBlock;
}

struct SinesAndCosines {
  SineBlock sine, cosine;
};

/// Of numbers below pi / 4, of which the last places are known as `tail`.
/// Source: fdlibm's __kernel_sin and __kernel_cos (Sun Microsystems, 1993) and their coefficients.
[[nodiscard]] RPSUP_INLINE SinesAndCosines calc_sine_polynomials(const SineBlock& y, const SineBlock& tail) {
  // By pairs: shorter chains of products that wait for each other.
  const SineBlock z = y * y;
  const SineBlock zz = z * z;
  const SineBlock s_low = 8.33333333332248946124e-03 + z * -1.98412698298579493134e-04;
  const SineBlock s_high =
      (2.75573137070700676789e-06 + z * -2.50507602534068634195e-08) + zz * 1.58969099521155010221e-10;
  const SineBlock cube = z * y;
  const SineBlock s =
      y - ((z * (0.5 * tail - cube * (s_low + zz * s_high)) - tail) - cube * -1.66666666666666324348e-01);
  const SineBlock c_low = 4.16666666666666019037e-02 + z * -1.38888888888741095749e-03;
  const SineBlock c_middle = 2.48015872894767294178e-05 + z * -2.75573143513906633035e-07;
  const SineBlock c_high = 2.08757232129817482790e-09 + z * -1.13596475577881948265e-11;
  const SineBlock c_tail = z * (c_low + zz * (c_middle + zz * c_high));
  const SineBlock half = 0.5 * z;
  const SineBlock near = 1.0 - half;
  const SineBlock c = near + (((1.0 - near) - half) + (z * c_tail - y * tail));
  return {s, c};
}

/// Of numbers below kLargestAngle. Source: fdlibm's __ieee754_rem_pio2: pi / 2 in two parts of which the
/// first, of 33 bits, has exact multiples.
[[nodiscard]] RPSUP_INLINE SinesAndCosines calc_reduced_sines(const SineBlock& angle) {
  using Bits = typename LanePart<kSineBlock>::Bits;
  constexpr double kRound =
      6755399441055744.0;  // 1.5 * 2^52: added, the sum's last bits are the nearest integer
  constexpr double kHalfPiHead = 1.57079632673412561417, kHalfPiTail = 6.07710050650619224932e-11;
  const SineBlock shifted = angle * (2.0 / 3.14159265358979323846) + kRound;
  const SineBlock quadrant = shifted - kRound;
  const SineBlock head = angle - quadrant * kHalfPiHead;
  const SineBlock less = quadrant * kHalfPiTail;
  const SineBlock y = head - less;
  SinesAndCosines of = calc_sine_polynomials(y, (head - y) - less);

  const Bits quadrant_bits = reinterpret_cast<Bits>(shifted.part[0]);
  const Bits odd = -(quadrant_bits & 1);  // all ones where sine and cosine change places
  const Bits s_bits = reinterpret_cast<Bits>(of.sine.part[0]);
  const Bits c_bits = reinterpret_cast<Bits>(of.cosine.part[0]);
  using Part = typename SineBlock::Part;
  of.sine.part[0] = reinterpret_cast<Part>(((s_bits & ~odd) | (c_bits & odd)) ^ ((quadrant_bits & 2) << 62));
  of.cosine.part[0] =
      reinterpret_cast<Part>(((c_bits & ~odd) | (s_bits & odd)) ^ (((quadrant_bits + 1) & 2) << 62));
  return of;
}

/// Sines and cosines of a block of numbers, to less than one unit in the last place, the same with every
/// instruction set.
[[nodiscard]] RPSUP_INLINE SinesAndCosines calc_sines_and_cosines(const SineBlock& x) {
  constexpr double kSmallAngle = 0.785;  // less than pi / 4: nothing to reduce, to the same bits
  constexpr double kLargestAngle = 1e6;  // some 2^19 quarter turns: their product with 33 bits is exact
  if (all_below(x, kSmallAngle)) return calc_sine_polynomials(x, SineBlock{});
  SinesAndCosines of = calc_reduced_sines(x);
  if (all_below(x, kLargestAngle)) [[likely]]
    return of;
  for (int i = 0; i < kSineBlock; ++i) {
    if (std::abs(x[i]) < kLargestAngle) continue;
    of.sine.set(i, std::sin(x[i]));
    of.cosine.set(i, std::cos(x[i]));
  }
  return of;
}

/// Of n numbers. @param x, sine, cosine  with room for in_sine_blocks(n); what is beyond n in x has no
/// meaning
RPSUP_INLINE void calc_sines_and_cosines(const double* x, std::size_t n, double* sine, double* cosine) {
  for (std::size_t i = 0; i < n; i += kSineBlock) {
    const SinesAndCosines of = calc_sines_and_cosines(SineBlock::load(x + i));
    of.sine.store(sine + i);
    of.cosine.store(cosine + i);
  }
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
