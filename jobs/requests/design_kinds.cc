// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/design_kinds.h"

#include <array>

#include "jobs/requests/listed_designs.h"
#include "jobs/requests/sampled_designs.h"

namespace jobs {

std::span<const DesignKind> design_kinds() {
  static const std::array<DesignKind, 6> kinds{{
      {"latin_hypercube",
       "count points; each of count equal parts of every range has one, at a random place",
       {"count", "seed"},
       count_samples,
       make_latin_hypercube},
      {"sobol",
       "the first count points of Sobol's sequence, shifted at random if there is a seed; a power of two "
       "fills the space best",
       {"count", "seed"},
       count_samples,
       make_sobol},
      {"zip", "the first values of all lists, then the second ones, and so on", {}, count_zip, make_zip},
      {"one_at_a_time",
       "the centre, then each parameter alone with each of its values",
       {"centre"},
       count_one_at_a_time,
       make_one_at_a_time},
      {"morris",
       "trajectories along which one parameter after the other is changed: elementary effects, for few runs",
       {"trajectories", "levels", "seed"},
       count_morris,
       make_morris},
      {"saltelli",
       "count blocks of two points and, for each parameter, of their mixture: Sobol's indices, for many runs",
       {"count", "seed"},
       count_saltelli,
       make_saltelli},
  }};
  return kinds;
}

}  // namespace jobs
