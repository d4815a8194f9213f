// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "engine/dynamics/loop_closure.h"
#include "engine/integrate/observer.h"
#include "engine/integrate/run_outcome.h"
#include "engine/model/run_options.h"

namespace engine {

/// @returns whether a mechanism may be run by run_kinematics() if its drives determine the motion: joints are
/// ideal, driven coordinates are substituted, and no fixed step is asked for
[[nodiscard]] bool allows_kinematics(const Mechanism& mechanism, Integrator integrator);

/// The place of a change point, for the user: the instant and the driven coordinates.
[[nodiscard]] std::string describe_change_point(const Mechanism& mechanism, const Evaluation& at);

/// Runs a mechanism whose motion the drives determine alone: positions, velocities, accelerations and forces
/// are solved for at each instant; nothing is integrated.
///
/// The instants come in blocks of four equal steps, as long as drives and mechanism allow; no block crosses a
/// corner of a drive's law. Samples at other instants are solved as well. The interpolant of a quantity in a
/// block is the quartic through its five values. The work of a drive is the integral of its power's
/// interpolant (Boole's rule at the block's end).
///
/// A step is split where an interpolant has an extremum: of the acceleration of an unknown coordinate, of a
/// drive's force, of the magnitude of a reaction that closes a loop. Other loads are evaluated in the middle
/// of a step that may hide a larger value. Far from change points, extrema of forces and reactions are
/// ends of steps. The extremum of an acceleration lies inside a short step: the quadratic by which observers
/// read steps finds the extremum and its instant.
///
/// Change points, where two branches of the motion cross, are passed on the smooth branch: the step may be
/// any length in which the motion continues as predicted. In the change point itself constraints do not
/// determine the motion, but shortly before and after they do. A linkage that comes to rest there ends as
/// kSingular.
[[nodiscard]] RunOutcome run_kinematics(const Mechanism& mechanism, LoopClosure& closure,
                                        const RunOptions& options, Observer& observer,
                                        const Evaluation& assembled);

}  // namespace engine
