// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/clearance/contact_law.h"
#include "engine/clearance/radial_continuum.h"
#include "engine/math/dual.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

// Of one ring of the journal, or of several side by side.

/// Offset of a ring's centre from the bearing axis in the cross-section. Below 1e-12 m there is no normal: n
/// is zero.
template <typename P>
struct RingOffset {
  Vec3<P> axial;    ///< from the journal centre to the ring's
  P distance;       ///< |e|
  P n_x, n_y;       ///< e / |e|
};

/// 1 / a, or zero unless a is greater than least.
template <typename P>
[[nodiscard]] RPSUP_INLINE P invert_or_zero(const P& a, double least) {
  return value_of(a) > least ? 1.0 / a : P(0.0);
}
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> invert_or_zero(const LaneBlock<count>& a, double least) {
  return choose_greater(a, LaneBlock<count>::all(least), 1.0 / a, LaneBlock<count>{});
}

/// @param position  along the journal's axis
template <typename P, typename V, typename Position>
[[nodiscard]] RPSUP_INLINE RingOffset<Mixed<Position, P>> calc_ring_offset(
    const RelativeMotion<P, V>& journal, const Position& position) {
  RingOffset<Mixed<Position, P>> ring;
  ring.axial = position * journal.R.z;
  const auto e_x = journal.p.x + ring.axial.x;
  const auto e_y = journal.p.y + ring.axial.y;
  ring.distance = sqrt(e_x * e_x + e_y * e_y);
  const auto inverse = invert_or_zero(ring.distance, 1e-12);
  ring.n_x = inverse * e_x;
  ring.n_y = inverse * e_y;
  return ring;
}

template <typename P, typename V, typename R>
[[nodiscard]] RPSUP_INLINE Mixed<V, R> calc_ring_rate(const RelativeMotion<P, V>& journal,
                                                      const RingOffset<R>& ring) {
  const auto velocity = journal.calc_velocity(ring.axial);
  return ring.n_x * velocity.x + ring.n_y * velocity.y;
}

/// Penetration of a round bore.
template <typename P>
[[nodiscard]] RPSUP_INLINE P calc_penetration(const RadialContinuum& contact, const RingOffset<P>& ring) {
  return ring.distance - contact.parameters().c_r;
}

template <typename P>
struct RingForce {
  P elastic;           ///< [N]
  ValueOf<P> energy;   ///< stored, [J]
};

/// By Hertz's law. @param delta  penetration, >= 0
template <typename P>
[[nodiscard]] RPSUP_INLINE RingForce<P> calc_hertz_force(const RadialContinuum& contact, const P& delta) {
  const P elastic = contact.ring_stiffness() * (delta * sqrt(delta));
  return {elastic, 0.4 * value_of(elastic) * value_of(delta)};
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
