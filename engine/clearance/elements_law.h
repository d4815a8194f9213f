// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>

#include "engine/clearance/contact_law.h"
#include "engine/clearance/radial_elements.h"
#include "engine/math/finite.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Half the arc of the journal that can lie outside the bore when its centre is at distance e: |e + r_j u|^2
/// > r_b^2.
/// @returns < 0 if none can
[[nodiscard]] RPSUP_INLINE double calc_half_arc(const ClearanceParameters& joint, double distance_squared,
                                                double distance_in_ring_plane) {
  const double r_j = joint.r_j();
  const double needed = joint.c_r * (2.0 * r_j + joint.c_r) - distance_squared;  // r_b^2 - r_j^2 - e^2
  if (needed >= 2.0 * r_j * distance_in_ring_plane) return -1.0;
  if (needed <= -2.0 * r_j * distance_in_ring_plane) return std::numbers::pi;
  return std::acos(needed / (2.0 * r_j * distance_in_ring_plane));
}

/// The offset of a ring's centre from the bearing's axis.
struct OffsetInJournal {
  double squared;             ///< of its length
  double along_x, along_y;    ///< along the journal's axes
};

/// @param axial  from the journal centre to the ring's, in {b}
template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE OffsetInJournal calc_offset_in_journal(const RelativeMotion<P, V>& journal,
                                                                  const Vec3<P>& axial) {
  const double e_x = value_of(journal.p.x) + value_of(axial.x);
  const double e_y = value_of(journal.p.y) + value_of(axial.y);
  return {e_x * e_x + e_y * e_y, value_of(journal.R.x.x) * e_x + value_of(journal.R.x.y) * e_y,
          value_of(journal.R.y.x) * e_x + value_of(journal.R.y.y) * e_y};
}

/// Direction of a ring's offset as an angle in {j}.
template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE double calc_offset_direction(const RelativeMotion<P, V>& journal,
                                                        const Vec3<P>& axial) {
  const OffsetInJournal offset = calc_offset_in_journal(journal, axial);
  return std::atan2(offset.along_y, offset.along_x);
}

/// One element of a ring, or several side by side: the point, the normal, the penetration Delta = rho -
/// r_b.
template <typename P>
struct ElementPoint {
  Vec3<P> r;        ///< from the journal centre
  P n_x, n_y;
  P delta;
};

/// @param cosine, sine  of the element's angle in {j}
template <typename P, typename V, typename Angle>
[[nodiscard]] RPSUP_INLINE ElementPoint<Mixed<Angle, P>> calc_element_point(const ClearanceParameters& joint,
                                                                       const RelativeMotion<P, V>& journal,
                                                                       const Vec3<P>& axial,
                                                                       const Angle& cosine,
                                                                       const Angle& sine) {
  const double r_j = joint.r_j();
  ElementPoint<Mixed<Angle, P>> element;
  element.r = axial + (r_j * cosine) * journal.R.x + (r_j * sine) * journal.R.y;
  const auto x = journal.p.x + element.r.x;
  const auto y = journal.p.y + element.r.y;
  const auto rho = sqrt(x * x + y * y);
  const auto inverse = 1.0 / rho;
  element.n_x = inverse * x;
  element.n_y = inverse * y;
  element.delta = rho - joint.r_b;
  return element;
}
template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE ElementPoint<P> calc_element_point(const RadialElements& elements,
                                                         const RelativeMotion<P, V>& journal,
                                                         const Vec3<P>& axial, int k) {
  return calc_element_point(elements.parameters(), journal, axial, elements.cosines()[k],
                            elements.sines()[k]);
}

template <typename P, typename V, typename Point>
[[nodiscard]] RPSUP_INLINE Mixed<V, Point> calc_element_rate(const RelativeMotion<P, V>& journal,
                                                             const ElementPoint<Point>& element) {
  const auto velocity = journal.calc_velocity(element.r);
  return element.n_x * velocity.x + element.n_y * velocity.y;
}

/// The elements of a ring that can touch, by their angles: from low to high, which may be beyond a full
/// revolution. low > high if none can.
struct ElementArc {
  int low, high;
};

template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE ElementArc find_arc(const RadialElements& elements,
                                               const RelativeMotion<P, V>& journal, const Vec3<P>& axial) {
  const ClearanceParameters& joint = elements.parameters();
  const OffsetInJournal offset = calc_offset_in_journal(journal, axial);
  const double half = calc_half_arc(
      joint, offset.squared, std::sqrt(offset.along_x * offset.along_x + offset.along_y * offset.along_y));
  if (half < 0.0 || !is_number(half)) return {0, -1};
  const double direction = std::atan2(offset.along_y, offset.along_x);
  const int low = static_cast<int>(std::ceil((direction - half) / elements.spacing()));
  return {low, std::min(low + joint.n_ce - 1,
                        static_cast<int>(std::floor((direction + half) / elements.spacing())))};
}

/// Adds the load of one element if it touches. @returns false if it does and has no bristle in the state
template <typename P, typename V, typename Load>
RPSUP_INLINE bool add_element(const RadialElements& elements, const RelativeMotion<P, V>& journal,
                              const Vec3<P>& axial, int ring, int k, const V* bristles, V* bristle_rates,
                              Load& load) {
  const ClearanceParameters& joint = elements.parameters();
  const ElementPoint<P> element = calc_element_point(elements, journal, axial, k);
  if (!(value_of(element.delta) > 0.0)) return true;
  const int bristle = elements.bristle_index(ring, k);
  const V rate = calc_element_rate(journal, element);
  const P elastic = elements.element_stiffness() * element.delta;
  const V onset = choose_onset_rate(elements.latch(ring, k).rate(), rate, joint.minimum_onset_rate);
  add_contact_point(
      joint, journal,
      ContactPoint<P, V>{element.r, element.n_x, element.n_y,
                         calc_normal_force(elastic, rate, onset, joint.chi, elements.element_damping())},
      bristle < 0 ? nullptr : bristles + bristle, bristle < 0 ? nullptr : bristle_rates + bristle, load);
  load.elastic_energy += 0.5 * value_of(elastic) * value_of(element.delta);
  load.max_penetration = std::max(load.max_penetration, value_of(element.delta));
  if (bristle >= 0) load.end_contact_point(bristle);
  return bristle >= 0;
}

/// Eight neighbours on a ring side by side, the first of them k, with bristles from `bristle` on. Those that
/// do not touch add zeros.
RPSUP_INLINE void add_neighbours(const RadialElements& elements,
                                 const RelativeMotion<double, double>& journal, const Vec3<double>& axial,
                                 int ring, int k, int bristle, const double* bristles, double* bristle_rates,
                                 JointLoad<Lanes>& load) {
  const ClearanceParameters& joint = elements.parameters();
  const ElementPoint<Lanes> element = calc_element_point(
      joint, journal, axial, Lanes::load(elements.cosines() + k), Lanes::load(elements.sines() + k));
  const Lanes none{};
  const Lanes delta = cut_at_zero(element.delta);
  const Lanes rate = calc_element_rate(journal, element);
  const Lanes elastic = elements.element_stiffness() * delta;
  const Lanes onset =
      choose_onset_rate(Lanes::load(&elements.latch(ring, k)), rate, joint.minimum_onset_rate);
  const LanePairs pairs = LanePairs::load(bristles + bristle);
  const Lanes z[2] = {pairs.first, pairs.second};
  Lanes rates[2] = {none, none};
  NormalForce<Lanes> normal = calc_normal_force(elastic, rate, onset, joint.chi, elements.element_damping());
  if (elements.element_damping() > 0.0)
    normal = {choose_greater(element.delta, none, normal.total, none),
              choose_greater(element.delta, none, normal.loss_power, none)};
  add_contact_point(joint, journal, ContactPoint<Lanes, Lanes>{element.r, element.n_x, element.n_y, normal},
                    z, rates, load);
  load.elastic_energy += 0.5 * (elastic * delta);
  load.max_penetration = choose_greater(delta, load.max_penetration, delta, load.max_penetration);
  LanePairs{choose_greater(delta, none, rates[0], none), choose_greater(delta, none, rates[1], none)}.store(
      bristle_rates + bristle);
}

/// Adds the sums over eight contact points.
RPSUP_INLINE void add_sums(const JointLoad<Lanes>& of, JointLoad<double>& load) {
  load.force += Vec3<double>{sum(of.force.x), sum(of.force.y), sum(of.force.z)};
  load.moment += Vec3<double>{sum(of.moment.x), sum(of.moment.y), sum(of.moment.z)};
  load.impact_power += sum(of.impact_power);
  load.friction_power += sum(of.friction_power);
  load.radial_normal_sum += sum(of.radial_normal_sum);
  load.friction_sum += sum(of.friction_sum);
  load.max_penetration = std::max(load.max_penetration, find_largest(of.max_penetration));
  load.elastic_energy += sum(of.elastic_energy);
}

/// Forces of an arc's elements, eight side by side. Elements are taken one by one where the numbers of eight
/// are not contiguous, or eight would go around the ring. None touches outside the arc.
RPSUP_INLINE bool add_arc_abreast(const RadialElements& elements,
                                  const RelativeMotion<double, double>& journal, const Vec3<double>& axial,
                                  int ring, const ElementArc& arc, const double* bristles,
                                  double* bristle_rates, JointLoad<double>& load) {
  bool inside = true;
  JointLoad<Lanes> abreast;
  bool any_abreast = false;
  for (int unwrapped = arc.low; unwrapped <= arc.high;) {
    const int k = elements.wrap(unwrapped);
    const bool fit = unwrapped + Lanes::kCount <= arc.low + elements.parameters().n_ce;
    if (fit && elements.are_side_by_side(ring, k, Lanes::kCount)) {
      add_neighbours(elements, journal, axial, ring, k, elements.bristle_index(ring, k), bristles,
                     bristle_rates, abreast);
      any_abreast = true;
      unwrapped += Lanes::kCount;
    } else {
      inside = add_element(elements, journal, axial, ring, k, bristles, bristle_rates, load) && inside;
      ++unwrapped;
    }
  }
  if (any_abreast) add_sums(abreast, load);
  return inside;
}

/// The paper's radial contact elements: n_ce points on each ring of the journal, each with its own spring,
/// damper, latch and bristle, Eq. (11.1):
///
///     Delta = rho - r_b,  f_n = s Delta + d Delta',  s = K / n_r * 3 sqrt(c_r) / (4 sqrt 2) * 2 pi / n_ce
///
/// with d = s chi Delta / Delta'_onset, or by Kelvin and Voigt's law the constant share d = damping / (n_r
/// n_ce): only the shares of the elements that touch act, fewer in a light contact, where a continuum's ring
/// has its whole damper.
///
/// Only elements on the arc that can touch are looked at. @returns false if one touched that has no bristle
/// in the state
/// @tparam Load  a JointLoad<V>
/// @param bristle_rates  where they go: numbers all of them, numbers with derivatives those of the elements
///                       that touch
/// static: the linker would share it between files that are compiled with other rules for numbers that are
/// none.
template <typename P, typename V, typename Load>
[[nodiscard, gnu::noinline]] static bool add_elements(const RadialElements& elements,
                                                      const RelativeMotion<P, V>& journal, const V* bristles,
                                                      V* bristle_rates, Load& load) {
  constexpr bool kPlain = std::is_same_v<V, double>;
  if constexpr (kPlain)
    for (int b = 0; b < elements.bristle_count(); ++b) bristle_rates[b] = 0.0;
  bool inside = true;
  for (int ring = 0; ring < elements.parameters().n_r; ++ring) {
    const Vec3<P> axial = calc_ring_position(elements.parameters(), ring) * journal.R.z;
    const ElementArc arc = find_arc(elements, journal, axial);
    if constexpr (kPlain) {
      inside = add_arc_abreast(elements, journal, axial, ring, arc, bristles, bristle_rates, load) && inside;
    } else {
      for (int k = arc.low; k <= arc.high; ++k)
        inside &=
            add_element(elements, journal, axial, ring, elements.wrap(k), bristles, bristle_rates, load);
    }
  }
  return inside;
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
