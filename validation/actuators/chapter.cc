// SPDX-License-Identifier: Apache-2.0
#include "validation/actuators/parts.h"
#include "validation/chapters.h"

namespace validation {

Chapter actuators_chapter() {
  return {.name = "actuators",
          .title = "Actuators, loads and friction in joints",
          .text = R"(Forces and torques by laws, controllers, motors, loads and an accelerated ground move a flywheel and a
block, dry friction slows them. Each has a closed form or a published result. At last a controller moves
the crank of the paper's linkage, without clearance: the stiffer it is, the nearer the peak is to the
prescribed one.)",
          .parts = {{"motor_starts_as_its_exponentials", compute_motor_start},
                    {"stalled_motor_draws_its_current", compute_stalled_motor},
                    {"gear_passes_on_its_efficiency", compute_gear},
                    {"force_laws_have_their_closed_forms", compute_force_laws},
                    {"controllers_do_as_their_gains_say", compute_controllers},
                    {"joints_rub_by_the_laws_of_friction", compute_joint_friction},
                    {"joints_rub_by_what_they_bear", compute_reaction_friction},
                    {"bodies_bear_loads_and_a_shaken_ground", compute_body_loads},
                    {"stiff_controller_tends_to_the_prescribed_motion", compute_stiff_controller}}};
}

}  // namespace validation
