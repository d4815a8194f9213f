// SPDX-License-Identifier: Apache-2.0
#include "validation/chapters.h"
#include "validation/formulation/parts.h"

namespace validation {

Chapter formulation_chapter() {
  return {.title = "Equations of motion",
          .text =
              "The engine computes Eqs. (2)-(9), (12) and (13.2) with recursions over the chains: Newton and Euler's for h + g (and, by unit "
              "accelerations, the columns of M), articulated bodies for the accelerations. The reference is the paper's own form: products of 4x4 matrices, their first and second derivatives by each "
              "coordinate, pseudo-inertia matrices and traces, for chains that are built a second time from the parameters (lengths, Table "
              "1, E, G, d, n_rfe, zeta), and contact forces of Eqs. (10) and (11) point by point.\n"
              "\n"
              "Angles are drawn from the whole turn (the second of three angles in a row only to 70 degrees, since at 90 the three are "
              "singular), slides from 0.3 m, rates from 10 rad/s and 2 m/s, with fixed seeds. The linkage is that of the study, but with a "
              "crank of 0.18 m and the guide at y = 0.03 m, z = 0.17 m, so that no two lengths can be exchanged unseen. The yoke turns about "
              "the guide and gravity acts along -z, the crank's axis, but for the cases that say otherwise. A second route needs no reference "
              "at all: slopes of the engine's own energies must give the same terms, for Lagrange's equations say so.",
          .parts = {{"mass_coriolis_gravity_and_springs_equal_the_trace_form", compute_trace_form},
                    {"slopes_of_the_energies_give_the_same_terms", compute_energy_differences},
                    {"contact_forces_do_the_work_of_their_points", compute_virtual_work}}};
}

}  // namespace validation
