// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <immintrin.h>

#include <algorithm>
#include <utility>

#include "engine/math/instruction_set.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

#if defined(__AVX512F__)
constexpr int kWidestPart = 8;
#elif defined(__AVX__)
constexpr int kWidestPart = 4;
#else
constexpr int kWidestPart = 2;
#endif

/// So many numbers as the processor takes at once.
template <int width>
struct LanePart;
template <>
struct LanePart<2> {
  using Bits = long long __attribute__((vector_size(16), aligned(8)));
  using Type = double __attribute__((vector_size(16), aligned(8)));
  using Stored = double __attribute__((vector_size(16), aligned(8), may_alias));
};
template <>
struct LanePart<4> {
  using Bits = long long __attribute__((vector_size(32), aligned(8)));
  using Type = double __attribute__((vector_size(32), aligned(8)));
  using Stored = double __attribute__((vector_size(32), aligned(8), may_alias));
};
template <>
struct LanePart<8> {
  using Bits = long long __attribute__((vector_size(64), aligned(8)));
  using Type = double __attribute__((vector_size(64), aligned(8)));
  using Stored = double __attribute__((vector_size(64), aligned(8), may_alias));
};

/// @returns whether one of the lanes, each all zeros or all ones, is ones
[[nodiscard]] RPSUP_INLINE bool any(const LanePart<2>::Bits& lanes) {
  return _mm_movemask_pd(reinterpret_cast<__m128d>(lanes)) != 0;
}
#if defined(__AVX__)
[[nodiscard]] RPSUP_INLINE bool any(const LanePart<4>::Bits& lanes) {
  return _mm256_movemask_pd(reinterpret_cast<__m256d>(lanes)) != 0;
}
#endif
#if defined(__AVX512F__)
[[nodiscard]] RPSUP_INLINE bool any(const LanePart<8>::Bits& lanes) {
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(lanes)) != 0;
}
#endif

[[nodiscard]] RPSUP_INLINE LanePart<2>::Type sqrt_of(const LanePart<2>::Type& part) {
  return _mm_sqrt_pd(part);
}
#if defined(__AVX__)
[[nodiscard]] RPSUP_INLINE LanePart<4>::Type sqrt_of(const LanePart<4>::Type& part) {
  return _mm256_sqrt_pd(part);
}
#endif
#if defined(__AVX512F__)
[[nodiscard]] RPSUP_INLINE LanePart<8>::Type sqrt_of(const LanePart<8>::Type& part) {
  return _mm512_sqrt_pd(part);
}
#endif

/// Numbers side by side, in the widest parts that the instruction set has. (Left to the compiler, wider ones
/// fall apart badly.)
template <int count>
struct LaneBlock {
  static constexpr int kCount = count;
  static constexpr int kWidth = std::min(kCount, kWidestPart);
  static constexpr int kParts = kCount / kWidth;
  using Part = typename LanePart<kWidth>::Type;

  Part part[kParts];

  LaneBlock() = default;
  // Copied part by part: left to the compiler, a copy goes through smaller words, and the next reader waits
  // for it.
  RPSUP_INLINE LaneBlock(const LaneBlock& other) { *this = other; }
  RPSUP_INLINE LaneBlock& operator=(const LaneBlock& other) {
    for (int i = 0; i < kParts; ++i) part[i] = other.part[i];
    return *this;
  }

  /// @param numbers  as many doubles
  [[nodiscard]] RPSUP_INLINE static LaneBlock load(const void* numbers) {
    using Stored = typename LanePart<kWidth>::Stored;
    LaneBlock lanes;
    for (int i = 0; i < kParts; ++i) lanes.part[i] = static_cast<const Stored*>(numbers)[i];
    return lanes;
  }
  RPSUP_INLINE void store(double* numbers) const {
    using Stored = typename LanePart<kWidth>::Stored;
    for (int i = 0; i < kParts; ++i) reinterpret_cast<Stored*>(numbers)[i] = part[i];
  }
  /// The same number in all lanes.
  [[nodiscard]] RPSUP_INLINE static LaneBlock all(double number) {
    LaneBlock lanes;
    for (Part& p : lanes.part) p = number - Part{};
    return lanes;
  }
  /// A number in the first lane, zero in the others.
  [[nodiscard]] RPSUP_INLINE static LaneBlock first(double number) {
    LaneBlock lanes{};
    lanes.part[0] = Part{number};
    return lanes;
  }
  /// One in a lane, zero in the others.
  [[nodiscard]] RPSUP_INLINE static LaneBlock unit(int lane) {
    LaneBlock lanes{};
    lanes.set(lane, 1.0);
    return lanes;
  }

  [[nodiscard]] RPSUP_INLINE double operator[](int lane) const { return part[lane / kWidth][lane % kWidth]; }
  RPSUP_INLINE void set(int lane, double value) { part[lane / kWidth][lane % kWidth] = value; }
};

template <int count, typename Operation>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> for_each_part(const Operation& operation) {
  LaneBlock<count> result;
  for (int i = 0; i < LaneBlock<count>::kParts; ++i) result.part[i] = operation(i);
  return result;
}
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> operator+(const LaneBlock<count>& a, const LaneBlock<count>& b) {
  return for_each_part<count>([&](int i) RPSUP_INLINE_LAMBDA { return a.part[i] + b.part[i]; });
}
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> operator-(const LaneBlock<count>& a, const LaneBlock<count>& b) {
  return for_each_part<count>([&](int i) RPSUP_INLINE_LAMBDA { return a.part[i] - b.part[i]; });
}
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> operator-(const LaneBlock<count>& a) {
  return for_each_part<count>([&](int i) RPSUP_INLINE_LAMBDA { return -a.part[i]; });
}
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> operator+(double s, const LaneBlock<count>& a) {
  return for_each_part<count>([&](int i) RPSUP_INLINE_LAMBDA { return s + a.part[i]; });
}
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> operator+(const LaneBlock<count>& a, double s) { return s + a; }
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> operator-(double s, const LaneBlock<count>& a) {
  return for_each_part<count>([&](int i) RPSUP_INLINE_LAMBDA { return s - a.part[i]; });
}
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> operator-(const LaneBlock<count>& a, double s) {
  return for_each_part<count>([&](int i) RPSUP_INLINE_LAMBDA { return a.part[i] - s; });
}
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> operator*(double s, const LaneBlock<count>& a) {
  return for_each_part<count>([&](int i) RPSUP_INLINE_LAMBDA { return s * a.part[i]; });
}
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> operator*(const LaneBlock<count>& a, double s) { return s * a; }
template <int count>
RPSUP_INLINE LaneBlock<count>& operator+=(LaneBlock<count>& a, const LaneBlock<count>& b) {
  return a = a + b;
}
template <int count>
RPSUP_INLINE LaneBlock<count>& operator-=(LaneBlock<count>& a, const LaneBlock<count>& b) {
  return a = a - b;
}
/// Lane by lane.
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> operator*(const LaneBlock<count>& a, const LaneBlock<count>& b) {
  return for_each_part<count>([&](int i) RPSUP_INLINE_LAMBDA { return a.part[i] * b.part[i]; });
}
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> operator/(const LaneBlock<count>& a, const LaneBlock<count>& b) {
  return for_each_part<count>([&](int i) RPSUP_INLINE_LAMBDA { return a.part[i] / b.part[i]; });
}
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> operator/(const LaneBlock<count>& a, double s) {
  return for_each_part<count>([&](int i) RPSUP_INLINE_LAMBDA { return a.part[i] / s; });
}
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> operator/(double s, const LaneBlock<count>& a) {
  return for_each_part<count>([&](int i) RPSUP_INLINE_LAMBDA { return s / a.part[i]; });
}
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> sqrt(const LaneBlock<count>& a) {
  return for_each_part<count>([&](int i) RPSUP_INLINE_LAMBDA { return sqrt_of(a.part[i]); });
}
/// Lane by lane: a > b ? yes : no
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> choose_greater(const LaneBlock<count>& a,
                                                           const LaneBlock<count>& b,
                                                           const LaneBlock<count>& yes,
                                                           const LaneBlock<count>& no) {
  return for_each_part<count>(
      [&](int i) RPSUP_INLINE_LAMBDA { return a.part[i] > b.part[i] ? yes.part[i] : no.part[i]; });
}
/// s a + t b
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> combine(double s, const LaneBlock<count>& a, double t,
                                                    const LaneBlock<count>& b) {
  return for_each_part<count>([&](int i) RPSUP_INLINE_LAMBDA { return s * a.part[i] + t * b.part[i]; });
}

/// @returns whether the magnitudes of all lanes are less than limit
template <int count>
[[nodiscard]] RPSUP_INLINE bool all_below(const LaneBlock<count>& a, double limit) {
  using Bits = typename LanePart<LaneBlock<count>::kWidth>::Bits;
  using Part = typename LaneBlock<count>::Part;
  constexpr long long kMagnitude = 0x7fffffffffffffff;
  Bits outside{};
  for (const Part& part : a.part)
    outside |= ~(reinterpret_cast<Part>(reinterpret_cast<Bits>(part) & kMagnitude) < limit);
  return !any(outside);
}

using Lanes = LaneBlock<8>;
/// Numbers in several directions, one a lane: no more than registers hold side by side, so that a vector of
/// them need not leave its registers.
using TangentPack = LaneBlock<kWidestPart>;
using LanePair = LaneBlock<2>;

/// Stores the first half of the lanes, and the second one elsewhere.
template <int count>
RPSUP_INLINE void store_halves(const LaneBlock<count>& a, double* first, double* second) {
  double numbers[count];
  a.store(numbers);
  LaneBlock<count / 2>::load(numbers).store(first);
  LaneBlock<count / 2>::load(numbers + count / 2).store(second);
}

/// Numbers that stand in pairs, one pair a lane: the first and the second of each.
struct LanePairs {
  Lanes first, second;

  /// @param numbers  the first pair, then the others
  [[nodiscard]] RPSUP_INLINE static LanePairs load(const double* numbers) {
    const Lanes a = Lanes::load(numbers), b = Lanes::load(numbers + Lanes::kCount);
    const auto part = [&](int i) RPSUP_INLINE_LAMBDA {
      return i < Lanes::kParts ? a.part[i] : b.part[i - Lanes::kParts];
    };
    LanePairs pairs;
    for (int i = 0; i < Lanes::kParts; ++i) {
      pairs.first.part[i] =
          take_every_other<0>(part(2 * i), part(2 * i + 1), std::make_integer_sequence<int, Lanes::kWidth>());
      pairs.second.part[i] =
          take_every_other<1>(part(2 * i), part(2 * i + 1), std::make_integer_sequence<int, Lanes::kWidth>());
    }
    return pairs;
  }
  RPSUP_INLINE void store(double* numbers) const {
    constexpr int kWidth = Lanes::kWidth;
    using Stored = typename LanePart<kWidth>::Stored;
    for (int i = 0; i < Lanes::kParts; ++i) {
      reinterpret_cast<Stored*>(numbers)[2 * i] =
          alternate<0>(first.part[i], second.part[i], std::make_integer_sequence<int, kWidth>());
      reinterpret_cast<Stored*>(numbers)[2 * i + 1] =
          alternate<kWidth / 2>(first.part[i], second.part[i], std::make_integer_sequence<int, kWidth>());
    }
  }

 private:
  template <int from, int... i>
  [[nodiscard]] RPSUP_INLINE static Lanes::Part take_every_other(const Lanes::Part& a, const Lanes::Part& b,
                                                                 std::integer_sequence<int, i...>) {
    return __builtin_shufflevector(a, b, (2 * i + from)...);
  }
  template <int from, int... i>
  [[nodiscard]] RPSUP_INLINE static Lanes::Part alternate(const Lanes::Part& a, const Lanes::Part& b,
                                                          std::integer_sequence<int, i...>) {
    return __builtin_shufflevector(a, b, (from + i / 2 + (i % 2) * Lanes::kWidth)...);
  }
};

/// The sum of all lanes, halves first: the same for every instruction set.
[[nodiscard]] RPSUP_INLINE double sum(const Lanes& a) {
  const auto half = [&](int i) RPSUP_INLINE_LAMBDA { return a[i] + a[i + 4]; };
  return (half(0) + half(2)) + (half(1) + half(3));
}
[[nodiscard]] RPSUP_INLINE double find_largest(const Lanes& a) {
  double largest = a[0];
  for (int lane = 1; lane < Lanes::kCount; ++lane) largest = a[lane] > largest ? a[lane] : largest;
  return largest;
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
