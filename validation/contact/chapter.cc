// SPDX-License-Identifier: Apache-2.0
#include "validation/chapters.h"
#include "validation/contact/parts.h"

namespace validation {

Chapter contact_chapter() {
  return {.name = "contact",
          .title = "Contact",
          .text = R"(The normal law acts in single impacts of a free mass, computed by the engine's own
integration with its location of contacts and its latches. The ring of elements is compared with its
integral. Tilted and shifted journals at rest are compared with statics. A ring of elements is not the closed
form with other numbers: each element has the damping of its own onset and a bristle of its own. The sections
`elements_damp_each_from_its_own_onset`, `elements_bend_each_its_own_bristle` and `whole_runs_with_elements`
show the effect. Section `the_study_with_other_laws` runs the sweep with each contact law and each friction
law.)",
          .parts = {{"hertz_stiffness_of_the_bore", compute_hertz_stiffness},
                    {"rebounds_obey_the_closed_form", compute_rebounds},
                    {"elastic_impacts_have_hertzs_depth_and_time", compute_elastic_impacts},
                    {"ring_of_elements_tends_to_its_integral", compute_ring_of_elements},
                    {"tilted_journal_obeys_statics", compute_tilted_journal},
                    {"axial_faces_obey_statics", compute_axial_faces},
                    {"elements_damp_each_from_its_own_onset", compute_impacts_of_a_ring},
                    {"elements_bend_each_its_own_bristle", compute_turning_journal},
                    {"whole_runs_with_elements", compute_whole_runs_with_elements, Cost::kHeavy},
                    {"the_study_with_other_laws", compare_laws, Cost::kHeavy}}};
}

}  // namespace validation
