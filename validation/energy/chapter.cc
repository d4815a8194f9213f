// SPDX-License-Identifier: Apache-2.0
#include "validation/chapters.h"
#include "validation/energy/parts.h"

namespace validation {

namespace {

constexpr const char* kText =
    R"(The account: kinetic and potential energy (gravity, the coupler's springs, the elastic part of the contact), less the work of the drives,
plus what impacts, friction and the coupler's dampers have taken, is constant. Work and losses are integrated beside the motion, each from
its own force; error control does not look at them. What the account fails to close by is the metric `energy_residual`, over the work turned
over, so it is a second opinion on every run.

Orders over the step are those of smooth drives: the ideal linkage's rod moves by the cycloidal law there, and the case with clearance is the second
geometry's.

How fast it falls with the step says whether force, motion and account belong together. With an ideal joint it has the order of the method,
4 and 5. With clearance the force sets in as the penetration to the power 1.5: its higher derivatives jump there, and a step that contains
the onset has not the method's order. `dopri5` ends its steps there and keeps order 5; `rk4` does not, and keeps 2.5 of an onset on the
bore, where the energy goes wrong as force times displacement, and 2 of one on a face, whose force is linear.

The three losses are told apart by turning their causes off, by closed forms, and by integrals over samples of force and motion.)";

}  // namespace

Chapter energy_chapter() {
  return {.title = "Energy",
          .text = kText,
          .parts = {{"orders_of_the_energy_residual", compute_residual_orders},
                    {"orders_of_an_onset_inside_a_step", compute_onset_orders},
                    {"each_loss_has_its_cause", compute_causes_of_loss},
                    {"losses_in_closed_form", compute_closed_form_losses},
                    {"losses_from_samples", compute_sampled_losses},
                    {"the_whole_energy_account", compute_whole_account}}};
}

}  // namespace validation
