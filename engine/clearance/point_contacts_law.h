// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "engine/clearance/contact_law.h"
#include "engine/clearance/point_contacts.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// A place where two surfaces may touch, in {b}.
template <typename P>
struct SurfacePoint {
  P delta;       ///< penetration, negative: gap, [m]
  Vec3<P> r;     ///< from the journal's centre, [m]
  Vec3<P> n;     ///< outward normal of the bearing's surface
  Vec3<P> t, s;  ///< unit tangents: the directions of the two bristles
};

/// 1 + pole n_z, which is 0 at the other pole. Its rounding there, as a ball may come to that pole before
/// PointContacts::follow() changes the pole: what is divided by it is 0, too.
template <typename P>
[[nodiscard]] RPSUP_INLINE P calc_distance_from_other_pole(double pole, const Vec3<P>& n) {
  constexpr double kRounding = 1e-15;
  const P distance = 1.0 + pole * n.z;
  return value_of(distance) > kRounding ? distance : P(kRounding);
}

/// Tangents at a direction n: those of the pole, turned the shortest way. Singular at the other pole.
///
///     t = (1 - a n_x^2, -a n_x n_y, -pole n_x),  s = (-a n_x n_y, 1 - a n_y^2, -pole n_y),
///     a = 1 / (1 + pole n_z)
template <typename P>
RPSUP_INLINE void set_tangents(double pole, SurfacePoint<P>& point) {
  const Vec3<P>& n = point.n;
  const P a = 1.0 / calc_distance_from_other_pole(pole, n);
  const P mixed = -(a * n.x * n.y);
  point.t = {1.0 - a * n.x * n.x, mixed, -pole * n.x};
  point.s = {mixed, 1.0 - a * n.y * n.y, -pole * n.y};
}

/// delta = |p| - c_r,  n = p / |p|,  r = r_j n. In the middle there is no direction, and no contact.
template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE SurfacePoint<P> locate_ball(const PointContacts& contacts,
                                                       const RelativeMotion<P, V>& journal) {
  const ClearanceParameters& joint = contacts.parameters();
  const Vec3<P>& p = journal.p;
  const P squared = p.x * p.x + p.y * p.y + p.z * p.z;
  SurfacePoint<P> point{};
  point.delta = P(-joint.c_r);
  if (!(value_of(squared) > 1e-24)) return point;
  const P distance = sqrt(squared);
  point.delta = distance - joint.c_r;
  point.n = {p.x / distance, p.y / distance, p.z / distance};
  point.r = joint.r_j() * point.n;
  set_tangents(contacts.pole(), point);
  return point;
}

/// delta = side (p + R c)_axis - reach,  n = side e_axis,  r = R c,  t = e_z x n,  s = e_z
template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE SurfacePoint<P> locate_corner(const PointContacts& contacts,
                                                         const RelativeMotion<P, V>& journal, int i) {
  const PointContacts::Corner& corner = contacts.corner(i);
  SurfacePoint<P> point{};
  point.r = corner.at.x * journal.R.x + corner.at.y * journal.R.y + corner.at.z * journal.R.z;
  const bool along_x = corner.axis == 0;
  const P place = along_x ? journal.p.x + point.r.x : journal.p.y + point.r.y;
  point.delta = corner.side * place - corner.reach;
  (along_x ? point.n.x : point.n.y) = P(corner.side);
  (along_x ? point.t.y : point.t.x) = P(along_x ? corner.side : -corner.side);
  point.s.z = P(1.0);
  return point;
}

template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE SurfacePoint<P> locate_contact(const PointContacts& contacts,
                                                          const RelativeMotion<P, V>& journal, int i) {
  if (contacts.parameters().geometry == ContactGeometry::kBallInSocket) return locate_ball(contacts, journal);
  return locate_corner(contacts, journal, i);
}

/// Spin of the ball's tangents about the normal, t' s = a (n_y n_x' - n_x n_y'). A bristle does not
/// turn with them: on its way along the socket it stays parallel to itself.
template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE V calc_tangent_spin(double pole, const RelativeMotion<P, V>& journal,
                                               const Vec3<P>& n) {
  const P& along = n.x * journal.p.x + n.y * journal.p.y + n.z * journal.p.z;  // |p|
  return (n.y * journal.v.x - n.x * journal.v.y) / (along * calc_distance_from_other_pole(pole, n));
}

/// Friction of a contact point. @returns the force on the journal
template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE Vec3<V> rub(const FrictionParameters& law, const SurfacePoint<P>& point,
                                       const Vec3<V>& velocity, const V& f_n, const V& spin, const V* bristle,
                                       V* bristle_rate, JointLoad<V>& load) {
  const V v_t = dot(point.t, velocity), v_s = dot(point.s, velocity);
  const FrictionForce<V> friction = calc_friction(law, v_t, v_s, bristle[0], bristle[1]);
  const V f_t = f_n * friction.along_t.force_ratio, f_s = f_n * friction.along_z.force_ratio;
  load.friction_sum += sqrt(value_of(f_t) * value_of(f_t) + value_of(f_s) * value_of(f_s));
  load.friction_power += f_t * v_t + f_s * v_s;
  bristle_rate[0] = friction.along_t.rate + spin * bristle[1];
  bristle_rate[1] = friction.along_z.rate - spin * bristle[0];
  return -(f_t * point.t + f_s * point.s);
}

/// Adds the load of one contact, and sets the rates of its bristles. The stiffness is Hertz's, K delta^1.5.
template <typename P, typename V, typename Load>
RPSUP_INLINE void add_point_contact(const PointContacts& contacts, const RelativeMotion<P, V>& journal, int i,
                                    const V* bristles, V* bristle_rates, Load& load) {
  const ClearanceParameters& joint = contacts.parameters();
  V* rates = bristle_rates + 2 * i;
  rates[0] = rates[1] = V(0.0);
  const SurfacePoint<P> point = locate_contact(contacts, journal, i);
  if (!(value_of(point.delta) > 0.0)) return;
  const Vec3<V> velocity = journal.calc_velocity(point.r);
  const V rate = dot(point.n, velocity);
  const P elastic = joint.K * (point.delta * sqrt(point.delta));
  const V onset = choose_onset_rate(contacts.latch(i).rate(), rate, joint.minimum_onset_rate);
  const NormalForce<V> normal = calc_normal_force(elastic, rate, onset, joint.chi, joint.damping);
  Vec3<V> force = -(normal.total * point.n);
  if (joint.friction) {
    const bool is_ball = joint.geometry == ContactGeometry::kBallInSocket;
    const V spin = is_ball ? calc_tangent_spin(contacts.pole(), journal, point.n) : V(0.0);
    force += rub(*joint.friction, point, velocity, normal.total, spin, bristles + 2 * i, rates, load);
  }
  load.add_force(point.r, force);
  load.radial_normal_sum += value_of(normal.total);
  load.impact_power += normal.loss_power;
  load.elastic_energy += 0.4 * value_of(elastic) * value_of(point.delta);
  load.max_penetration = std::max(load.max_penetration, value_of(point.delta));
  load.end_contact_point(2 * i);
}

/// Contact of a ball with its socket, or of a block with its slot. (static: see add_elements.)
/// @tparam Load  a JointLoad<V>
template <typename P, typename V, typename Load>
[[gnu::noinline]] static void add_point_contacts(const PointContacts& contacts,
                                                 const RelativeMotion<P, V>& journal, const V* bristles,
                                                 V* bristle_rates, Load& load) {
  for (int i = 0; i < contacts.count(); ++i)
    add_point_contact(contacts, journal, i, bristles, bristle_rates, load);
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
