// SPDX-License-Identifier: Apache-2.0
#include "validation/chapters.h"
#include "validation/kinematics/parts.h"

namespace validation {

Chapter kinematics_chapter() {
  return {
      .name = "kinematics",
      .title = "Kinematics, reactions and constraints",
      .text = R"(Without clearance and with a rigid coupler, the two drives alone decide the motion: the
coupler's end lies on the guide. The reference is this closed form. Its exact derivatives (Taylor polynomials
of degree 6) are the poses, velocities and accelerations of all links. Newton's and Euler's laws, link after
link, then give the reactions of the joint, the torque of the crank and the force of the rod. The reference
uses no part of the engine.

In the paper's geometry the cross link turns about the slider's guide, gravity acts along the crank's axis,
and the rod follows its cosine law. The acceleration of this law jumps where a rise begins and where a return
ends; a sample at a jump belongs to the time before. In the second geometry (chapter Other codes) the cross
link turns across the guide, gravity acts across the crank's axis, and the rod follows the cycloidal law.
`rk4` does not end its steps at jumps, so its cases have the cycloidal law.

Integrated constraints (multipliers with Baumgarte's stabilisation, alpha = beta = 100 1/s) drift a little.
The bound of the drift is known beforehand. Let gamma be the acceleration with which the constraints would
open at constant rates. A step h of `rk4` leaves eps_q = alpha beta^2 gamma h^5 / 48 in Phi and
eps_v = (alpha^2 beta^2 / 24 - beta^4 / 96) gamma h^5 in its rate, and rounding adds to both. The
stabilisation keeps at most (2 alpha eps_q + eps_v) / (h beta^2) of all steps' errors in Phi, and
(eps_q + 2 eps_v / (exp(1) alpha)) / h in its rate. At 0.1 ms both parts are about 1e-12 m. At 0.01 ms only
rounding is left, and shorter steps leave more of it. With the flexible coupler the steps of `rk4` are 0.05 ms
at most.)",
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
