// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "engine/clearance/normal_force.h"

namespace engine {

/// Event location: the instant in a step at which a ring comes into contact or leaves it, by the cubic
/// through its penetration and penetration rate at both ends. A step ends just beyond the event, on the new
/// side, within kBand.
class ContactEvents {
 public:
  /// At 0.1 m/s that is a nanosecond, and K delta^1.5 a thousandth of a newton at most.
  static constexpr double kBand = 1e-10;  ///< [m]

  /// The earliest crossing in a step of dt as the length of the step that ends just beyond it; empty if there
  /// is none, or only one that lies within kBand of the step's end.
  [[nodiscard]] static std::optional<double> find_first(const std::vector<Penetration>& start,
                                                        const std::vector<Penetration>& end, double dt);
};

}  // namespace engine
