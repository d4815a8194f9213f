// SPDX-License-Identifier: Apache-2.0
#include "engine/clearance/normal_force.h"

#include <algorithm>
#include <cmath>

namespace engine {

namespace {

/// Zero of f in [low, high], to the resolution of s; f(low) and f(high) have opposite signs.
/// Newton's iteration from the middle, kept in a bracket of opposite signs: where it would leave the bracket
/// or does not halve its last step, the bracket is bisected.
template <typename Function, typename Slope>
double find_zero(const Function& f, const Slope& slope, double low, double high) {
  const bool rises = f(low) < f(high);
  double s = 0.5 * (low + high);
  double last = high - low;
  while (high - low > 1e-15 * high) {
    const double value = f(s);
    if (value == 0.0) return s;
    ((value < 0.0) == rises ? low : high) = s;
    double next = s - value / slope(s);
    if (!(next > low && next < high && std::abs(next - s) < 0.5 * last)) next = 0.5 * (low + high);
    last = std::abs(next - s);
    if (last <= 1e-15 * high) return next;
    s = next;
  }
  return high;
}

}  // namespace

PenetrationCubic::PenetrationCubic(const Penetration& start, const Penetration& end, double dt)
    : dt_(dt),
      a_(2.0 * (start.delta - end.delta) + dt * (start.rate + end.rate)),
      b_(3.0 * (end.delta - start.delta) - dt * (2.0 * start.rate + end.rate)),
      c_(dt * start.rate),
      d_(start.delta) {}

double PenetrationCubic::find_root(double low, double high) const {
  return find_zero([this](double s) { return delta(s); },
                   [this](double s) { return (3.0 * a_ * s + 2.0 * b_) * s + c_; }, low, high);
}

double PenetrationCubic::find_extreme() const {
  return find_zero([this](double s) { return rate(s); },
                   [this](double s) { return (6.0 * a_ * s + 2.0 * b_) / dt_; }, 0.0, 1.0);
}

bool OnsetLatch::advance(const Penetration& start, const Penetration& end, double dt, double minimum) {
  if (end.delta <= 0.0) {
    const bool ended = in_contact();
    rate_ = 0.0;
    return ended;
  }
  if (in_contact()) return false;
  const PenetrationCubic cubic(start, end, dt);
  const double crossing = start.delta < 0.0 ? cubic.find_root(0.0, 1.0) : 0.0;
  rate_ = std::max(cubic.rate(crossing), minimum);
  return true;
}

}  // namespace engine
