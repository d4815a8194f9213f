// SPDX-License-Identifier: Apache-2.0
#include "validation/chapters.h"
#include "validation/formulation/parts.h"

namespace validation {

Chapter formulation_chapter() {
  return {.name = "formulation",
          .title = "Equations of motion",
          .text = R"(The engine computes Eqs. (2)-(9), (12) and (13.2) by recursions over the chains. The
Newton-Euler recursion gives h + g and, with unit accelerations, the columns of M. The articulated-body
recursion gives the accelerations. The reference is the paper's own form: products of 4x4 matrices, their
first and second derivatives by each coordinate, pseudo-inertia matrices and traces. The reference builds its
chains a second time from the parameters (lengths, Table 1, E, G, d, n_rfe, zeta), and sums the contact
forces of Eqs. (10) and (11) point by point. A second route needs no reference: by Lagrange's equations,
slopes of the engine's own energies give the same terms.

States are random, with fixed seeds. Angles cover the whole turn, but the second of three angles in a row
stays within 70 degrees, because the three are singular at 90. Slides stay within 0.3 m, rates within
10 rad/s and 2 m/s. The linkage is the paper's with a crank of 0.18 m and the guide at y = 0.03 m,
z = 0.17 m: no two lengths are equal, so an exchange of two lengths shows. Unless a case says otherwise, the
yoke turns about the guide and gravity acts along -z, the crank's axis.)",
          .parts = {{"mass_coriolis_gravity_and_springs_equal_the_trace_form", compute_trace_form},
                    {"slopes_of_the_energies_give_the_same_terms", compute_energy_differences},
                    {"contact_forces_do_the_work_of_their_points", compute_virtual_work}}};
}

}  // namespace validation
