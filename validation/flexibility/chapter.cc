// SPDX-License-Identifier: Apache-2.0
#include "validation/chapters.h"
#include "validation/flexibility/parts.h"

namespace validation {

Chapter flexibility_chapter() {
  return {.name = "flexibility",
          .title = "Flexible links and springs",
          .text = R"(Rigid elements and springs, as the engine builds them, are taken out of the linkage:
deflections, frequencies, and their limits as the division becomes finer. The second geometry at rest
follows: its coupler lies across gravity, sags and swings. A beam is spun up by its hub. The other links that
may be flexible (crank, rod and cross link) are cut out of the linkage, sag in it, and are stiff in it. Last
come springs and dampers between points of two bodies of a described linkage.)",
          .parts = {{"clamped_coupler_bends_like_the_rod", compute_tip_deflections},
                    {"three_segments_have_their_frequencies", compute_frequencies_of_three_segments},
                    {"frequencies_tend_to_those_of_the_rod", compute_frequency_limits},
                    {"torsion_tends_to_that_of_the_rod", compute_torsion},
                    {"coupler_sags_and_its_swing_decays", compute_sag_and_decay},
                    {"beam_spun_up_has_the_known_lag", compute_spin_up},
                    {"clamped_links_have_the_frequencies_of_beams", compute_link_frequencies},
                    {"links_sag_as_beams", compute_link_sags},
                    {"stiff_links_move_as_rigid_ones", compute_stiff_links},
                    {"block_on_a_spring_swings_as_known", compute_block_on_a_spring},
                    {"tied_pendulum_swings_as_known", compute_tied_pendulum},
                    {"drag_slows_a_thrown_body", compute_thrown_body}}};
}

}  // namespace validation
