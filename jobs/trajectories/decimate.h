// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/analysis/quantities.h"

namespace jobs {

/// The fewest points that a trajectory of so many channels beside the time can be thinned out to: its ends,
/// and two of each channel.
[[nodiscard]] constexpr std::size_t fewest_points(std::size_t channels) { return 2 + 2 * channels; }

/// Samples from one on to before another.
struct Stretch {
  std::size_t begin = 0, end = 0;
};

/// Stretches of which decimate() keeps the extremes.
[[nodiscard]] std::vector<Stretch> stretches_of(std::size_t samples, std::size_t channels,
                                                std::size_t points);

/// Marks those of consecutive samples in which a channel has its extremes. A value that is no number is no
/// extreme.
/// @param values  of the samples from `first` on
void mark_extremes(std::span<const double> values, std::size_t first, std::vector<bool>& kept);

/// Thins a trajectory out to at most so many samples, none of which is made up: its first and its last one,
/// and of each of as many equal stretches of time as there is room for, those in which a channel has its
/// smallest and its largest value. So every peak of a stretch stays, and what is left has the same extremes.
/// @param trajectory  with t_s as its first column
/// @param points  >= fewest_points of its channels
void decimate(std::size_t points, engine::Trajectory& trajectory);

}  // namespace jobs
