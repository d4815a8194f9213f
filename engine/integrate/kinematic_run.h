#pragma once

#include "engine/dynamics/loop_closure.h"
#include "engine/integrate/observer.h"
#include "engine/integrate/run_end.h"
#include "engine/model/run_options.h"

namespace engine {

/// Runs a mechanism whose motion the drives decide alone: positions, velocities, accelerations and forces at each instant, no integration.
/// The drives' work is Simpson's sum over pairs of steps.
[[nodiscard]] RunEnd run_kinematics(const Mechanism& mechanism, LoopClosure& closure, const RunOptions& options, Observer& observer,
                                    const Evaluation& assembled);

}  // namespace engine
