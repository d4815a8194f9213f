// SPDX-License-Identifier: Apache-2.0
#include "engine/clearance/radial_continuum.h"

#include <cstddef>

#include "engine/clearance/continuum_law.h"

namespace engine {

namespace {

template <typename RingOnBore>
Penetration penetration_of(const RingOnBore& on_bore, const RelativeMotion<double, double>& journal) {
  return {on_bore.delta, on_bore.calc_rate(journal)};
}

}  // namespace

RadialContinuum::RadialContinuum(const ClearanceParameters& joint)
    : joint_(joint),
      ring_stiffness_(joint.K / joint.n_r),
      ring_damping_(joint.damping / joint.n_r),
      range_(joint.cylinders.range()),
      latches_(static_cast<std::size_t>(joint.n_r)) {
  constexpr std::size_t kReadTogether = 4;
  for (int i = 0; i < joint.n_r; ++i) positions_.push_back(calc_ring_position(joint, i));
  setback_.resize(positions_.size(), 0.0);
  setback_.resize(positions_.size() + kReadTogether, 1.0);
  positions_.resize(setback_.size());
  latches_.resize(setback_.size());
}

Penetration RadialContinuum::calc_penetration(const RelativeMotion<double, double>& journal, int ring) const {
  if (joint_.worn) return penetration_of(locate_on_worn_bore(*this, journal, ring), journal);
  return penetration_of(locate_on_round_bore(*this, journal, ring), journal);
}

void RadialContinuum::add_penetrations(const JournalMotion& journal, std::vector<Penetration>& rings) const {
  const RelativeMotion<double, double> motion = to_relative_motion(journal);
  for (int i = 0; i < joint_.n_r; ++i) rings.push_back(calc_penetration(motion, i));
}

ContactChange RadialContinuum::advance(const JournalMotion& start, const JournalMotion& end, double dt,
                                       double* bristles) {
  const RelativeMotion<double, double> motion_end = to_relative_motion(end);
  ContactChange change;
  for (int i = 0; i < joint_.n_r; ++i) {
    OnsetLatch& latch = latches_[static_cast<std::size_t>(i)];
    const Penetration at_end = calc_penetration(motion_end, i);
    if ((at_end.delta > 0.0) != latch.in_contact()) {
      change.any |= latch.advance(calc_penetration(to_relative_motion(start), i), at_end, dt,
                                  joint_.minimum_onset_rate);
      change.abrupt = change.any;
      change.ring_onsets += latch.in_contact() ? 1 : 0;
    }
    if (!latch.in_contact()) bristles[2 * i] = bristles[2 * i + 1] = 0.0;
  }
  return change;
}

}  // namespace engine
