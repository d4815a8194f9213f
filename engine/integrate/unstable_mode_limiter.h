// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/dynamics/motion_system.h"
#include "engine/integrate/stepper.h"
#include "engine/integrate/unstable_modes.h"
#include "engine/model/mechanism.h"
#include "engine/model/run_options.h"

namespace engine {

/// Limits the steps of an implicit method to those that resolve the unstable modes of the motion.
///
/// With clearance, impacts begin a vibration again and again. A step that resolves it lets its own errors
/// grow, too, and they are larger than the vibration's beginnings. So a step is limited only once the
/// vibration may have grown above the errors: its estimated log-growth, the sum of growth times time over the
/// checks, must exceed kLogGrowthBeforeLimiting. Without clearance nothing begins a vibration again that
/// longer steps have damped: steps are limited at once.
class UnstableModeLimiter {
 public:
  /// @param free_count  free coordinates of the system
  UnstableModeLimiter(const Mechanism& mechanism, Integrator integrator, Eigen::Index free_count);

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

  /// Growth of the modes that are looked for, [1/s]. Contacts change before a slower mode has grown; without
  /// any, one has the whole run for it.
  static constexpr double kSlowestWithClearance = 20.0, kSlowestWithout = 0.5;

  const bool has_clearance_, has_joint_friction_;
  double check_interval_;      ///< [s]; infinite: no check
  double longest_step_;        ///< [s]
  double max_step_;            ///< [s]
  double last_check_;          ///< [s]; before the start: the start is checked
  double log_growth_ = 0.0;    ///< of the unstable modes, since they became unstable
  UnstableModes modes_;
};

}  // namespace engine
