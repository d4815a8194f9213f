// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/dynamics/motion_system.h"
#include "engine/integrate/stepper.h"
#include "engine/integrate/unstable_modes.h"

namespace engine {

/// Limits the steps of an implicit method to those that resolve the unstable modes of the motion.
///
/// A step that resolves a growing vibration lets its own errors grow, too, and they are larger than the
/// vibration's beginnings. So a step is limited only once the vibration may have grown above the errors: its
/// estimated log-growth, the sum of growth times time over the checks, must exceed kLogGrowthBeforeLimiting.
class UnstableModeLimiter {
 public:
  /// @param check_interval  time between two checks, [s]; infinite: no check
  /// @param longest_step    [s]
  /// @param free_count      free coordinates of the system
  UnstableModeLimiter(double check_interval, double longest_step, Eigen::Index free_count)
      : check_interval_(check_interval),
        longest_step_(longest_step),
        max_step_(longest_step),
        modes_(free_count) {}

  /// Longest step that the last check allows, [s].
  [[nodiscard]] double max_step() const { return max_step_; }
  [[nodiscard]] bool is_check_due(double t) const { return t >= last_check_ + check_interval_; }

  /// Computes the unstable modes about the start of the next step. Without friction forces there are none.
  void check_local_stability(MotionSystem& system, const StepPoint& start, Stepper& stepper);

 private:
  static constexpr double kLogGrowthBeforeLimiting =
      5.0;  ///< 0 would resolve errors; 10 many vibrations too late
  static constexpr double kMaxPhase =
      1.5;  ///< of a mode in a step, [rad]: radau5 takes a thousandth of its amplitude then

  double check_interval_;      ///< [s]
  double longest_step_;        ///< [s]
  double max_step_;            ///< [s]
  double last_check_ = 0.0;    ///< [s]
  double log_growth_ = 0.0;    ///< of the unstable modes, since they became unstable
  UnstableModes modes_;
};

}  // namespace engine
