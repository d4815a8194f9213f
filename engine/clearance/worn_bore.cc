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
// 89 degrees beside the offset, a gap is 57 times as long as across.
constexpr int kFarthest = kAngles / 4 - 2;

/// Least value of the parabola through three neighbouring values, the middle one the least of them.
double find_least(double before, double middle, double after) {
  const double bend = before - 2.0 * middle + after;
  const double rise = after - before;
  return bend > 0.0 ? middle - rise * rise / (8.0 * bend) : middle;
}

/// The gap around a centred journal, at each of the angles.
class WornGap {
 public:
  WornGap(double c_r, const PeriodicSpline& depth) {
    constexpr double kSpacing = 2.0 * std::numbers::pi / kAngles;
    for (int k = 0; k < kAngles; ++k) gap_.push_back(c_r + depth.at(kSpacing * k).value);
    for (int away = 0; away <= kFarthest + 1; ++away)
      inverse_cosine_.push_back(1.0 / std::cos(kSpacing * away));
    narrowest_ = *std::min_element(gap_.begin(), gap_.end());
  }

  /// Way of the journal in the direction theta until it touches so many angles away from it, [m].
  [[nodiscard]] double calc_limit(int theta, int away) const {
    return gap_[static_cast<std::size_t>((theta + away + kAngles) % kAngles)] *
           inverse_cosine_[static_cast<std::size_t>(std::abs(away))];
  }

  /// Place at which the journal touches first, in angles away from theta.
  [[nodiscard]] int find_nearest(int theta) const {
    int nearest = 0;
    double least = calc_limit(theta, 0);
    for (int away = 1;
         away <= kFarthest && inverse_cosine_[static_cast<std::size_t>(away)] * narrowest_ < least; ++away) {
      for (const int there : {-away, away}) {
        if (const double limit = calc_limit(theta, there); limit < least) {
          least = limit;
          nearest = there;
        }
      }
    }
    return nearest;
  }

 private:
  std::vector<double> gap_, inverse_cosine_;
  double narrowest_;
};

/// R - c_r at each of the angles.
std::vector<double> calc_added_clearances(double c_r, const PeriodicSpline& depth) {
  const WornGap gap(c_r, depth);
  std::vector<double> added;
  for (int theta = 0; theta < kAngles; ++theta) {
    const int nearest = gap.find_nearest(theta);
    const double limit = find_least(gap.calc_limit(theta, nearest - 1), gap.calc_limit(theta, nearest),
                                    gap.calc_limit(theta, nearest + 1));
    added.push_back(limit - c_r);
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
