// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace engine {

/// Steps of a block of a kinematic run.
inline constexpr std::size_t kBlockSteps = 4;
using BlockInstants = std::array<double, kBlockSteps + 1>;  ///< [s]

/// Part of the time by which two instants may differ and be the same.
inline constexpr double kSameInstant = 1e-12;

/// Instants of a block of steps of about `step`, at most. They lie on the grid of milliseconds times a power
/// of two, or lead to it: common output rates find their samples on it, and steps do not depend on the output
/// rate. Worked cases:
///
///     start 6 ms, step 2.5 ms, limit far: the grid is that of 2 ms, and start is on it.
///       6, 8, 10, 12, 14 ms
///     start 5.3 ms, step 1.2 ms, limit far: the grid is that of 1 ms, and start is off it. Four equal
///       steps lead to the next point of the grid: 5.3, 5.475, 5.65, 5.825, 6 ms.
///     start 6 ms, step 1.2 ms, limit 8.05 ms: two whole ticks of 1 ms fit, so ticks are halved, 6, 6.5,
///       7, 7.5, 8 ms. The remainder of 0.05 ms is a sliver: four equal steps lead to the limit instead.
///
/// @param limit     corner of a drive's law or the end of the run, [s]
/// @param duration  of the run, [s]
[[nodiscard]] BlockInstants calc_block_instants(double start, double step, double limit, double duration);

}  // namespace engine
