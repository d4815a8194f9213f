// SPDX-License-Identifier: Apache-2.0
#include "validation/chapters.h"

namespace validation {

std::vector<Chapter> engine_chapters() {
  return {formulation_chapter(), kinematics_chapter(), contact_chapter(), clearances_chapter(),
          flexibility_chapter(), friction_chapter(),   actuators_chapter(), energy_chapter(),
          integrators_chapter(), other_codes_chapter()};
}

}  // namespace validation
