// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/block_instants.h"

#include <cmath>

namespace engine {

namespace {

constexpr double kPerSecond = 1000.0;  // steps end on the grid of milliseconds, times powers of two
constexpr double kSliver = 0.125;      // of a tick: a shorter remainder beside the grid joins the block

/// The same number as that of a sample at the same instant.
double calc_instant(double tick, int level) { return std::ldexp(tick, level) / kPerSecond; }

BlockInstants divide_evenly(double start, double stop) {
  BlockInstants times{};
  for (std::size_t k = 0; k < kBlockSteps; ++k)
    times[k] = start + (stop - start) * static_cast<double>(k) / kBlockSteps;
  times[kBlockSteps] = stop;
  return times;
}

}  // namespace

BlockInstants calc_block_instants(double start, double step, double limit, double duration) {
  int level = std::ilogb(kPerSecond * step);
  const double position = std::ldexp(kPerSecond * start, -level);  // in ticks
  double tick = std::round(position);
  const double length = calc_instant(1.0, level);
  if (calc_instant(tick, level) != start) {
    const double stop = calc_instant(std::floor(position + kSliver) + 1.0, level);
    return divide_evenly(start, stop > limit - kSliver * length ? limit : stop);
  }
  // A limit this near to the grid is on it.
  const double whole = std::floor(std::ldexp(kPerSecond * limit * (1.0 + kSameInstant), -level)) - tick;
  const int halvings = whole >= 4.0 ? 0 : whole >= 2.0 ? 1 : 2;
  level -= halvings;
  tick = std::ldexp(tick, halvings);
  BlockInstants times{};
  for (std::size_t k = 0; k <= kBlockSteps; ++k)
    times[k] = calc_instant(tick + static_cast<double>(k), level);
  const double stop = whole >= 1.0 ? times[kBlockSteps] : limit;
  if (std::abs(limit - stop) < kSameInstant * limit && limit == duration) times[kBlockSteps] = limit;
  const bool leaves_sliver = limit - stop <= kSliver * length && limit - stop >= kSameInstant * limit;
  return stop == limit || leaves_sliver ? divide_evenly(start, limit) : times;
}

}  // namespace engine
