// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/math/instruction_set.h"

namespace engine {

/// Layout of the state vector y of MotionSystem:
///
///     y = (q, v, bristles, works)
///     works = (work of each drive, of each applied force that has one, and of each body load,
///              impact loss, friction loss, structural loss)
///
/// with q the free coordinates and v their rates. Members give the index of an entry of y. Functions are
/// inlined everywhere: instruction sets share none of them.
struct StateLayout {
  int free = 0;      ///< free coordinates
  int bristles = 0;  ///< of all joints with clearance
  int drives = 0;
  int applied = 0;   ///< works of applied forces and, behind them, of body loads

  [[nodiscard]] RPSUP_INLINE constexpr int q(int i = 0) const { return i; }
  [[nodiscard]] RPSUP_INLINE constexpr int v(int i = 0) const { return free + i; }
  [[nodiscard]] RPSUP_INLINE constexpr int bristle(int i = 0) const { return 2 * free + i; }
  [[nodiscard]] RPSUP_INLINE constexpr int work(int i = 0) const { return 2 * free + bristles + i; }
  [[nodiscard]] RPSUP_INLINE constexpr int impact() const { return work(impact_in_works()); }
  [[nodiscard]] RPSUP_INLINE constexpr int friction() const { return work(friction_in_works()); }
  [[nodiscard]] RPSUP_INLINE constexpr int structural() const { return work(structural_in_works()); }
  [[nodiscard]] RPSUP_INLINE constexpr int size() const { return work(works()); }
  /// Size of (q, v, bristles), whose errors are controlled.
  [[nodiscard]] RPSUP_INLINE constexpr int controlled_size() const { return work(); }

  // Within the works
  [[nodiscard]] RPSUP_INLINE constexpr int works() const { return drives + applied + 3; }
  [[nodiscard]] RPSUP_INLINE constexpr int applied_in_works(int i = 0) const { return drives + i; }
  [[nodiscard]] RPSUP_INLINE constexpr int impact_in_works() const { return drives + applied; }
  [[nodiscard]] RPSUP_INLINE constexpr int friction_in_works() const { return impact_in_works() + 1; }
  [[nodiscard]] RPSUP_INLINE constexpr int structural_in_works() const { return impact_in_works() + 2; }
};

}  // namespace engine
