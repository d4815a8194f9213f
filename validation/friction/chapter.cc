// SPDX-License-Identifier: Apache-2.0
#include "validation/chapters.h"
#include "validation/friction/parts.h"

namespace validation {

Chapter friction_chapter() {
  return {.name = "friction",
          .title = "Friction",
          .text = R"(LuGre's law repeats the experiments of the article that introduced it: C. Canudas de
Wit, H. Olsson, K. J. Åström, P. Lischinsky, "A New Model for Control of Systems with Friction", IEEE
Transactions on Automatic Control 40(3), 1995. The values are the article's: F_s = 1.5 N, F_c = 1 N,
sigma_0 = 1e5 N/m, sigma_1 = sqrt(1e5) N s/m, sigma_2 = 0.4 N s/m, v_s = 1e-3 m/s, as the engine's mu_s and
mu_k with a normal force of 1 N. The article shows its results as curves. The digits of the reference are
closed forms, or results of small programs that were written for one experiment each and share nothing with
the engine. Three sections use contact, friction, equations of motion and integrator together: stick-slip and
the contacts that begin with unbent bristles as mechanisms with a clearance joint, and the sliding speeds as
the linkage itself. The other experiments integrate the engine's law alone, along a line askew to its two
directions. The break-away force is the largest friction force before its first fall.

**Energy of the law.** Let the normal force be constant. The power of friction, less the growth of the
bristle's energy sigma_0 z^2 / 2, is a quadratic form in z:
(sigma_1 + sigma_2) v^2 - (sigma_0 |v| / g) sigma_1 z v + (sigma_0^2 |v| / g) z^2. The form has no negative
value while sigma_1^2 |v| <= 4 g (sigma_1 + sigma_2): with the defaults, up to |v| = 0.16 m/s. At higher
speeds a bristle that is bent beyond g / sigma_0 in the direction of sliding could return more energy than it
holds. No bristle is ever bent so far: |z| <= mu_k / sigma_0 always, because mu_s <= mu_k. So the law takes
energy at any speed. In a run the normal force changes; the table of section `sliding_speeds_of_runs` gives
the speeds at which runs slide. Users see two consequences:

- `friction_work_j` is the work of the friction force, with the energy that the bristles hold at the moment.
  It can fall for an instant, when bristles spring back: "energy returned" in the table gives the share. The
  energy account stays closed, because it counts this work alone.
- A bristle that has just come into contact resists with sigma_1 |v|, which exceeds mu_k from 0.04 m/s on. So
  friction in hard impacts can exceed mu_k times the normal force: the table gives the largest ratio.)",
          .parts = {{"stick_slip", compute_stick_slip},
                    {"break_away_force", compute_break_away},
                    {"pre_sliding_displacement", compute_pre_sliding},
                    {"frictional_lag", compute_frictional_lag},
                    {"steady_and_beginning_sliding", compute_sliding},
                    {"every_contact_begins_with_unbent_bristles", compute_fresh_bristles},
                    {"dissipation_of_bristles", compute_dissipation},
                    {"sliding_speeds_of_runs", compute_sliding_speeds}}};
}

}  // namespace validation
