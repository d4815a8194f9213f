#pragma once

#include "engine/validation/findings.h"

namespace engine::validation {

[[nodiscard]] Findings compute_tip_deflections();
[[nodiscard]] Findings compute_frequencies_of_three_segments();
[[nodiscard]] Findings compute_frequency_limits();
[[nodiscard]] Findings compute_torsion();
[[nodiscard]] Findings compute_sag_and_decay();
[[nodiscard]] Findings compute_spin_up();

}  // namespace engine::validation
