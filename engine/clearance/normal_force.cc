#include "engine/clearance/normal_force.h"

#include <algorithm>

namespace engine {

namespace {

/// Bisects f to the resolution of s in [low, high]; f(low) and f(high) have opposite signs.
template <typename Function>
double bisect(const Function& f, double low, double high) {
  const bool rises = f(low) < f(high);
  while (high - low > 1e-15 * high) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    ((f(middle) < 0.0) == rises ? low : high) = middle;
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
  return bisect([this](double s) { return delta(s); }, low, high);
}

double PenetrationCubic::find_extreme() const {
  return bisect([this](double s) { return rate(s); }, 0.0, 1.0);
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
