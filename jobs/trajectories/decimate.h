// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "engine/analysis/quantities.h"

namespace jobs {

/// The fewest points that a trajectory of so many channels beside the time can be thinned out to: its ends,
/// and two of each channel.
[[nodiscard]] constexpr std::size_t fewest_points(std::size_t channels) { return 2 + 2 * channels; }

/// Thins a trajectory out to at most so many samples, none of which is made up: its first and its last one,
/// and of each of as many equal stretches of time as there is room for, those in which a channel has its
/// smallest and its largest value. So every peak of a stretch stays, and what is left has the same extremes.
/// @param trajectory  with t_s as its first column
/// @param points  >= fewest_points of its channels
void decimate(std::size_t points, engine::Trajectory& trajectory);

}  // namespace jobs
