// SPDX-License-Identifier: Apache-2.0
#include "validation/chapters.h"
#include "validation/kinematics/parts.h"

namespace validation {

Chapter kinematics_chapter() {
  return {.title = "Kinematics, reactions and constraints",
          .text =
              "Without clearance and with a rigid coupler the two drives alone decide the motion: the coupler's end lies on the guide. From "
              "that closed form follow, with exact derivatives (arithmetic of Taylor polynomials of degree 6), poses, velocities and "
              "accelerations of all links, and with Newton's and Euler's laws link after link the joint's reactions, the crank's torque and "
              "the rod's force. None of it uses the engine.\n"
              "\n"
              "In the study's geometry the cross link turns about the slider's guide, gravity acts along the crank's axis, and the rod moves by its "
              "cosine law, whose acceleration jumps where a rise begins and a return ends. A sample at a jump is from before it. The second geometry, "
              "which other codes were run with (their chapter tells it in full), has the cross link across the guide, gravity across the crank's "
              "axis, and a rod with the cycloidal law. `rk4` does not end its steps at jumps: its cases have the cycloidal law.\n"
              "\n"
              "Where constraints are integrated, with multipliers and Baumgarte's stabilisation (alpha = beta = 100 1/s), the loop opens a "
              "little. By how much can be said beforehand: if the constraints would open with the acceleration gamma at constant rates, a "
              "step h of rk4 leaves e_q = alpha beta^2 gamma h^5 / 48 in Phi and e_v = (alpha^2 beta^2 / 24 - beta^4 / 96) gamma h^5 in its "
              "rate, and rounding adds to both; the stabilisation keeps of all steps' errors at most (2 alpha e_q + e_v) / (h beta^2) and "
              "(e_q + 2 e_v / (e alpha)) / h. At 0.1 ms both parts are about 1e-12 m; at 0.01 ms only rounding is left, more of it the "
              "smaller the step. With the flexible coupler rk4 runs with 0.05 ms and less.",
          .parts = {{"drive_laws_have_their_features", compute_drive_laws},
                    {"slider_follows_the_closed_form", compute_closed_form},
                    {"locked_rod_is_a_slider_crank", compute_slider_crank},
                    {"reactions_and_drive_forces_equal_inverse_dynamics", compute_reactions},
                    {"constraint_drift_is_bounded", compute_constraint_drift},
                    {"constraint_drift_of_whole_runs_is_bounded", compute_long_constraint_drift, Cost::kHeavy},
                    {"violations_decay_as_baumgarte_says", compute_violation_decay},
                    {"baumgarte_drives_tend_to_prescribed_ones", compute_drive_enforcement}}};
}

}  // namespace validation
