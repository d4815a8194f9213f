// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "validation/findings.h"

namespace validation {

// Each in the chapter.cc of its folder.
[[nodiscard]] Chapter formulation_chapter();
[[nodiscard]] Chapter kinematics_chapter();
[[nodiscard]] Chapter energy_chapter();
[[nodiscard]] Chapter contact_chapter();
[[nodiscard]] Chapter flexibility_chapter();
[[nodiscard]] Chapter friction_chapter();
[[nodiscard]] Chapter actuators_chapter();
[[nodiscard]] Chapter clearances_chapter();
[[nodiscard]] Chapter integrators_chapter();
[[nodiscard]] Chapter other_codes_chapter();

/// All that the engine alone can show, in the report's order.
[[nodiscard]] std::vector<Chapter> engine_chapters();

}  // namespace validation
