// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

#include "engine/math/instruction_set.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// @returns whether x is neither infinite nor not a number, by its bits: the equations of motion are compiled
/// as if every number were one
[[nodiscard]] RPSUP_INLINE bool is_number(double x) {
  constexpr std::uint64_t kExponent = 0x7ff0000000000000;
  return (std::bit_cast<std::uint64_t>(x) & kExponent) != kExponent;
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
