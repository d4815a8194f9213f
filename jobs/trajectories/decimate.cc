// SPDX-License-Identifier: Apache-2.0
#include "jobs/trajectories/decimate.h"

#include <span>
#include <vector>

namespace jobs {
namespace {

/// Marks the samples in [begin, end) in which a channel has its extremes. What is no number is no extreme.
void mark_extremes(std::span<const double> column, std::size_t begin, std::size_t end,
                   std::vector<bool>& kept) {
  std::size_t least = end;
  std::size_t largest = end;
  for (std::size_t k = begin; k < end; ++k) {
    if (column[k] != column[k]) continue;
    if (least == end || column[k] < column[least]) least = k;
    if (largest == end || column[k] > column[largest]) largest = k;
  }
  if (least == end) return;
  kept[least] = true;
  kept[largest] = true;
}

}  // namespace

void decimate(std::size_t points, engine::Trajectory& trajectory) {
  if (trajectory.columns.empty() || trajectory.columns.front().size() <= points) return;
  const std::size_t samples = trajectory.columns.front().size();
  const std::span channels = std::span(trajectory.columns).subspan(1);
  std::vector<bool> kept(samples, false);
  kept.front() = true;
  kept.back() = true;
  const std::size_t stretches = channels.empty() ? points - 2 : (points - 2) / (2 * channels.size());
  for (std::size_t s = 0; s < stretches; ++s) {
    const std::size_t begin = samples * s / stretches;
    const std::size_t end = samples * (s + 1) / stretches;
    for (const auto& column : channels) mark_extremes(column, begin, end, kept);
    if (channels.empty()) kept[begin] = true;  // the time alone
  }
  for (auto& column : trajectory.columns) {
    std::size_t size = 0;
    for (std::size_t k = 0; k < samples; ++k) {
      if (kept[k]) column[size++] = column[k];
    }
    column.resize(size);
  }
}

}  // namespace jobs
