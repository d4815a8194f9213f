// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "validation/findings.h"

namespace validation {

/// A motor starts from rest as the two exponentials of its circuit and its rotor say.
[[nodiscard]] Findings compute_motor_start();
/// A stalled motor draws the current of its resistance.
[[nodiscard]] Findings compute_stalled_motor();
/// A gear passes on its efficiency, in both directions.
[[nodiscard]] Findings compute_gear();
/// Laws of torque and force, over time, speed and position, have their closed forms.
[[nodiscard]] Findings compute_force_laws();
/// A controller is a spring and a damper; its integral takes away a constant load.
[[nodiscard]] Findings compute_controllers();
/// Dry friction in a joint without play: on an incline, sticking, stick-slip.
[[nodiscard]] Findings compute_joint_friction();
/// Dry friction by the reactions of joints without play: an implicit equation.
[[nodiscard]] Findings compute_reaction_friction();
/// Forces and moments on bodies, and a ground that accelerates.
[[nodiscard]] Findings compute_body_loads();
/// The paper's linkage with a stiff controller on its crank tends to the prescribed motion.
[[nodiscard]] Findings compute_stiff_controller();

}  // namespace validation
