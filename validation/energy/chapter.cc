// SPDX-License-Identifier: Apache-2.0
#include "validation/chapters.h"
#include "validation/energy/parts.h"

namespace validation {

Chapter energy_chapter() {
  return {.name = "energy",
          .title = "Energy",
          .text = R"(The energy account is constant: kinetic and potential energy (gravity, springs of the
coupler, elastic part of the contact), less the work of the drives, plus the losses to impacts, friction and
the coupler's dampers. Work and losses are integrated beside the motion, each from its own force; error
control does not see them. The metric `energy_residual` is the error of the account over the work turned
over: a second opinion on every run.

The order of the residual over the step shows whether force, motion and account belong together. With an
ideal joint the order is that of the method, 4 or 5. With clearance the force begins as the penetration to
the power 1.5: its higher derivatives jump at the onset, and a step across the onset does not have the order
of the method. `dopri5` ends its steps at the onset and keeps order 5. `rk4` does not: it keeps 2.5 of an
onset on the bore, where the energy errs as force times displacement, and 2 of an onset on a face, whose
force is linear. Orders are measured with smooth drives: the ideal linkage's rod follows the cycloidal law,
and the case with clearance has the second geometry.

Three routes tell the losses apart: removal of their causes, closed forms, and integrals over samples of
force and motion.)",
          .parts = {{"orders_of_the_energy_residual", compute_residual_orders},
                    {"orders_of_an_onset_inside_a_step", compute_onset_orders},
                    {"each_loss_has_its_cause", compute_causes_of_loss},
                    {"losses_in_closed_form", compute_closed_form_losses},
                    {"losses_from_samples", compute_sampled_losses},
                    {"the_whole_energy_account", compute_whole_account}}};
}

}  // namespace validation
