// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/dynamics/loop_closure.h"
#include "engine/integrate/observer.h"
#include "engine/integrate/run_outcome.h"
#include "engine/model/run_options.h"

namespace engine {

/// Runs a mechanism whose motion the drives determine alone: positions, velocities, accelerations and forces
/// are solved for at each instant; nothing is integrated.
///
/// The instants come in blocks of four equal steps, as long as drives and mechanism allow; no block crosses a
/// corner of a drive's law. Samples at other instants are solved as well. The interpolant of a quantity in a
/// block is the quartic through its five values. The work of a drive is the integral of its power's
/// interpolant (Boole's rule at the block's end).
///
/// A step is split where an interpolant has an extremum: of the acceleration of an unknown coordinate, of a
/// drive's force, of a reaction's magnitude. So the extrema of all of them are ends of steps. An acceleration
/// gets a short step around its extremum, so that the quadratic by which observers read steps finds the
/// extremum and its instant.
[[nodiscard]] RunOutcome run_kinematics(const Mechanism& mechanism, LoopClosure& closure,
                                    const RunOptions& options, Observer& observer,
                                    const Evaluation& assembled);

}  // namespace engine
