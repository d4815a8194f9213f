// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/model/drive_law.h"

namespace engine {

/// Bends such that slopes agree where pieces meet, by Thomas's algorithm; those of the ends are 0.
Spline::Spline(std::vector<double> t, std::vector<double> q)
    : t_(std::move(t)), q_(std::move(q)), bend_(t_.size(), 0.0) {
  assert(t_.size() >= 2 && t_.size() == q_.size());
  const std::size_t last = t_.size() - 1;
  std::vector<double> above(t_.size(), 0.0);
  for (std::size_t k = 1; k < last; ++k) {
    const double before = t_[k] - t_[k - 1], after = t_[k + 1] - t_[k];
    const double slope_change = 6.0 * ((q_[k + 1] - q_[k]) / after - (q_[k] - q_[k - 1]) / before);
    const double pivot = 2.0 * (before + after) - before * above[k - 1];
    above[k] = after / pivot;
    bend_[k] = (slope_change - before * bend_[k - 1]) / pivot;
  }
  for (std::size_t k = last; k-- > 1;) bend_[k] -= above[k] * bend_[k + 1];
}

std::size_t Spline::piece_of(double t) const {
  const auto after = std::upper_bound(t_.begin() + 1, t_.end() - 1, t);
  return static_cast<std::size_t>(after - t_.begin()) - 1;
}

DrivenMotion Spline::calc(double t) const {
  const std::size_t k = piece_of(t);
  const double length = t_[k + 1] - t_[k];
  const double straight = (q_[k + 1] - q_[k]) / length;
  const double jerk = (bend_[k + 1] - bend_[k]) / length;
  const double slope = straight - length * (2.0 * bend_[k] + bend_[k + 1]) / 6.0;
  if (t < t_.front()) return {q_.front() + slope * (t - t_.front()), slope, 0.0, 0.0};
  const double s = std::min(t, t_.back()) - t_[k];
  const double rate = slope + s * (bend_[k] + 0.5 * s * jerk);
  if (t >= t_.back()) return {q_.back() + rate * (t - t_.back()), rate, 0.0, 0.0};
  return {q_[k] + s * (slope + s * (0.5 * bend_[k] + s * jerk / 6.0)), rate, bend_[k] + s * jerk, jerk};
}

double Spline::next_knot(double t) const {
  const auto next = std::upper_bound(t_.begin(), t_.end(), t + 1e-12 * std::abs(t));
  return next == t_.end() ? std::numeric_limits<double>::infinity() : *next;
}

double Spline::time_scale(double t) const {
  const DrivenMotion motion = calc(t);
  return 1.0 /
         std::max({std::abs(motion.qd), std::sqrt(std::abs(motion.qdd)), std::cbrt(std::abs(motion.qddd))});
}

}  // namespace engine
