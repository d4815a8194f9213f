// SPDX-License-Identifier: Apache-2.0
#include "validation/chapters.h"
#include "validation/clearances/parts.h"

namespace validation {

Chapter clearances_chapter() {
  return {
      .name = "clearances",
      .title = "Clearance in joints of every kind",
      .text = R"(A ball in a socket, a block in a slot and a piston in a cylinder are held by the contact of
their surfaces alone. Each has closed forms: speeds after impacts, the angular momentum of a ball without
friction, the pendulum of a ball that slides or rolls, the moment that two edges bear, the acceleration on an
incline. A ball that rolls in a horizontal circle passes the poles of the coordinates in which its bristle is
stored. A slider-crank with clearance in its pin moves alike, whether its loop is cut at that pin or at another
joint. With play in the guide of its slider it moves as Siconos publishes for the model of Flores, Leine and
Glocker. The energy account holds with clearance in two revolute joints, a spherical and a prismatic one.)",
      .parts = {{"ball_hits_its_socket", compute_ball_impacts},
                {"ball_is_a_pendulum", compute_ball_pendulum},
                {"block_bounces_between_walls", compute_block_impacts},
                {"tilted_bodies_bear_a_moment", compute_tilted_bodies},
                {"bodies_slide_along_their_joint", compute_sliding_bodies},
                {"loop_may_be_cut_elsewhere", compute_cut_elsewhere},
                {"slider_crank_is_as_published", compute_published_slider_crank},
                {"four_clearances_keep_the_energy", compute_four_clearances}}};
}

}  // namespace validation
