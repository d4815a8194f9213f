// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "engine/clearance/worn_bore.h"

namespace jobs {

/// Arc of a worn bore that a ring of the journal presses on, and the division of the wear over it: as the
/// pressure of an elastic layer does, which grows with how deep the bore is pressed,
///
///     p(phi) ~ |e| cos(phi - theta) - c_r - g(phi) where that is above 0,    |e| = R(theta) + penetration
///     (engine::WornBore)
class PressedArc {
 public:
  /// @param c_r  of the bore as it was new, [m]
  PressedArc(const engine::WornBore& bore, int ring, double c_r, std::size_t sectors);

  /// Adds the work of a contact in the direction theta to the sectors that it presses on; all of it.
  void add(double work, double theta, double penetration, std::vector<double>& by_sector);

 private:
  /// Sum of the pressures, and the point that lies deepest in the journal, or nearest to it.
  struct Load {
    double pressure = 0.0;
    std::size_t deepest = 0;
  };
  /// Sets the pressures under a ring whose centre lies at a distance in the direction theta.
  Load calc_pressures(double distance, double theta);

  const engine::WornBore& bore_;
  int ring_;
  double c_r_;
  std::size_t points_;              ///< in each sector
  std::vector<double> cosine_, sine_, gap_;  ///< of each point around the bore: of its angle; c_r + g
  std::vector<double> pressure_;             ///< kept for its room
};

}  // namespace jobs
