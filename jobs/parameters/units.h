// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

namespace jobs {

/// Lengths are given in mm where they are small, and kept in m.
inline constexpr double kMmPerM = 1000.0;

/// Angles of directions are given in degrees and kept in radians.
inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;

}  // namespace jobs
