#pragma once

#include <algorithm>

#include "engine/clearance/contact_law.h"
#include "engine/clearance/radial_continuum.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Offset of a ring's centre from the bearing axis in the cross-section. Below 1e-12 m there is no normal: n is zero.
template <typename P>
struct RingOffset {
  Vec3<P> axial;    ///< from the journal centre to the ring's
  P distance;       ///< |e|
  P n_x, n_y;       ///< e / |e|
};

template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE RingOffset<P> calc_ring_offset(const RelativeMotion<P, V>& journal, double position) {
  RingOffset<P> ring;
  ring.axial = position * journal.R.z;
  const P e_x = journal.p.x + ring.axial.x;
  const P e_y = journal.p.y + ring.axial.y;
  ring.distance = sqrt(e_x * e_x + e_y * e_y);
  const bool has_normal = value_of(ring.distance) > 1e-12;
  const P inverse = has_normal ? 1.0 / ring.distance : P(0.0);
  ring.n_x = inverse * e_x;
  ring.n_y = inverse * e_y;
  return ring;
}

template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE V calc_ring_rate(const RelativeMotion<P, V>& journal, const RingOffset<P>& ring) {
  const Vec3<V> velocity = journal.calc_velocity(ring.axial);
  return ring.n_x * velocity.x + ring.n_y * velocity.y;
}

template <typename P>
struct RingForce {
  P elastic;         ///< [N]
  double energy;     ///< stored, [J]
};

/// The elastic force of one of the rings.
template <typename P>
[[nodiscard]] RPSUP_INLINE RingForce<P> calc_ring_force(const ClearanceParameters& joint, const P& delta) {
  if (joint.cylinders.law == StiffnessLaw::kHertz) {
    const P elastic = (joint.K / joint.n_r) * (delta * sqrt(delta));
    return {elastic, 0.4 * value_of(elastic) * value_of(delta)};
  }
  const ElasticForce whole = joint.cylinders.calc(value_of(delta));
  return {chain(delta, whole.force / joint.n_r, whole.slope / joint.n_r), whole.energy / joint.n_r};
}

/// Radial contact in closed form: each ring of the journal against the bore, one force a ring.
///
///     e offset of the ring's centre from the bearing axis,  delta = |e| - c_r,  n = e / |e|,  f_e = K / n_r delta^1.5 by Hertz
/// @tparam Load  a JointLoad<V>
template <typename P, typename V, typename Load>
RPSUP_INLINE void add_continuum(const RadialContinuum& contact, const RelativeMotion<P, V>& journal, const V* bristles, V* bristle_rates,
                                Load& load) {
  const ClearanceParameters& joint = contact.parameters();
  for (int i = 0; i < joint.n_r; ++i) {
    bristle_rates[2 * i] = bristle_rates[2 * i + 1] = V(0.0);
    const RingOffset<P> ring = calc_ring_offset(journal, calc_ring_position(joint, i));
    const P delta = ring.distance - joint.c_r;
    if (!(value_of(delta) > 0.0)) continue;
    const V rate = calc_ring_rate(journal, ring);
    const RingForce<P> force = calc_ring_force(joint, delta);
    const V onset = choose_onset_rate(contact.latches()[i].rate(), rate, joint.minimum_onset_rate);
    const NormalLaw<V> normal = calc_normal_law(force.elastic, rate, onset, joint.chi, joint.damping / joint.n_r);
    const double r_j = joint.r_j();
    const Vec3<P> r{ring.axial.x + r_j * ring.n_x, ring.axial.y + r_j * ring.n_y, ring.axial.z};
    add_touch(joint, journal, Touch<P, V>{r, ring.n_x, ring.n_y, normal}, bristles + 2 * i, bristle_rates + 2 * i, load);
    load.elastic_energy += force.energy;
    load.max_penetration = std::max(load.max_penetration, value_of(delta));
    load.out_of_range = load.out_of_range || force.energy != force.energy;
    load.close_touch(2 * i);
  }
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
