#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/clearance/contact_law.h"
#include "engine/clearance/radial_elements.h"
#include "engine/math/finite.h"

namespace engine {
inline namespace RPSUP_INSTRUCTION_SET {

/// Half the arc of the journal that can lie outside the bore when its centre is at distance e: |e + r_j u|^2 > r_b^2.
/// @returns < 0 if none can
[[nodiscard]] RPSUP_INLINE double calc_half_arc(const ClearanceParameters& joint, double distance_squared, double distance_in_ring_plane) {
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
[[nodiscard]] RPSUP_INLINE OffsetInJournal calc_offset_in_journal(const RelativeMotion<P, V>& journal, const Vec3<P>& axial) {
  const double e_x = value_of(journal.p.x) + value_of(axial.x);
  const double e_y = value_of(journal.p.y) + value_of(axial.y);
  return {e_x * e_x + e_y * e_y, value_of(journal.R.x.x) * e_x + value_of(journal.R.x.y) * e_y,
          value_of(journal.R.y.x) * e_x + value_of(journal.R.y.y) * e_y};
}

/// Direction of a ring's offset as an angle in {j}.
template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE double calc_offset_direction(const RelativeMotion<P, V>& journal, const Vec3<P>& axial) {
  const OffsetInJournal offset = calc_offset_in_journal(journal, axial);
  return std::atan2(offset.along_y, offset.along_x);
}

/// One element of a ring: its place, its normal, its penetration Delta = rho - r_b.
template <typename P>
struct ElementPlace {
  Vec3<P> r;        ///< from the journal centre
  P n_x, n_y;
  P delta;
};

template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE ElementPlace<P> place_element(const RadialElements& elements, const RelativeMotion<P, V>& journal, const Vec3<P>& axial,
                                                         int k) {
  const ClearanceParameters& joint = elements.parameters();
  const double r_j = joint.r_j();
  ElementPlace<P> element;
  element.r = axial + (r_j * elements.cosines()[k]) * journal.R.x + (r_j * elements.sines()[k]) * journal.R.y;
  const P x = journal.p.x + element.r.x;
  const P y = journal.p.y + element.r.y;
  const P rho = sqrt(x * x + y * y);
  const P inverse = 1.0 / rho;
  element.n_x = inverse * x;
  element.n_y = inverse * y;
  element.delta = rho - joint.r_b;
  return element;
}

template <typename P, typename V>
[[nodiscard]] RPSUP_INLINE V calc_element_rate(const RelativeMotion<P, V>& journal, const ElementPlace<P>& element) {
  const Vec3<V> velocity = journal.calc_velocity(element.r);
  return element.n_x * velocity.x + element.n_y * velocity.y;
}

/// The paper's radial contact elements: n_ce points on each ring of the journal, each with its own spring, latch and bristle.
///
///     Delta = rho - r_b,  f_e = s Delta,  s = K / n_r * 3 sqrt(c_r) / (4 sqrt 2) * 2 pi / n_ce
///
/// Only elements on the arc that can touch are looked at. @returns false if one touched that has no bristle in the state
/// @tparam Load  a JointLoad<V>
/// static: the linker would share it between files that are compiled with other rules for numbers that are none.
template <typename P, typename V, typename Load>
[[nodiscard, gnu::noinline]] static bool add_elements(const RadialElements& elements, const RelativeMotion<P, V>& journal, const V* bristles,
                                               V* bristle_rates, Load& load) {
  const ClearanceParameters& joint = elements.parameters();
  const double stiffness = elements.element_stiffness();
  const int count = elements.bristle_count();
  for (int b = 0; b < count; ++b) bristle_rates[b] = V(0.0);
  bool inside = true;
  for (int i = 0; i < joint.n_r; ++i) {
    const Vec3<P> axial = calc_ring_position(joint, i) * journal.R.z;
    const OffsetInJournal offset = calc_offset_in_journal(journal, axial);
    const double half = calc_half_arc(joint, offset.squared, std::sqrt(offset.along_x * offset.along_x + offset.along_y * offset.along_y));
    if (half < 0.0 || !is_number(half)) continue;
    const double direction = std::atan2(offset.along_y, offset.along_x);
    const int low = static_cast<int>(std::ceil((direction - half) / elements.spacing()));
    const int high = std::min(low + joint.n_ce - 1, static_cast<int>(std::floor((direction + half) / elements.spacing())));
    for (int unwrapped = low; unwrapped <= high; ++unwrapped) {
      const int k = elements.wrap(unwrapped);
      const ElementPlace<P> element = place_element(elements, journal, axial, k);
      if (!(value_of(element.delta) > 0.0)) continue;
      const int place = elements.place_of_bristle(i, k);
      inside = inside && place >= 0;
      const V rate = calc_element_rate(journal, element);
      const P elastic = stiffness * element.delta;
      const V onset = choose_onset_rate(elements.latch(i, k).rate(), rate, joint.minimum_onset_rate);
      add_touch(joint, journal, Touch<P, V>{element.r, element.n_x, element.n_y, calc_normal_law(elastic, rate, onset, joint.chi, 0.0)},
                place < 0 ? nullptr : bristles + place, place < 0 ? nullptr : bristle_rates + place, load);
      load.elastic_energy += 0.5 * value_of(elastic) * value_of(element.delta);
      load.max_penetration = std::max(load.max_penetration, value_of(element.delta));
      if (place >= 0) load.close_touch(place);
    }
  }
  return inside;
}

}  // namespace RPSUP_INSTRUCTION_SET
}  // namespace engine
