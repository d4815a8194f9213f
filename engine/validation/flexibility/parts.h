#pragma once

#include "engine/validation/findings.h"

namespace engine::validation {

/// The clamped coupler bends and twists under a load at its tip as springs at their places do.
[[nodiscard]] Findings compute_tip_deflections();
/// Three segments have the frequencies of two other computations.
[[nodiscard]] Findings compute_frequencies_of_three_segments();
/// Frequencies in bending tend to those of the undivided rod, in the right order.
[[nodiscard]] Findings compute_frequency_limits();
/// Frequencies in torsion are those of a chain of discs and tend to the rod's.
[[nodiscard]] Findings compute_torsion();
/// In the linkage at rest the coupler has its static sag, its frequency and its damping ratio.
[[nodiscard]] Findings compute_sag_and_decay();
/// A long beam spun up lags by the values of an independent computation.
[[nodiscard]] Findings compute_spin_up();

}  // namespace engine::validation
