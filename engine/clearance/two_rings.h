// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "engine/clearance/contact_law.h"
#include "engine/clearance/friction_law.h"
#include "engine/clearance/radial_continuum.h"
#include "engine/clearance/ring.h"
#include "engine/math/lanes.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Adds the load of one of two rings.
RPSUP_INLINE void add_lane(const JointLoad<LanePair>& two, int lane, JointLoad<double>& load) {
  load.force += Vec3<double>{two.force.x[lane], two.force.y[lane], two.force.z[lane]};
  load.moment += Vec3<double>{two.moment.x[lane], two.moment.y[lane], two.moment.z[lane]};
  load.impact_power += two.impact_power[lane];
  load.friction_power += two.friction_power[lane];
  load.radial_normal_sum += two.radial_normal_sum[lane];
  load.friction_sum += two.friction_sum[lane];
  load.max_penetration = std::max(load.max_penetration, two.max_penetration[lane]);
  load.elastic_energy += two.elastic_energy[lane];
}

/// What two rings side by side do on a round bore, by Hertz's law: to the bit what add_ring() does with one
/// after the other, but their roots and quotients take no longer than those of one. A ring that does not
/// press adds zeros. Hertz's law holds for every penetration.
RPSUP_INLINE void add_two_rings(const RadialContinuum& contact, const RelativeMotion<double, double>& journal,
                                int i, const double* bristles, double* bristle_rates,
                                JointLoad<double>& load) {
  const ClearanceParameters& joint = contact.parameters();
  const LanePair none{};
  const RingOffset<LanePair> ring =
      calc_ring_offset(journal, join(contact.ring_position(i), contact.ring_position(i + 1)));
  const LanePair beyond = calc_penetration(contact, ring);
  double* rates = bristle_rates + 2 * i;
  rates[0] = rates[1] = rates[2] = rates[3] = 0.0;
  if (!(beyond[0] > 0.0) && !(beyond[1] > 0.0)) return;
  const LanePair delta = cut_at_zero(beyond);
  const LanePair rate = calc_ring_rate(journal, ring);
  const RingForce<LanePair> force = calc_hertz_force(contact, delta);
  const LanePair onset =
      choose_onset_rate(LanePair::load(contact.latches() + i), rate, joint.minimum_onset_rate);
  NormalLaw<LanePair> normal = calc_normal_law(force.elastic, rate, onset, joint.chi, contact.ring_damping());
  normal = {choose_greater(beyond, none, normal.total, none),
            choose_greater(beyond, none, normal.loss_power, none)};
  const double r_j = joint.r_j();
  const Vec3<LanePair> r{ring.axial.x + r_j * ring.n_x, ring.axial.y + r_j * ring.n_y, ring.axial.z};
  const LanePair z[2] = {join(bristles[2 * i], bristles[2 * i + 2]),
                           join(bristles[2 * i + 1], bristles[2 * i + 3])};
  LanePair z_rates[2] = {none, none};
  JointLoad<LanePair> two;
  add_contact_point(joint, journal, ContactPoint<LanePair, LanePair>{r, ring.n_x, ring.n_y, normal}, z,
                    z_rates, two);
  two.elastic_energy = force.energy;
  two.max_penetration = delta;
  for (const int lane : {0, 1}) {
    add_lane(two, lane, load);
    if (!(beyond[lane] > 0.0)) continue;
    rates[2 * lane] = z_rates[0][lane];
    rates[2 * lane + 1] = z_rates[1][lane];
  }
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
