// SPDX-License-Identifier: Apache-2.0
#include "validation/chapters.h"
#include "validation/integrators/parts.h"

namespace validation {

Chapter integrators_chapter() {
  return {.name = "integrators",
          .title = "Integrators",
          .text = R"(`rk4` is the paper's classical Runge-Kutta method of order 4 in equal steps. `dopri5` is
the method of Dormand and Prince of order 5 with error control. Two implicit methods have error control as
well: `radau5`, the default (Radau IIA of order 5), and `rodas5` (a Rosenbrock method of order 5). The steps of
all but `rk4` end where a ring of the journal meets or leaves the bore, and where the rod's acceleration jumps.

- In smooth motion `rk4` and `dopri5` have the order that their names promise. One reference is a pendulum
  (elliptic functions), the other the closed form of the ideal linkage's crank, rod and slider (with
  constraints, multipliers and drives; the rod follows the cycloidal law).
- A mass that flies across the clearance meets the bore at gap / speed and leaves it after the time of
  Hertz's law. `dopri5` ends its steps within 1e-10 m of both instants. `rk4` meets them inside a step, which
  limits it in joints with clearance.
- Where a case converges, all methods give the same peak at the same instant. The comparison uses the second
  geometry, which other codes ran as well; its rod follows the cycloidal law, so that `rk4` meets no jumps.
  Flexible cases of the second geometry above 5 rad/s converge with no method: their peaks are samples,
  reported as distributions. A table of its own compares `dopri5` and the default on the paper's geometry.

Cost is counted in evaluations of the equations of motion, the same on every machine; run time is
proportional to it. The linear systems of `radau5` cost about half as much again; the Jacobian of `rodas5`,
new at each step, about as much again. The default tolerance is chosen such that nearly all
converging cases have their peaks within a thousandth. For this, the default divides the given tolerances in
joints with clearance:

| case | divisor |
|---|---|
| the paper's friction | 2 |
| worn bores | 7.5 |
| stiffer bristles, or no friction | 30 |
| stiffer bristles or no friction, contact elements | 7.5 |

With friction without bristles (Coulomb's, Ambrosio's) the tolerances are at most 1e-9, and `dopri5` is the
default between rigid links. Such friction reverses within micrometres per second, and later impacts amplify
each error made there.

The case without friction (second geometry, 0.1 mm) shows the need: little damps the journal on its bore, so
that the error of one step is left seconds later, when the journal leaves the bore, and shows in the peak.
`radau5` damps vibrations of which a step holds several periods. Two kinds of vibration limit its steps:

- Stiff bristles, and forces that jump with the velocity, excite the journal on its bore. These vibrations
  count although they decay: the steps are 0.1 ms at most.
- Friction feeds fast vibrations of flexible links until the joint bounds them. Their size depends on the
  disturbances they grow from; their presence does not. With flexible links and clearance the steps are
  0.4 ms at most, which damps these vibrations little.

Section `work_and_precision` compares cost and error. `dopri5` at 1e-6, with 1e-7 absolute, is the loosest
decade at which both of its cases are right to five digits. At 10 rad/s, where hard impacts make the peak,
`rk4` needs more work for a worse peak: the `note` of the table gives the ratios. At 5 rad/s, where the
journal stays on the bore, `rk4` is as good for its work. `rk4` cannot tell that its step is too long. A
tighter tolerance costs more and changes nothing in the paper's sweep.)",
          .parts = {{"order_on_a_pendulum", compute_order_on_a_pendulum},
                    {"order_on_the_ideal_linkage", compute_order_on_the_linkage},
                    {"instants_of_contact", compute_contact_instants},
                    {"peaks_by_two_methods_rigid_025_mm", compute_peaks_narrow, Cost::kHeavy},
                    {"peaks_by_two_methods_rigid_05_mm", compute_peaks_wide, Cost::kHeavy},
                    {"peaks_by_two_methods_flexible", compute_peaks_flexible, Cost::kHeavy},
                    {"peaks_of_other_contacts", compute_peaks_of_other_contacts, Cost::kHeavy},
                    {"peaks_of_the_study", compute_peaks_of_the_study, Cost::kHeavy},
                    {"work_and_precision", compute_work_and_precision, Cost::kHeavy}}};
}

}  // namespace validation
