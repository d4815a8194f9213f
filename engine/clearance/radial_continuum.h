#pragma once

#include <vector>

#include "engine/clearance/clearance_parameters.h"
#include "engine/clearance/journal_motion.h"
#include "engine/clearance/normal_force.h"

namespace engine {

/// Radial contact in closed form: what each ring of the journal remembers of its contact with the bore. The law: continuum_law.h.
class RadialContinuum {
 public:
  explicit RadialContinuum(const ClearanceParameters& joint);

  [[nodiscard]] const ClearanceParameters& parameters() const { return joint_; }
  /// One a ring.
  [[nodiscard]] const OnsetLatch* latches() const { return latches_.data(); }
  /// Bristle components in the state: two a ring.
  [[nodiscard]] int bristle_count() const { return 2 * joint_.n_r; }

  /// Appends the penetration of each ring.
  void add_penetrations(const JournalMotion& journal, std::vector<Penetration>& rings) const;

  /// Takes note of contacts that began or ended in a step; a bristle is relaxed where its contact has ended.
  ContactChange advance(const JournalMotion& start, const JournalMotion& end, double dt, double* bristles);

 private:
  ClearanceParameters joint_;
  std::vector<OnsetLatch> latches_;
};

}  // namespace engine
