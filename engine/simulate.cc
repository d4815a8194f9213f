// SPDX-License-Identifier: Apache-2.0
#include "engine/simulate.h"

#include <string>

#include "engine/dynamics/loop_closure.h"
#include "engine/integrate/integration.h"
#include "engine/integrate/kinematic_run.h"

namespace engine {

std::string_view status_name(RunStatus status) {
  switch (status) {
    case RunStatus::kSucceeded: return "succeeded";
    case RunStatus::kAssembly: return "assembly";
    case RunStatus::kLockUp: return "lock_up";
    case RunStatus::kContactRange: return "contact_range";
    case RunStatus::kNonFinite: return "non_finite";
    case RunStatus::kStepUnderflow: return "step_underflow";
    case RunStatus::kStepLimit: return "step_limit";
    case RunStatus::kStopped: return "stopped";
  }
  return "unknown";
}

RunOutcome simulate(const Mechanism& mechanism, const RunOptions& options, Observer& observer) {
  LoopClosure closure(mechanism);
  Evaluation assembled = MotionSystem(mechanism).make_evaluation();
  if (!closure.assemble(0.0, assembled)) {
    RunOutcome outcome;
    outcome.status = RunStatus::kAssembly;
    outcome.detail = closure.rates_fit()
                     ? "the loop cannot be closed at t = 0: the nearest position found leaves a gap of " +
                           std::to_string(closure.residual()) + " m"
                     : "the velocities given for t = 0 would tear the loop apart";
    return outcome;
  }
  bool ideal = mechanism.drive_rows == DriveRows::kEliminated && options.integrator != Integrator::kRk4;
  for (const CutJoint& joint : mechanism.cut_joints) ideal = ideal && !joint.clearance;
  if (ideal && closure.is_determined() && closure.redundant() == 0)
    return run_kinematics(mechanism, closure, options, observer, assembled);
  if (closure.redundant() == 0) return Integration(mechanism, options, observer).run(assembled);
  Mechanism dependent = mechanism;
  dependent.minimum_norm_multipliers = true;
  RunOutcome outcome = Integration(dependent, options, observer).run(assembled);
  outcome.redundant_constraints = static_cast<int>(closure.redundant());
  return outcome;
}

}  // namespace engine
