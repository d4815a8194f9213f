// SPDX-License-Identifier: Apache-2.0
#include "engine/clearance/worn_bore.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <numbers>

namespace engine {

namespace {

constexpr int kAngles = 720;
// 72 degrees beside the offset a gap is more than three times as long as across.
constexpr int kFarthest = kAngles / 5;

/// Least value of the parabola through three neighbouring values, the middle one the least of them.
double find_least(double before, double middle, double after) {
  const double bend = before - 2.0 * middle + after;
  const double rise = after - before;
  return bend > 0.0 ? middle - rise * rise / (8.0 * bend) : middle;
}

/// R - c_r at each of the angles.
std::vector<double> calc_added_clearances(double c_r, const PeriodicSpline& depth) {
  constexpr double kSpacing = 2.0 * std::numbers::pi / kAngles;
  std::vector<double> gap, inverse_cosine;
  for (int k = 0; k < kAngles; ++k) gap.push_back(c_r + depth.at(kSpacing * k).value);
  for (int away = 0; away <= kFarthest + 1; ++away) inverse_cosine.push_back(1.0 / std::cos(kSpacing * away));
  const double narrowest = *std::min_element(gap.begin(), gap.end());
  std::vector<double> added;
  for (int theta = 0; theta < kAngles; ++theta) {
    const auto calc_limit = [&](int away) {  // how far it gets until it touches there
      return gap[static_cast<std::size_t>((theta + away + kAngles) % kAngles)] *
             inverse_cosine[static_cast<std::size_t>(std::abs(away))];
    };
    int nearest = 0;
    double least = calc_limit(0);
    for (int away = 1;
         away <= kFarthest && inverse_cosine[static_cast<std::size_t>(away)] * narrowest < least; ++away) {
      for (const int there : {-away, away}) {
        if (const double limit = calc_limit(there); limit < least) {
          least = limit;
          nearest = there;
        }
      }
    }
    added.push_back(find_least(calc_limit(nearest - 1), calc_limit(nearest), calc_limit(nearest + 1)) - c_r);
  }
  return added;
}

}  // namespace

WornBore::WornBore(double c_r, const WearDepth& depth) {
  for (const std::vector<double>& ring : depth) {
    depths_.emplace_back(ring, 0.5);
    added_clearances_.emplace_back(calc_added_clearances(c_r, depths_.back()), 0.0);
  }
}

}  // namespace engine
