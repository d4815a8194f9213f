// SPDX-License-Identifier: Apache-2.0
#include "engine/simulate.h"

#include <optional>
#include <string>

#include "engine/dynamics/loop_closure.h"
#include "engine/integrate/integration.h"
#include "engine/integrate/kinematic_run.h"
#include "engine/integrate/spherical_charts.h"

namespace engine {

std::string_view status_name(RunStatus status) {
  switch (status) {
    case RunStatus::kSucceeded: return "succeeded";
    case RunStatus::kAssembly: return "assembly";
    case RunStatus::kLockUp: return "lock_up";
    case RunStatus::kSingular: return "singular";
    case RunStatus::kContactRange: return "contact_range";
    case RunStatus::kNonFinite: return "non_finite";
    case RunStatus::kStepUnderflow: return "step_underflow";
    case RunStatus::kStepLimit: return "step_limit";
    case RunStatus::kStopped: return "stopped";
  }
  return "unknown";
}

namespace {

std::string describe_assembly_fault(const LoopClosure& closure) {
  if (closure.turned_over_joint() >= 0) return "the loop closes at t = 0 only with a joint turned over";
  if (!closure.rates_fit()) return "the velocities given for t = 0 would tear the loop apart";
  return "the loop cannot be closed at t = 0: the nearest position found leaves a gap of " +
         std::to_string(closure.residual()) + " m";
}

std::string describe_lock(LoopClosure::Start start) {
  if (start == LoopClosure::Start::kImmovable)
    return "the linkage cannot move from its start, though velocities could be given: its links "
           "are stretched into one line, say";
  return "no accelerations satisfy the joints and the drives at t = 0";
}

/// The outcome of a run that cannot begin from its start.
std::optional<RunOutcome> find_start_fault(const Mechanism& mechanism, LoopClosure& closure,
                                           LoopClosure::Determinacy determinacy,
                                           const Evaluation& assembled) {
  if (determinacy == LoopClosure::Determinacy::kSingularStart)
    return RunOutcome{.status = RunStatus::kSingular,
                      .detail = describe_change_point(mechanism, assembled) +
                                "; start beside it, or give another coordinate its start and start rate"};
  if (determinacy == LoopClosure::Determinacy::kDetermined) return std::nullopt;
  const LoopClosure::Start start = closure.find_start(assembled);
  if (start == LoopClosure::Start::kRegular) return std::nullopt;
  if (start == LoopClosure::Start::kChangePoint)
    return RunOutcome{.status = RunStatus::kSingular,
                      .detail = describe_change_point(mechanism, assembled) +
                                "; start beside it, or with rates along one of the ways"};
  return RunOutcome{.status = RunStatus::kLockUp, .detail = describe_lock(start)};
}

/// The start with spherical joints in charts far from gimbal lock, which is none of the linkage.
struct ChartedStart {
  ChartedStart(const Mechanism& given, const Evaluation& assembled)
      : at(assembled), mechanism(begin_charts(given, at)), closure(mechanism) {}

  Evaluation at;
  Mechanism mechanism;
  LoopClosure closure;

 private:
  static Mechanism begin_charts(Mechanism mechanism, Evaluation& at) {
    SphericalCharts(mechanism).update(mechanism, at.q, at.qd);
    return mechanism;
  }
};

/// @returns how the drives determine the motion. A run that is solved instant by instant keeps the given
/// charts: from gimbal lock, which other charts do not have, the motion is integrated as if free.
LoopClosure::Determinacy find_determinacy(LoopClosure& given, const Evaluation& assembled,
                                          ChartedStart& charted) {
  using Determinacy = LoopClosure::Determinacy;
  const Determinacy found = given.find_determinacy(assembled);
  if (found != Determinacy::kSingularStart) return found;
  return charted.closure.find_determinacy(charted.at) == found ? found : Determinacy::kFree;
}

RunOutcome integrate(const Mechanism& mechanism, const RunOptions& options, Observer& observer,
                     const Evaluation& assembled, Eigen::Index redundant) {
  if (redundant == 0) return Integration(mechanism, options, observer).run(assembled);
  Mechanism dependent = mechanism;
  dependent.minimum_norm_multipliers = true;
  return Integration(dependent, options, observer).run(assembled);
}

}  // namespace

RunOutcome simulate(const Mechanism& mechanism, const RunOptions& options, Observer& observer) {
  using Determinacy = LoopClosure::Determinacy;
  LoopClosure closure(mechanism);
  Evaluation assembled = MotionSystem(mechanism).make_evaluation();
  if (!closure.assemble(0.0, assembled))
    return {.status = RunStatus::kAssembly, .detail = describe_assembly_fault(closure)};
  ChartedStart start(mechanism, assembled);
  const Determinacy determinacy = allows_kinematics(mechanism, options.integrator)
                                      ? find_determinacy(closure, assembled, start)
                                      : Determinacy::kFree;
  if (const auto fault = find_start_fault(mechanism, start.closure, determinacy, start.at)) return *fault;
  const Eigen::Index redundant = start.closure.count_redundant(start.at);
  RunOutcome outcome = determinacy == Determinacy::kDetermined
                           ? run_kinematics(mechanism, closure, options, observer, assembled)
                           : integrate(mechanism, options, observer, assembled, redundant);
  outcome.redundant_constraints = static_cast<int>(redundant);
  return outcome;
}

}  // namespace engine
