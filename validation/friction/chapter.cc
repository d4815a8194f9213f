// SPDX-License-Identifier: Apache-2.0
#include "validation/chapters.h"
#include "validation/friction/parts.h"

namespace validation {

namespace {

constexpr const char* kFrictionText =
    R"(LuGre's law in the experiments of the article that introduced it: C. Canudas de Wit, H. Olsson, K. J. Åström, P. Lischinsky,
"A New Model for Control of Systems with Friction", IEEE Transactions on Automatic Control 40(3), 1995, with its values
(F_s = 1.5 N, F_c = 1 N, sigma_0 = 1e5 N/m, sigma_1 = sqrt(1e5) N s/m, sigma_2 = 0.4 N s/m, v_s = 1e-3 m/s; the engine's mu_s, mu_k with a
normal force of 1 N). The article shows its results as curves. The digits here are closed forms, or those of small programs that were
written for one experiment each and share nothing with the engine. Stick-slip runs as a mechanism with a clearance joint: contact, friction,
equations of motion and integrator together; so do the contacts that begin with unbent bristles, and the linkage itself for its sliding
speeds. In the other experiments the engine's law is integrated alone, along a line askew to its two directions.
The break-away force is the largest friction force before it falls for the first time.

**What the law does with energy.** With a constant normal force, the power of friction less the growth of the bristle's energy
sigma_0 z^2 / 2 is a quadratic form in z: (sigma_1 + sigma_2) v^2 - (sigma_0 |v| / g) sigma_1 z v + (sigma_0^2 |v| / g) z^2. It has no negative
value as long as sigma_1^2 |v| <= 4 g (sigma_1 + sigma_2): with the defaults, up to |v| = 0.16 m/s. At higher speeds a bristle that is bent
beyond g / sigma_0 in the direction of sliding could give back more than it holds. With a constant normal force none is ever bent so far
(|z| <= mu_k / sigma_0 is never left, since mu_s <= mu_k), and the law takes energy at any speed. In a run the normal force changes, so the
table below says how fast runs slide. For a user it means:

- `friction_work_j` is the work of the friction force; what bristles hold for the moment is in it. It can fall for an instant, when they
  spring back: the table's last column says by how much of the whole. The energy account stays closed, since nothing but that work is counted.
- A bristle that has just come into contact resists with sigma_1 |v|, more than mu_k from 0.04 m/s on. In hard impacts friction can
  therefore be more than mu_k times the normal force: the table gives the largest.)";

}  // namespace

Chapter friction_chapter() {
  return {.title = "Friction",
          .text = kFrictionText,
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
