// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>

#include "engine/clearance/contact_law.h"
#include "engine/clearance/friction_law.h"
#include "engine/clearance/radial_continuum.h"
#include "engine/clearance/ring.h"
#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Adds the load of one of the rings.
template <int count>
RPSUP_INLINE void add_lane(const JointLoad<LaneBlock<count>>& rings, int lane, JointLoad<double>& load) {
  load.force += Vec3<double>{rings.force.x[lane], rings.force.y[lane], rings.force.z[lane]};
  load.moment += Vec3<double>{rings.moment.x[lane], rings.moment.y[lane], rings.moment.z[lane]};
  load.impact_power += rings.impact_power[lane];
  load.friction_power += rings.friction_power[lane];
  load.radial_normal_sum += rings.radial_normal_sum[lane];
  load.friction_sum += rings.friction_sum[lane];
  load.max_penetration = std::max(load.max_penetration, rings.max_penetration[lane]);
  load.elastic_energy += rings.elastic_energy[lane];
}

/// Loads of the rings from the i-th on, side by side, on a round bore, by Hertz's law: to the bit those of
/// add_ring() one after the other, but roots and quotients of all take no longer than those of one.
/// A ring that does not press adds zeros. Hertz's law holds for every penetration.
/// @tparam count  of lanes; rings that there are not stand back from the bore
template <int count>
RPSUP_INLINE void add_rings(const RadialContinuum& contact, const RelativeMotion<double, double>& journal,
                            int i, const double* bristles, double* bristle_rates, JointLoad<double>& load) {
  using Rings = LaneBlock<count>;
  const ClearanceParameters& joint = contact.parameters();
  const int present = std::min(count, joint.n_r - i);
  const Rings none{};
  const RingOffset<Rings> ring = calc_ring_offset(journal, Rings::load(contact.ring_positions() + i));
  const Rings beyond = calc_penetration(contact, ring) - Rings::load(contact.setback() + i);
  double* rates = bristle_rates + 2 * i;
  std::fill(rates, rates + 2 * present, 0.0);
  const Rings delta = cut_at_zero(beyond);
  if (all_below(delta, std::numeric_limits<double>::min())) return;  // no ring presses
  const Rings rate = calc_ring_rate(journal, ring);
  const RingForce<Rings> force = calc_hertz_force(contact, delta);
  const Rings onset = choose_onset_rate(Rings::load(contact.latches() + i), rate, joint.minimum_onset_rate);
  NormalForce<Rings> normal =
      calc_normal_force(force.elastic, rate, onset, joint.chi, contact.ring_damping());
  normal = {choose_greater(beyond, none, normal.total, none),
            choose_greater(beyond, none, normal.loss_power, none)};
  const double r_j = joint.r_j();
  const Vec3<Rings> r{ring.axial.x + r_j * ring.n_x, ring.axial.y + r_j * ring.n_y, ring.axial.z};
  Rings z[2] = {none, none}, z_rates[2] = {none, none};
  for (int lane = 0; lane < present; ++lane) {
    z[0].set(lane, bristles[2 * (i + lane)]);
    z[1].set(lane, bristles[2 * (i + lane) + 1]);
  }
  JointLoad<Rings> rings;
  add_contact_point(joint, journal, ContactPoint<Rings, Rings>{r, ring.n_x, ring.n_y, normal}, z, z_rates,
                    rings);
  rings.elastic_energy = force.energy;
  rings.max_penetration = delta;
  for (int lane = 0; lane < present; ++lane) {
    add_lane(rings, lane, load);
    if (!(beyond[lane] > 0.0)) continue;
    rates[2 * lane] = z_rates[0][lane];
    rates[2 * lane + 1] = z_rates[1][lane];
  }
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
