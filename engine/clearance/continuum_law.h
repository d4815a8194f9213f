// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <type_traits>

#include "engine/clearance/contact_law.h"
#include "engine/clearance/radial_continuum.h"
#include "engine/clearance/ring.h"
#include "engine/clearance/rings_side_by_side.h"
#include "engine/math/finite.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// The elastic force of one of the rings.
template <typename P>
[[nodiscard]] RPSUP_INLINE RingForce<P> calc_ring_force(const RadialContinuum& contact, const P& delta) {
  const ClearanceParameters& joint = contact.parameters();
  if (joint.cylinders.law == StiffnessLaw::kHertz) return calc_hertz_force(contact, delta);
  const ElasticForce whole = joint.cylinders.calc(value_of(delta));
  return {chain(delta, whole.force / joint.n_r, whole.slope / joint.n_r), whole.energy / joint.n_r};
}

/// A ring and a round bore: the offset of the ring, and its penetration.
///
///     delta = |e| - c_r,  n = e / |e|
template <typename P>
struct RingOnRoundBore {
  RingOffset<P> ring;
  P delta;

  template <typename V>
  [[nodiscard]] RPSUP_INLINE V calc_rate(const RelativeMotion<P, V>& journal) const {
    return calc_ring_rate(journal, ring);
  }
  template <typename V>
  [[nodiscard]] RPSUP_INLINE const NormalForce<V>& press(const NormalForce<V>& normal) const {
    return normal;
  }
};

template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE RingOnRoundBore<P> locate_on_round_bore(const RadialContinuum& contact,
                                                             const RelativeMotion<P, V>& journal, int ring) {
  const RingOffset<P> offset = calc_ring_offset(journal, contact.ring_position(ring));
  return {offset, calc_penetration(contact, offset)};
}

/// Contact of a ring with a worn bore, or the gap between them. The free radius R(theta) depends on the
/// direction theta of the ring's offset: worn_bore.h.
///
///     delta = |e| - R,  grad delta = u - R' / |e| t,  u = e / |e|,  t = e_b x u,
///     n = grad delta / |grad delta|
///
/// The elastic force is the gradient of what it stores, so that nothing is lost or won along a groove:
/// f_e(delta) |grad delta| along n, which is the bore's normal where the journal touches first. On a steep
/// wall that is stiffer than the round bore, by |grad delta|^2.5.
template <typename P>
struct RingOnWornBore {
  RingOffset<P> ring;  ///< its normal is n
  P delta;
  P gradient;          ///< |grad delta|, 1 where R does not vary, [1]

  template <typename V>
  [[nodiscard]] RPSUP_INLINE V calc_rate(const RelativeMotion<P, V>& journal) const {
    return gradient * calc_ring_rate(journal, ring);
  }
  template <typename V>
  [[nodiscard]] RPSUP_INLINE NormalForce<V> press(const NormalForce<V>& normal) const {
    return {gradient * normal.total, normal.loss_power};
  }
};

template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE RingOnWornBore<P> locate_on_worn_bore(const RadialContinuum& contact,
                                                           const RelativeMotion<P, V>& journal, int ring) {
  const ClearanceParameters& joint = contact.parameters();
  RingOffset<P> offset = calc_ring_offset(journal, contact.ring_position(ring));
  const double distance = value_of(offset.distance);
  if (!is_number(distance) || !(distance > 1e-12))  // no direction
    return {offset, offset.distance - joint.c_r, P(1.0)};
  const P theta = atan2(offset.n_y, offset.n_x);
  const PeriodicSpline::Point added = joint.worn->calc_added_clearance(ring, value_of(theta));
  const P delta = offset.distance - joint.c_r - chain(theta, added.value, added.slope);
  const P slope = chain(theta, added.slope, added.bend) / offset.distance;
  const P gradient = sqrt(1.0 + slope * slope);
  const P n_x = (offset.n_x + slope * offset.n_y) / gradient;
  const P n_y = (offset.n_y - slope * offset.n_x) / gradient;
  offset.n_x = n_x;
  offset.n_y = n_y;
  return {offset, delta, gradient};
}

/// Adds the load of one ring, and sets the rates of its bristles.
template <typename P, typename V, typename Load, typename RingOnBore>
RPSUP_INLINE void add_ring(const RadialContinuum& contact, const RelativeMotion<P, V>& journal, int i,
                           const RingOnBore& on_bore, const V* bristles, V* bristle_rates, Load& load) {
  const ClearanceParameters& joint = contact.parameters();
  bristle_rates[2 * i] = bristle_rates[2 * i + 1] = V(0.0);
  const P& delta = on_bore.delta;
  if (!(value_of(delta) > 0.0)) return;
  const RingOffset<P>& ring = on_bore.ring;
  if (value_of(delta) >= contact.range()) {
    load.out_of_range = true;
    return;
  }
  const V rate = on_bore.calc_rate(journal);
  const RingForce<P> force = calc_ring_force(contact, delta);
  const V onset = choose_onset_rate(contact.latches()[i].rate(), rate, joint.minimum_onset_rate);
  const NormalForce<V> normal =
      on_bore.press(calc_normal_force(force.elastic, rate, onset, joint.chi, contact.ring_damping()));
  const double r_j = joint.r_j();
  const Vec3<P> r{ring.axial.x + r_j * ring.n_x, ring.axial.y + r_j * ring.n_y, ring.axial.z};
  add_contact_point(joint, journal, ContactPoint<P, V>{r, ring.n_x, ring.n_y, normal}, bristles + 2 * i,
                    bristle_rates + 2 * i, load);
  load.elastic_energy += force.energy;
  load.max_penetration = std::max(load.max_penetration, value_of(delta));
  load.end_contact_point(2 * i);
}

/// Kept out of the code of round bores, which most are. (static: see add_elements.)
template <typename P, typename V, typename Load>
[[gnu::noinline]] static void add_worn_continuum(const RadialContinuum& contact,
                                                 const RelativeMotion<P, V>& journal, const V* bristles,
                                                 V* bristle_rates, Load& load) {
  for (int i = 0; i < contact.parameters().n_r; ++i)
    add_ring(contact, journal, i, locate_on_worn_bore(contact, journal, i), bristles, bristle_rates, load);
}

/// Radial contact in closed form: each ring of the journal against the bore, one force a ring.
///
///     e offset of the ring's centre from the bearing axis,  f_e = K / n_r delta^1.5 by Hertz,
///     delta and its direction as in RingOnRoundBore or RingOnWornBore
/// @tparam Load  a JointLoad<V>
template <typename P, typename V, typename Load>
RPSUP_INLINE void add_continuum(const RadialContinuum& contact, const RelativeMotion<P, V>& journal,
                                const V* bristles, V* bristle_rates, Load& load) {
  const ClearanceParameters& joint = contact.parameters();
  if (joint.worn) {
    // Copies, since their addresses are passed on: the originals may stay in registers.
    const RelativeMotion<P, V> journal_copy = journal;
    Load load_copy = load;
    add_worn_continuum(contact, journal_copy, bristles, bristle_rates, load_copy);
    load = load_copy;
    return;
  }
  int i = 0;
  if constexpr (std::is_same_v<Load, JointLoad<double>>)
    if (joint.cylinders.law == StiffnessLaw::kHertz) {
      for (; i + 2 < joint.n_r; i += 4) add_rings<4>(contact, journal, i, bristles, bristle_rates, load);
      for (; i + 1 < joint.n_r; i += 2) add_rings<2>(contact, journal, i, bristles, bristle_rates, load);
    }
  for (; i < joint.n_r; ++i)
    add_ring(contact, journal, i, locate_on_round_bore(contact, journal, i), bristles, bristle_rates, load);
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
