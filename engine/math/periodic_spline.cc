// SPDX-License-Identifier: Apache-2.0
#include "engine/math/periodic_spline.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace engine {

PeriodicSpline::PeriodicSpline(std::vector<double> values, double first)
    : values_(std::move(values)),
      first_(first),
      spacing_(2.0 * std::numbers::pi / static_cast<double>(values_.size())) {}

PeriodicSpline::Point PeriodicSpline::at(double angle) const {
  const double position = angle / spacing_ - first_;
  const double whole = std::floor(position);
  const double t = position - whole;
  const double s = 1.0 - t;
  const auto count = static_cast<long>(values_.size());
  const auto value = [&](long k) { return values_[static_cast<std::size_t>(((k % count) + count) % count)]; };
  const auto before = static_cast<long>(whole);
  // Differences from one of the four: a spline of equal values is that value, and flat, to the last bit.
  const double v = value(before);
  const double a = value(before - 1) - v, b = value(before + 1) - v, c = value(before + 2) - v;
  return {v + (s * s * s * a + (1.0 + 3.0 * t * (1.0 + t * s)) * b + t * t * t * c) / 6.0,
          (-s * s * a + (1.0 + 2.0 * t - 3.0 * t * t) * b + t * t * c) / (2.0 * spacing_),
          (s * a + (1.0 - 3.0 * t) * b + t * c) / (spacing_ * spacing_)};
}

}  // namespace engine
