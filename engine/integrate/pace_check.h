// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace engine {

/// Finds runs that crawl long before their last step: a few stretches of a million steps, one after the
/// other, of which each is so slow that the rest of the run would need more steps than are left.
class PaceCheck {
 public:
  /// @param duration  of the run, [s]
  PaceCheck(double duration, long step_limit, long stretch = kStretch)
      : duration_(duration), limit_(static_cast<double>(step_limit)), stretch_(stretch), next_(stretch) {}

  /// @param steps  so far; never fewer than at the last call
  [[nodiscard]] bool is_hopeless(long steps, double t) {
    if (steps < next_) return false;
    const double pace = static_cast<double>(steps - (next_ - stretch_)) / (t - since_);  // [1/s]
    const double left = limit_ - static_cast<double>(steps);
    slow_stretches_ = pace * (duration_ - t) > left ? slow_stretches_ + 1 : 0;
    next_ = steps + stretch_;
    since_ = t;
    return slow_stretches_ >= kSlowStretches;
  }

 private:
  static constexpr long kStretch = 1'000'000;  // [steps]: impacts by the thousand are over by then
  static constexpr int kSlowStretches = 3;

  double duration_, limit_;
  long stretch_, next_;
  double since_ = 0.0;  ///< start of the stretch, [s]
  int slow_stretches_ = 0;
};

}  // namespace engine
