// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "validation/findings.h"

namespace validation {

/// The drives have their laws' features, differentiate to each other, and jump in their accelerations alone,
/// where the law says so.
[[nodiscard]] Findings compute_drive_laws();
/// The slider of the ideal rigid linkage moves as the closed form says, peaks included.
[[nodiscard]] Findings compute_closed_form();
/// With the rod locked the linkage is a slider-crank, planar or spatial.
[[nodiscard]] Findings compute_slider_crank();
/// Reactions, drive forces and energies are those of Newton's and Euler's laws for the closed form.
[[nodiscard]] Findings compute_reactions();
/// Integrated constraints open by no more than the errors of the steps add up to.
[[nodiscard]] Findings compute_constraint_drift();
/// The same bounds hold over the study's 5 s.
[[nodiscard]] Findings compute_long_constraint_drift();
/// A violated joint closes as the stabilisation's equation says.
[[nodiscard]] Findings compute_violation_decay();
/// Drives by multipliers tend to prescribed ones with the step and with the tolerance.
[[nodiscard]] Findings compute_drive_enforcement();

}  // namespace validation
