// SPDX-License-Identifier: Apache-2.0
#include "validation/actuators/parts.h"
#include "validation/chapters.h"

namespace validation {

Chapter actuators_chapter() {
  return {.name = "actuators",
          .title = "Actuators, loads and friction in joints",
          .text = R"(A flywheel and a block are moved by what moves a freedom of a linkage: torques and forces by laws over
time, speed and position, controllers, motors with gear and friction, dry friction in the joint under a
given force or what the joint bears, loads on the body, a ground that accelerates. Each has a closed form
or a published result. The energy account of a motor has the electric work of its supply on one side. On
the other stand the energies of bodies, rotor and winding, and the losses in resistance, friction and
gear. At last a controller moves the crank of the paper's linkage, without clearance: the stiffer it is,
the nearer the peak of the slider's acceleration is to that of the prescribed motion.)",
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
