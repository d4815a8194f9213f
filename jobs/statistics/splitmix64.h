// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace jobs {

/// The k-th number, from 1, of the generator splitmix64 that starts from the seed. Written down here because
/// what is made of a seed must be the same with every compiler and library, forever.
[[nodiscard]] constexpr std::uint64_t splitmix64(std::uint64_t seed, std::uint64_t k) {
  std::uint64_t z = seed + k * 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

}  // namespace jobs
