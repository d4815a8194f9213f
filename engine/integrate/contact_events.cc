// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/contact_events.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace engine {

namespace {

/// First crossing of one ring as a fraction of the step, if it crosses at all.
std::optional<double> find_crossing(const Penetration& start, const Penetration& end,
                                    const PenetrationCubic& cubic) {
  const bool was_in = start.delta > 0.0;
  const bool is_in = end.delta > 0.0;
  if (was_in != is_in)
    return std::abs(end.delta) <= ContactEvents::kBand ? std::nullopt
                                                       : std::optional(cubic.find_root(0.0, 1.0));
  // In and out again, or out and in: only if the penetration reverses in between.
  const bool reverses = was_in ? start.rate < 0.0 && end.rate > 0.0 : start.rate > 0.0 && end.rate < 0.0;
  if (!reverses) return std::nullopt;
  const double extreme = cubic.find_extreme();
  const double delta = was_in ? -cubic.delta(extreme) : cubic.delta(extreme);
  if (delta <= ContactEvents::kBand) return std::nullopt;
  return cubic.find_root(0.0, extreme);
}

}  // namespace

std::optional<double> ContactEvents::find_first(const std::vector<Penetration>& start,
                                                const std::vector<Penetration>& end, double dt) {
  std::optional<double> first;
  for (std::size_t i = 0; i < start.size(); ++i) {
    const PenetrationCubic cubic(start[i], end[i], dt);
    const std::optional<double> s = find_crossing(start[i], end[i], cubic);
    if (!s) continue;
    const double beyond = *s * dt + 0.5 * kBand / std::max(std::abs(cubic.rate(*s)), 1e-6);
    if (beyond < dt && (!first || beyond < *first)) first = beyond;
  }
  return first;
}

}  // namespace engine
