// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/unstable_mode_limiter.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/integrate/choose_integrator.h"

namespace engine {

namespace {

bool has_friction_force(const Evaluation& at) {
  return std::ranges::any_of(at.joints,
                             [](const JointState& joint) { return joint.load.friction_sum > 0.0; });
}

}  // namespace

UnstableModeLimiter::UnstableModeLimiter(const Mechanism& mechanism, Integrator integrator,
                                         Eigen::Index free_count)
    : has_clearance_(has_clearance(mechanism)),
      has_joint_friction_(has_joint_friction(mechanism)),
      check_interval_(choose_stability_check_interval(mechanism, integrator, free_count)),
      longest_step_(choose_longest_step(mechanism, integrator)),
      max_step_(longest_step_),
      last_check_(has_clearance_ ? 0.0 : -std::numeric_limits<double>::infinity()),
      modes_(free_count) {}

void UnstableModeLimiter::check_local_stability(MotionSystem& system, const StepPoint& start,
                                                Stepper& stepper) {
  const double since = start.t - std::exchange(last_check_, start.t);
  const double log_growth = std::exchange(log_growth_, 0.0);
  max_step_ = longest_step_;
  if (!has_joint_friction_ && !has_friction_force(start.at)) return;
  const NewtonSolver solver = system.choose_newton_solver(stepper.shifts());
  if (system.linearise(start.t, start.y, solver) != EvaluationStatus::kOk) return stepper.invalidate();
  const Instability found = modes_.find(system, has_clearance_ ? kSlowestWithClearance : kSlowestWithout);
  stepper.jacobian_refreshed();
  if (found.growth == 0.0) return;
  log_growth_ = log_growth + found.growth * since;
  if (!has_clearance_ || log_growth_ >= kLogGrowthBeforeLimiting)
    max_step_ = std::min(longest_step_, kMaxPhase / found.frequency);
}

}  // namespace engine
