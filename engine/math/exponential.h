// SPDX-License-Identifier: Apache-2.0 AND SunPro
// Derived from e_exp.c of fdlibm:
// Copyright (C) 2004 by Sun Microsystems, Inc. All rights reserved.
// Permission to use, copy, modify, and distribute this software is freely granted, provided that this notice
// is preserved.

#pragma once

#include "engine/math/instruction_set.h"
#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// e^x of numbers side by side, to less than one unit in the last place, the same with every instruction set.
/// |x| <= 700; of what is no number, none. Source: fdlibm's __ieee754_exp (Sun Microsystems, 1993) and its
/// coefficients.
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> calc_exponentials(const LaneBlock<count>& x) {
  using Part = typename LaneBlock<count>::Part;
  using Bits = typename LanePart<LaneBlock<count>::kWidth>::Bits;
  constexpr double kRound =
      6755399441055744.0;  // 1.5 * 2^52: added, the sum's last bits are the nearest integer
  constexpr double kLn2Head = 6.93147180369123816490e-01,
                   kLn2Tail = 1.90821492927058770002e-10;  // the first, of 32 bits, has exact multiples
  const LaneBlock<count> shifted = x * 1.44269504088896338700 + kRound;
  const LaneBlock<count> power = shifted - kRound;
  const LaneBlock<count> head = x - power * kLn2Head;
  const LaneBlock<count> tail = power * kLn2Tail;
  const LaneBlock<count> r = head - tail;
  const LaneBlock<count> rr = r * r;
  const LaneBlock<count> p_high =
      6.61375632143793436117e-05 + rr * (-1.65339022054652515390e-06 + rr * 4.13813679705723846039e-08);
  const LaneBlock<count> c =
      r - rr * (1.66666666666666019037e-01 + rr * (-2.77777777770155933842e-03 + rr * p_high));
  const LaneBlock<count> reduced = 1.0 - ((tail - (r * c) / (2.0 - c)) - head);
  constexpr int kExponentBias = 1023, kMantissaBits = 52;
  return for_each_part<count>([&](int i) RPSUP_INLINE_LAMBDA {
    const Bits power_of_two = (reinterpret_cast<Bits>(shifted.part[i]) + kExponentBias) << kMantissaBits;
    return reduced.part[i] * reinterpret_cast<Part>(power_of_two);
  });
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
