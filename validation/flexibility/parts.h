// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "validation/findings.h"

namespace validation {

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
/// Crank, rod and cross link, clamped, have the first frequency of a beam in the limit.
[[nodiscard]] Findings compute_link_frequencies();
/// In the linkage at rest crank and rod sag as beams do.
[[nodiscard]] Findings compute_link_sags();
/// Made stiff, crank, rod and cross link move the linkage as rigid ones.
[[nodiscard]] Findings compute_stiff_links();
/// A block between a spring and a damper has its closed form, by all methods.
[[nodiscard]] Findings compute_block_on_a_spring();
/// A pendulum tied by a spring moves as the equation of its angle says.
[[nodiscard]] Findings compute_tied_pendulum();
/// A thrown body slows by its drag as the closed form says.
[[nodiscard]] Findings compute_thrown_body();

}  // namespace validation
