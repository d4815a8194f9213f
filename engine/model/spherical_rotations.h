// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/model/mechanism.h"

namespace engine {

/// @returns whether the coordinates psi, psi + 1 and psi + 2 are rotations about z, y and x of one point,
///     with nothing else on the two frames between: their angles may be any that give the last frame
[[nodiscard]] bool are_spherical_rotations(const Mechanism& mechanism, FrameIndex psi);

}  // namespace engine
