// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tests/bench/codes/plain_linkage.h"

namespace bench {

/// The linkage in MuJoCo's XML: bodies, joints, loops, springs and dampers; without what acts between bearing
/// and journal. Loops are closed while all coordinates are zero.
///
/// Joints carry the names of the coordinates. Driven ones have an armature that nothing in the mechanism can
/// move, so that a force of armature times the wanted acceleration drives them. Actuators without force hold
/// the bristles as activations.
/// @param step  [s]
[[nodiscard]] std::string write_mjcf(const PlainLinkage& linkage, const char* integrator, double step);

/// Of a driven coordinate: 1e10 times what the linkage's bodies have.
inline constexpr double kDrivenArmature = 1e10;

}  // namespace bench
