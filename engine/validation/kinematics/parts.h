#pragma once

#include "engine/validation/findings.h"

namespace engine::validation {

[[nodiscard]] Findings compute_drive_laws();
[[nodiscard]] Findings compute_closed_form();
[[nodiscard]] Findings compute_slider_crank();
[[nodiscard]] Findings compute_reactions();
[[nodiscard]] Findings compute_constraint_drift();
[[nodiscard]] Findings compute_long_constraint_drift();
[[nodiscard]] Findings compute_violation_decay();
[[nodiscard]] Findings compute_drive_enforcement();

}  // namespace engine::validation
