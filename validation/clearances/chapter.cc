// SPDX-License-Identifier: Apache-2.0
#include "validation/chapters.h"
#include "validation/clearances/parts.h"

namespace validation {

Chapter clearances_chapter() {
  return {
      .name = "clearances",
      .title = "Clearance in joints of every kind",
      .text = R"(Surfaces alone hold a ball, a block or a piston in its joint. Impacts, pendulums and tilts have
closed forms. A slider-crank moves alike wherever its loop is cut. With play in its guide it moves as
Siconos publishes, as does a four-bar with play in three joints.)",
      .parts = {{"ball_hits_its_socket", compute_ball_impacts},
                {"ball_is_a_pendulum", compute_ball_pendulum},
                {"block_bounces_between_walls", compute_block_impacts},
                {"tilted_bodies_bear_a_moment", compute_tilted_bodies},
                {"bodies_slide_along_their_joint", compute_sliding_bodies},
                {"loop_may_be_cut_elsewhere", compute_cut_elsewhere},
                {"slider_crank_is_as_published", compute_published_slider_crank},
                {"four_bar_is_as_published", compute_published_four_bar},
                {"four_clearances_keep_the_energy", compute_four_clearances}}};
}

}  // namespace validation
