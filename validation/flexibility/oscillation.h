// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "validation/engine_names.h"

namespace validation {

/// Extrema of a sampled oscillation, each from the parabola through three samples.
struct Extremum {
  double t, value;
};
[[nodiscard]] inline std::vector<Extremum> find_extrema(const std::vector<double>& t,
                                                        const std::vector<double>& x, double from) {
  std::vector<Extremum> extrema;
  for (std::size_t k = 1; k + 1 < x.size(); ++k) {
    if (t[k] < from || (x[k] - x[k - 1]) * (x[k + 1] - x[k]) > 0.0) continue;
    const double slope = 0.5 * (x[k + 1] - x[k - 1]);
    const double curvature = x[k + 1] - 2.0 * x[k] + x[k - 1];
    const double s = -slope / curvature;
    extrema.push_back({t[k] + s * (t[k + 1] - t[k]), x[k] + 0.5 * s * slope});
  }
  return extrema;
}

struct Oscillation {
  double frequency;      ///< damped, [Hz]
  double damping_ratio;  ///< [1]
};
[[nodiscard]] inline Oscillation measure(const std::vector<Extremum>& extrema) {
  if (extrema.size() < 40)
    throw std::runtime_error("a run of the validation failed: there is no swing to measure");
  const std::size_t last = extrema.size() - 1;
  const auto half_periods = static_cast<double>(last - 1);
  const double first_swing = std::abs(extrema[1].value - extrema[0].value);
  const double last_swing = std::abs(extrema[last].value - extrema[last - 1].value);
  // of half a period: pi zeta / sqrt(1 - zeta^2)
  const double decrement = std::log(first_swing / last_swing) / half_periods;
  return {0.5 * static_cast<double>(last) / (extrema[last].t - extrema[0].t),
          decrement / std::hypot(decrement, std::numbers::pi)};
}

}  // namespace validation
