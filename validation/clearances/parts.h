// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "validation/findings.h"

namespace validation {

/// A ball hits its socket from the middle, to and fro, and slides around it without friction.
[[nodiscard]] Findings compute_ball_impacts();
/// A ball slides or rolls in its socket as a pendulum does.
[[nodiscard]] Findings compute_ball_pendulum();
/// A block bounces between the walls of its slot.
[[nodiscard]] Findings compute_block_impacts();
/// A tilted block or journal bears a moment by two of its edges or rings.
[[nodiscard]] Findings compute_tilted_bodies();
/// A block slides down its slot with friction, a piston falls in its cylinder without.
[[nodiscard]] Findings compute_sliding_bodies();
/// It makes no difference which joint of a loop is cut.
[[nodiscard]] Findings compute_cut_elsewhere();
/// A slider-crank whose slider has play in its guide, against published results.
[[nodiscard]] Findings compute_published_slider_crank();
/// A four-bar with play in three joints, against published results.
[[nodiscard]] Findings compute_published_four_bar();
/// The energy account of a linkage of four joints with clearance.
[[nodiscard]] Findings compute_four_clearances();

}  // namespace validation
