// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/unstable_mode_limiter.h"

#include <algorithm>
#include <utility>

namespace engine {

namespace {

bool has_friction_force(const Evaluation& at) {
  return std::ranges::any_of(at.joints,
                             [](const JointState& joint) { return joint.load.friction_sum > 0.0; });
}

}  // namespace

void UnstableModeLimiter::check_local_stability(MotionSystem& system, const StepPoint& start,
                                                Stepper& stepper) {
  const double since = start.t - std::exchange(last_check_, start.t);
  const double log_growth = std::exchange(log_growth_, 0.0);
  max_step_ = longest_step_;
  if (!has_friction_force(start.at)) return;
  const NewtonSolver solver = system.choose_newton_solver(stepper.shifts());
  if (system.linearise(start.t, start.y, solver) != EvaluationStatus::kOk) return stepper.invalidate();
  const Instability found = modes_.find(system);
  stepper.jacobian_refreshed();
  if (found.growth == 0.0) return;
  log_growth_ = log_growth + found.growth * since;
  if (log_growth_ >= kLogGrowthBeforeLimiting)
    max_step_ = std::min(longest_step_, kMaxPhase / found.frequency);
}

}  // namespace engine
