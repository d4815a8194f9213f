#include "engine/clearance/radial_continuum.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace engine {

namespace {

/// Offset of a ring's centre from the bearing axis in the cross-section, and its velocity. Below 1e-12 m there is no normal: n is zero.
struct RingOffset {
  Eigen::Vector3d axial;  ///< from the journal centre to the ring's
  double distance;
  Eigen::Vector3d n;
  double rate;
};

RingOffset calc_offset(const JournalMotion& journal, double s) {
  RingOffset ring;
  ring.axial = s * journal.R_bj.col(2);
  const Eigen::Vector3d centre = journal.p_bj + ring.axial;
  ring.distance = std::hypot(centre.x(), centre.y());
  ring.n.setZero();
  if (ring.distance > 1e-12) ring.n.head<2>() = centre.head<2>() / ring.distance;
  ring.rate = ring.n.dot(journal.calc_velocity(ring.axial));
  return ring;
}

}  // namespace

RadialContinuum::RadialContinuum(const ClearanceParameters& joint) : joint_(joint), latches_(static_cast<std::size_t>(joint.n_r)) {}

Penetration RadialContinuum::calc_penetration(const JournalMotion& journal, int ring) const {
  const RingOffset offset = calc_offset(journal, ring_position(joint_, ring));
  return {offset.distance - joint_.c_r, offset.rate};
}

void RadialContinuum::calc(const JournalMotion& journal, const double* bristles, double* bristle_rates, ContactLoad& load) const {
  for (int i = 0; i < joint_.n_r; ++i) {
    bristle_rates[2 * i] = bristle_rates[2 * i + 1] = 0.0;
    const RingOffset ring = calc_offset(journal, ring_position(joint_, i));
    const double delta = ring.distance - joint_.c_r;
    if (!(delta > 0.0)) continue;
    const double elastic = joint_.K / joint_.n_r * delta * std::sqrt(delta);
    const double onset = latches_[static_cast<std::size_t>(i)].onset_rate(ring.rate, joint_.minimum_onset_rate);
    const RadialTouch touch{ring.axial + joint_.r_j() * ring.n, ring.n, calc_normal_force(elastic, ring.rate, onset, joint_.chi), ring.rate};
    add_radial_touch(joint_, journal, touch, bristles + 2 * i, bristle_rates + 2 * i, load);
    load.elastic_energy += 0.4 * elastic * delta;
    load.max_penetration = std::max(load.max_penetration, delta);
  }
}

void RadialContinuum::add_penetrations(const JournalMotion& journal, std::vector<Penetration>& rings) const {
  for (int i = 0; i < joint_.n_r; ++i) rings.push_back(calc_penetration(journal, i));
}

ContactChange RadialContinuum::advance(const JournalMotion& start, const JournalMotion& end, double dt, double* bristles) {
  ContactChange change;
  for (int i = 0; i < joint_.n_r; ++i) {
    OnsetLatch& latch = latches_[static_cast<std::size_t>(i)];
    if (latch.advance(calc_penetration(start, i), calc_penetration(end, i), dt, joint_.minimum_onset_rate)) {
      change.any = true;
      change.ring_onsets += latch.in_contact() ? 1 : 0;
    }
    if (!latch.in_contact()) bristles[2 * i] = bristles[2 * i + 1] = 0.0;
  }
  return change;
}

}  // namespace engine
