// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "engine/clearance/clearance_parameters.h"
#include "engine/clearance/journal_motion.h"
#include "engine/clearance/normal_force.h"

namespace engine {

/// Radial contact in closed form: what each ring of the journal remembers of its contact with the bore. The
/// law: continuum_law.h.
class RadialContinuum {
 public:
  explicit RadialContinuum(const ClearanceParameters& joint);

  [[nodiscard]] const ClearanceParameters& parameters() const { return joint_; }
  /// One a ring.
  [[nodiscard]] const OnsetLatch* latches() const { return latches_.data(); }
  [[nodiscard]] double ring_position(int ring) const {
    return positions_[static_cast<std::size_t>(ring)];
  }  ///< along the journal's axis, [m]
  [[nodiscard]] const double* ring_positions() const { return positions_.data(); }  ///< [m]
  /// Setback of each ring, 0; of places beyond the last ring so large that they never touch. Latches,
  /// positions and setbacks may be read four at a time, the last ones beyond the rings. [m]
  [[nodiscard]] const double* setback() const { return setback_.data(); }
  [[nodiscard]] double ring_stiffness() const {
    return ring_stiffness_;
  }  ///< by Hertz's law, of each, [N/m^1.5]
  /// Largest penetration for which the stiffness law holds; infinite for most. [m]
  [[nodiscard]] double range() const { return range_; }
  [[nodiscard]] double ring_damping() const {
    return ring_damping_;
  }  ///< Kelvin and Voigt's, of each, [N s/m]
  /// Bristle components in the state: two a ring.
  [[nodiscard]] int bristle_count() const { return 2 * joint_.n_r; }

  /// Appends the penetration of each ring.
  void add_penetrations(const JournalMotion& journal, std::vector<Penetration>& rings) const;

  /// Takes note of contacts that began or ended in a step; a bristle is relaxed where its contact has ended.
  ContactChange advance(const JournalMotion& start, const JournalMotion& end, double dt, double* bristles);

 private:
  [[nodiscard]] Penetration calc_penetration(const RelativeMotion<double, double>& journal, int ring) const;

  ClearanceParameters joint_;
  double ring_stiffness_, ring_damping_, range_;
  std::vector<double> positions_, setback_;
  std::vector<OnsetLatch> latches_;
};

}  // namespace engine
