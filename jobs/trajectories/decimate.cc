// SPDX-License-Identifier: Apache-2.0
#include "jobs/trajectories/decimate.h"

#include <span>
#include <vector>

namespace jobs {
namespace {

void remove_others(const std::vector<bool>& kept, std::vector<double>& column) {
  std::size_t size = 0;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    if (kept[k]) column[size++] = column[k];
  }
  column.resize(size);
}

}  // namespace

void mark_extremes(std::span<const double> values, std::size_t first, std::vector<bool>& kept) {
  const std::size_t end = values.size();
  std::size_t least = end;
  std::size_t largest = end;
  for (std::size_t k = 0; k < end; ++k) {
    if (values[k] != values[k]) continue;
    if (least == end || values[k] < values[least]) least = k;
    if (largest == end || values[k] > values[largest]) largest = k;
  }
  if (least == end) return;
  kept[first + least] = true;
  kept[first + largest] = true;
}

std::vector<Stretch> stretches_of(std::size_t samples, std::size_t channels, std::size_t points) {
  const std::size_t count = channels == 0 ? points - 2 : (points - 2) / (2 * channels);
  std::vector<Stretch> stretches;
  stretches.reserve(count);
  for (std::size_t s = 0; s < count; ++s)
    stretches.push_back({.begin = samples * s / count, .end = samples * (s + 1) / count});
  return stretches;
}

void decimate(std::size_t points, engine::Trajectory& trajectory) {
  if (trajectory.columns.empty() || trajectory.columns.front().size() <= points) return;
  const std::size_t samples = trajectory.columns.front().size();
  const std::span channels = std::span(trajectory.columns).subspan(1);
  std::vector<bool> kept(samples, false);
  kept.front() = true;
  kept.back() = true;
  for (const auto& [begin, end] : stretches_of(samples, channels.size(), points)) {
    for (const auto& column : channels)
      mark_extremes(std::span(column).subspan(begin, end - begin), begin, kept);
    if (channels.empty()) kept[begin] = true;  // the time alone
  }
  for (auto& column : trajectory.columns) remove_others(kept, column);
}

}  // namespace jobs
