// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/dynamics/loop_closure.h"
#include "engine/integrate/observer.h"
#include "engine/integrate/run_end.h"
#include "engine/model/run_options.h"

namespace engine {

/// Runs a mechanism whose motion the drives decide alone: positions, velocities, accelerations and forces at each instant, no integration.
///
/// The instants come in panels of four equal steps, as long as drives and mechanism allow and no panel across a corner of a drive's law;
/// samples at other instants are solved besides. Each quantity in a panel is the quartic through its values: the drives' work is the integral
/// of their power's (Boole's rule at the panel's end). Where the quartic of an unknown coordinate's acceleration, of a drive's force or of a
/// reaction's magnitude turns, the step is divided, so that the extremes of all of them are ends of steps; an acceleration gets a short step
/// there, so that the quadratic by which observers read steps finds its extreme and when it was.
[[nodiscard]] RunEnd run_kinematics(const Mechanism& mechanism, LoopClosure& closure, const RunOptions& options, Observer& observer,
                                    const Evaluation& assembled);

}  // namespace engine
