// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "engine/integrate/block_instants.h"
#include "engine/integrate/quartic.h"

namespace engine {

/// Short step around the extremum of an acceleration, of a step.
inline constexpr double kExtremumStep = 1.0 / 32.0;

/// Root of the interpolant's slope, by bisection. The slope has opposite signs at the two ends.
[[nodiscard]] inline double find_extremum(const Quartic& interpolant, double from, double to) {
  constexpr int kHalvings = 40;
  const bool rises = interpolant.slope(from) > 0.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (from + to);
    ((interpolant.slope(middle) > 0.0) == rises ? from : to) = middle;
  }
  return 0.5 * (from + to);
}

/// Quantity whose extrema become ends of steps of a kinematic run.
class TrackedQuantity {
 public:
  /// Takes the values at the instants of a block.
  /// @returns the largest magnitude among them
  double set(const BlockInstants& f) {
    const auto [least, most] = std::minmax_element(f.begin(), f.end());
    interpolant_ = Quartic(f[0], f[1], f[2], f[3], f[4]);
    range_ = *most - *least;
    const double largest = std::max(std::abs(*least), std::abs(*most));
    largest_ = std::max(largest_, largest);
    return largest;
  }

  /// The quartic through the values of the block, over the number of steps.
  [[nodiscard]] const Quartic& interpolant() const { return interpolant_; }
  /// Magnitude in the run so far.
  [[nodiscard]] double largest() const { return largest_; }

  /// Extrema: one in each step between whose ends the slope of the interpolant changes sign. An extremum at
  /// the common end of two blocks is found by both.
  /// @param scale  magnitude against which a range may be rounding
  /// @param take   gets the place, in steps from the block's start
  template <typename Take>
  void for_each_extremum(double scale, const Take& take) const {
    constexpr double kRounding = 1e-10;
    if (!(range_ > kRounding * scale)) return;
    const double over = 0.25 * kExtremumStep;
    const std::array<double, kBlockSteps + 1> positions{-over, 1.0, 2.0, 3.0, kBlockSteps + over};
    double slope = interpolant_.slope(positions[0]);
    for (std::size_t k = 1; k <= kBlockSteps; ++k) {
      const double next = interpolant_.slope(positions[k]);
      if (slope * next < 0.0) take(find_extremum(interpolant_, positions[k - 1], positions[k]));
      slope = next;
    }
  }

 private:
  Quartic interpolant_;
  double range_ = 0.0;  ///< largest minus least value in the block
  double largest_ = 0.0;
};

}  // namespace engine
