// SPDX-License-Identifier: Apache-2.0
#include "validation/chapters.h"
#include "validation/integrators/parts.h"

namespace validation {

namespace {

constexpr const char* kIntegratorsText =
    R"(Four integrators: `rk4`, the paper's classical Runge-Kutta method of order 4 in equal steps; `dopri5`, Dormand and Prince's method of order 5
with error control; and two implicit ones with error control, `radau5` (Radau IIA of order 5) and `rodas5` (a Rosenbrock method of order 5).
The default is `radau5`. The steps of all but `rk4` end where a ring of the journal meets or leaves the bore, and where the rod's
acceleration jumps.

- Where the motion is smooth `rk4` and `dopri5` have the order that their names promise: on a pendulum against elliptic functions, on the ideal linkage
  (constraints, multipliers, drives; the rod by the cycloidal law) against the closed form of its crank, rod and slider.
- A mass that flies across the clearance meets the bore at gap / speed and leaves it after the time that Hertz's law gives. `dopri5` ends
  its steps within 1e-10 m of both; `rk4` comes upon them within a step, which is what limits it in a joint with clearance.
- Where a case converges, all give the same peak at the same instant. They are compared on the second geometry of the linkage, with which
  other codes were run too: its rod moves by the cycloidal law, so that `rk4` meets no jumps. Its flexible cases above 5 rad/s do not
  converge with any method: their peaks are samples, and reported as distributions. The study's geometry has a table of its own, of
  `dopri5` and the default.

Cost is counted in evaluations of the equations of motion: the same on every machine. Run time is proportional to it; what `radau5` solves
beside them costs about half as much again, and the Jacobian that `rodas5` makes at each step about as much again. The default
tolerance is chosen so that nearly all cases that converge have their peaks within a thousandth: in a joint with clearance the default divides the
tolerances that are asked for by 2, in worn bores by 7.5; where friction is other than the study's (stiffer bristles, other laws, or none) by 30, of
contact elements by 7.5. The case without friction, second geometry, 0.1 mm, shows what that is good for. Little damps the journal on its bore there:
what the error of one step sets off is left seconds later, when the journal leaves the bore, and shows in the peak.
`radau5` damps vibrations of which a step holds several periods. Stiff bristles, and a force that jumps with
the velocity, set off those of the journal on its bore, which count though they decay: there its steps are 0.1 ms at most.
Friction also feeds fast vibrations of flexible links, until the joint bounds them. Their size hangs on what they grow from; that they are
there does not: steps of `radau5` with flexible links and clearance are 0.4 ms at most, which damps them little.
`dopri5` at 1e-6, with 1e-7 absolute, is at the loosest of the decades at which both cases of the last table are
right to five digits.
At 10 rad/s, where hard impacts make the peak, `rk4` takes more work for less: the caption of that table gives the ratios. At 5 rad/s,
where the journal stays on the bore, it is as good for its work. It has no way to say that its step is too long. A tighter tolerance
costs more and changes nothing that the study looks at.)";

}  // namespace

Chapter integrators_chapter() {
  return {.title = "Integrators",
          .text = kIntegratorsText,
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
