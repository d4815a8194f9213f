// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/clearance/clearance_parameters.h"
#include "engine/clearance/friction_law.h"
#include "engine/math/dual.h"
#include "engine/math/vec3.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// JournalMotion of numbers of any type: the journal as seen from the bearing, frame {j} in frame {b}, all in
/// {b}. z is both parts' axis. P: what depends on positions; V: what depends on velocities as well.
template <typename P, typename V>
struct RelativeMotion {
  Mat3<P> R;        ///< R_bj
  Vec3<P> p;        ///< journal centre, [m]
  Vec3<V> v, w;     ///< of the journal centre and of the journal relative to {b}

  /// Velocity of the journal's material point at r from its centre, less that of the bearing's at the same
  /// place.
  template <typename Place>
  [[nodiscard]] RPSUP_INLINE Vec3<Mixed<V, Place>> calc_velocity(const Vec3<Place>& r) const {
    return v + cross(w, r);
  }
};

/// Sums over all contacts of a joint. Force and moment act on the journal, about its centre, in {b}.
template <typename V>
struct JointLoad {
  using Value = ValueOf<V>;

  Vec3<V> force, moment;
  V impact_power{};                  ///< lost in the normal law, [W]
  V friction_power{};                ///< [W]
  Value radial_normal_sum{};         ///< [N]
  Value face_normal_sum{};           ///< [N]
  Value friction_sum{};              ///< magnitudes, [N]
  Value max_penetration{};           ///< of radial contacts, [m]
  Value elastic_energy{};            ///< [J]
  bool face_touches = false;         ///< a point of a face is beyond its shoulder
  bool out_of_range = false;         ///< a penetration is beyond what the stiffness law holds for

  /// Called when the load of one contact point is complete. @param bristle  index of its first bristle in the
  /// state
  RPSUP_INLINE void end_contact_point(int /*bristle*/) {}

  template <typename P>
  RPSUP_INLINE void add_force(const Vec3<P>& r, const Vec3<V>& f) {
    force += f;
    moment += cross(r, f);
  }
};

template <typename V>
struct NormalForce {
  V total;                           ///< f_n, [N], >= 0
  V loss_power;                      ///< power that the contact takes from the motion for good, [W]
};

/// The onset rate that serves in the normal law: the latched one (> 0), or in a contact that has just begun
/// the current one.
template <typename V>
[[nodiscard]] RPSUP_INLINE V choose_onset_rate(double latched, const V& rate, double minimum) {
  if (latched > 0.0) return V(latched);
  return value_of(rate) > minimum ? rate : V(minimum);
}
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> choose_onset_rate(const LaneBlock<count>& latched,
                                                              const LaneBlock<count>& rate, double minimum) {
  const auto none = LaneBlock<count>{}, least = LaneBlock<count>::all(minimum);
  return choose_greater(latched, none, latched, choose_greater(rate, least, rate, least));
}

/// x where it is not negative, else zero.
template <typename V>
[[nodiscard]] RPSUP_INLINE V cut_at_zero(const V& x) {
  return value_of(x) < 0.0 ? V(0.0) : x;
}
template <int count>
[[nodiscard]] RPSUP_INLINE LaneBlock<count> cut_at_zero(const LaneBlock<count>& x) {
  const LaneBlock<count> none{};
  return choose_greater(none, x, none, x);
}

/// Damping on a given elastic force, Eq. (11.1): f_n = f_e (1 + chi rate / rate_onset) + damping rate, never
/// negative.
///
/// With Lankarani and Nikravesh's chi the rebound is not k_r times the impact velocity: k_r = 0.9 returns
/// 0.9132.
/// @param damping  Kelvin and Voigt's of this contact, [N s/m]
template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE NormalForce<V> calc_normal_force(const P& elastic, const V& rate,
                                                            const V& onset_rate, double chi, double damping) {
  V total = elastic * (1.0 + chi * rate / onset_rate);
  if (damping > 0.0) total += damping * rate;
  const V cut = cut_at_zero(total);
  return {cut, (cut - elastic) * rate};
}

/// A point where journal and bore touch: r from the journal centre, (n_x, n_y, 0) the outward normal of the
/// bore, both in {b}.
template <typename P, typename V>
struct ContactPoint {
  Vec3<P> r;
  P n_x, n_y;
  NormalForce<V> normal;
};

/// Adds normal force and friction of a contact point to the load. The bristle has two components, along t =
/// e_b x n and along the axis.
/// @param bristle        may be null: no bristle to read or move
/// @param bristle_rate   where its rate goes
template <typename Journal, typename P, typename V>
RPSUP_INLINE void add_contact_point(const ClearanceParameters& joint, const Journal& journal,
                                    const ContactPoint<P, V>& point, const V* bristle, V* bristle_rate,
                                    JointLoad<V>& load) {
  const V& f_n = point.normal.total;
  Vec3<V> force{-(f_n * point.n_x), -(f_n * point.n_y), V{}};
  load.radial_normal_sum += value_of(f_n);
  load.impact_power += point.normal.loss_power;
  if (joint.friction) {
    const FrictionParameters& law = *joint.friction;
    const Vec3<V> velocity = journal.calc_velocity(point.r);
    const V v_t = velocity.y * point.n_x - velocity.x * point.n_y;
    const V& v_z = velocity.z;
    const FrictionForce<V> friction =
        calc_friction(law, v_t, v_z, bristle ? bristle[0] : V{}, bristle ? bristle[1] : V{});
    const V f_t = f_n * friction.along_t.force_ratio;
    const V f_z = f_n * friction.along_z.force_ratio;
    force.x += f_t * point.n_y;
    force.y -= f_t * point.n_x;
    force.z -= f_z;
    load.friction_sum += sqrt(value_of(f_t) * value_of(f_t) + value_of(f_z) * value_of(f_z));
    load.friction_power += f_t * v_t + f_z * v_z;
    if (bristle_rate) {
      bristle_rate[0] = friction.along_t.rate;
      bristle_rate[1] = friction.along_z.rate;
    }
  }
  load.add_force(point.r, force);
}

/// Axial position of a ring on the journal: evenly spaced over the length, a single one in the middle.
[[nodiscard]] RPSUP_INLINE double calc_ring_position(const ClearanceParameters& joint, int ring) {
  return joint.n_r == 1 ? 0.0 : joint.L_b * (static_cast<double>(ring) / (joint.n_r - 1) - 0.5);
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
