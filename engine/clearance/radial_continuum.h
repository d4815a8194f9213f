#pragma once

#include <vector>

#include "engine/clearance/radial_contact.h"

namespace engine {

/// Radial contact in closed form: each ring of the journal against the bore, one force a ring.
///
///     e offset of the ring's centre from the bearing axis,  delta = |e| - c_r,  n = e / |e|,  f_e = K / n_r delta^1.5
class RadialContinuum {
 public:
  explicit RadialContinuum(const ClearanceParameters& joint);

  /// Bristle components in the state: two a ring.
  [[nodiscard]] int bristle_count() const { return 2 * joint_.n_r; }

  /// Adds the contact's load. @param bristles, bristle_rates  bristle_count() entries; rates are set, 0 out of contact.
  void calc(const JournalMotion& journal, const double* bristles, double* bristle_rates, ContactLoad& load) const;

  /// Appends the penetration of each ring.
  void add_penetrations(const JournalMotion& journal, std::vector<Penetration>& rings) const;

  /// Takes note of contacts that began or ended in a step; a bristle is relaxed where its contact has ended.
  ContactChange advance(const JournalMotion& start, const JournalMotion& end, double dt, double* bristles);

 private:
  [[nodiscard]] Penetration calc_penetration(const JournalMotion& journal, int ring) const;

  ClearanceParameters joint_;
  std::vector<OnsetLatch> latches_;
};

}  // namespace engine
