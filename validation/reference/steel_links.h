// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "engine/model/links.h"
#include "validation/engine_names.h"

namespace validation {

/// The linkage's links as exact solids of steel, 7800 kg/m^3: crank a tube 28/20 mm, rod 20 mm, coupler 10
/// mm, slider a box 20 x 100 x 50 mm, cross link a tube 20/15 mm, 0.1 m along its z. The paper's Table 1
/// rounds them to three or four digits.
[[nodiscard]] std::array<engine::LinkInertia, engine::kLinkCount> steel_links();

}  // namespace validation
