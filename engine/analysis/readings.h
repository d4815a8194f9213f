// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "engine/dynamics/evaluation.h"

namespace engine {

/// Value of a quantity that a run does not have.
inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// A number read from the mechanism at one instant.
using Reading = std::function<double(const Evaluation&)>;

/// Called with an instant before anything is read of it; empty: not needed.
using Preparation = std::function<void(const Evaluation&)>;

/// Angle between the axes of journal and bearing, [rad]
[[nodiscard]] inline double calc_tilt(const JournalMotion& journal) {
  return std::asin(std::min(1.0, journal.R_bj.col(2).head<2>().norm()));
}

}  // namespace engine
