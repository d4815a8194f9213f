// SPDX-License-Identifier: Apache-2.0
#include "engine/clearance/radial_elements.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "engine/clearance/elements_law.h"

namespace engine {

namespace {

/// A window that holds contacts of 10 micrometres depth where it is centred, with two elements to spare. Few
/// runs go deeper, and they widen it; a larger one from the start would have every step carry bristles that
/// nothing touches.
int calc_first_window(const ClearanceParameters& joint) {
  const double distance = joint.c_r + 10e-6;
  const double half =
      calc_half_arc(joint, distance * distance, distance) * joint.n_ce / (2.0 * std::numbers::pi);
  return std::min(joint.n_ce, 2 * static_cast<int>(std::ceil(half)) + 5);
}

}  // namespace

RadialElements::RadialElements(const ClearanceParameters& joint)
    : joint_(joint),
      element_stiffness_(joint.K / joint.n_r * 3.0 * std::sqrt(joint.c_r) / (4.0 * std::numbers::sqrt2) *
                         2.0 * std::numbers::pi / joint.n_ce),
      element_damping_(joint.damping / (joint.n_r * joint.n_ce)),
      spacing_(2.0 * std::numbers::pi / joint.n_ce),
      window_(calc_first_window(joint)),
      first_(static_cast<std::size_t>(joint.n_r), 0),
      latches_(static_cast<std::size_t>(joint.n_r) * static_cast<std::size_t>(joint.n_ce)) {
  for (int k = 0; k < joint.n_ce; ++k) {
    cosine_.push_back(std::cos(spacing_ * k));
    sine_.push_back(std::sin(spacing_ * k));
  }
}

Penetration RadialElements::calc_penetration(const RelativeMotion<double, double>& journal, int ring,
                                             int k) const {
  const ElementPoint<double> element =
      calc_element_point(*this, journal, calc_ring_position(joint_, ring) * journal.R.z, k);
  return {element.delta, calc_element_rate(journal, element)};
}

/// The element, as an angle, that lies in the direction of the ring's offset.
double RadialElements::find_direction(const RelativeMotion<double, double>& journal, int ring) const {
  return calc_offset_direction(journal, calc_ring_position(joint_, ring) * journal.R.z);
}

void RadialElements::add_penetrations(const JournalMotion& journal, std::vector<Penetration>& rings) const {
  const RelativeMotion<double, double> motion = to_relative_motion(journal);
  for (int i = 0; i < joint_.n_r; ++i) {
    const int nearest = static_cast<int>(std::lround(find_direction(motion, i) / spacing_));
    Penetration deepest = calc_penetration(motion, i, wrap(nearest));
    for (const int k :
         {nearest - 1, nearest + 1}) {  // in a tilted journal the deepest may be beside the nearest
      const Penetration other = calc_penetration(motion, i, wrap(k));
      if (other.delta > deepest.delta) deepest = other;
    }
    rings.push_back(deepest);
  }
}

ContactChange RadialElements::advance(const JournalMotion& start, const JournalMotion& end, double dt,
                                      double* bristles) {
  const RelativeMotion<double, double> motion_start = to_relative_motion(start);
  const RelativeMotion<double, double> motion_end = to_relative_motion(end);
  ContactChange change;
  for (int i = 0; i < joint_.n_r; ++i) {
    const Vec3<double> axial = calc_ring_position(joint_, i) * motion_end.R.z;
    const ElementArc arc = find_arc(*this, motion_end, axial);
    bool was_on = false;
    bool is_on = false;
    int k = element_of(i, 0);
    int from_low = wrap(k - arc.low);  // distance of k from the arc's low end
    for (int slot = 0; slot < window_; ++slot) {
      OnsetLatch& onset = latch(i, k);
      double* bristle = bristles + 2 * (i * window_ + slot);
      if (onset.in_contact() || from_low <= arc.high - arc.low) {
        was_on = was_on || onset.in_contact();
        if ((calc_element_point(*this, motion_end, axial, k).delta > 0.0) != onset.in_contact())
          change.any |= onset.advance(calc_penetration(motion_start, i, k),
                                      calc_penetration(motion_end, i, k), dt, joint_.minimum_onset_rate);
        is_on = is_on || onset.in_contact();
      }
      if (!onset.in_contact()) bristle[0] = bristle[1] = 0.0;
      k = k + 1 < joint_.n_ce ? k + 1 : 0;
      from_low = from_low + 1 < joint_.n_ce ? from_low + 1 : 0;
    }
    change.abrupt |= is_on != was_on;
    change.ring_onsets += is_on && !was_on ? 1 : 0;
  }
  return change;
}

bool RadialElements::follow(const JournalMotion& journal, double dt, double* bristles) {
  if (window_ == joint_.n_ce) return false;
  bool moved = false;
  RelativeMotion<double, double> later = to_relative_motion(journal);
  later.p += dt * later.v;
  for (int i = 0; i < joint_.n_r; ++i) {
    const int centred = static_cast<int>(std::lround(find_direction(later, i) / spacing_)) - window_ / 2;
    int shift = wrap(centred - first_[static_cast<std::size_t>(i)]);
    if (shift > joint_.n_ce / 2) shift -= joint_.n_ce;
    if (std::abs(shift) <= window_ / 8) continue;
    shift_window(i, shift, bristles);
    moved = true;
  }
  return moved;
}

/// So much of a window's shift that no element in contact leaves it.
int RadialElements::limit_shift(int ring, int shift) {
  int free = 0;
  while (free < window_ && !latch(ring, element_of(ring, shift > 0 ? free : window_ - 1 - free)).in_contact())
    ++free;
  return free < window_ ? std::clamp(shift, -free, free) : shift;
}

/// Moves a window by `shift` elements, or as far as no element in contact leaves it.
void RadialElements::shift_window(int ring, int shift, double* bristles) {
  shift = limit_shift(ring, shift);
  int& first = first_[static_cast<std::size_t>(ring)];
  first = wrap(first + shift);
  double* begin = bristles + 2 * ring * window_;
  double* end = begin + 2 * window_;
  const int kept = std::max(0, window_ - std::abs(shift));
  if (shift > 0) {
    std::copy(end - 2 * kept, end, begin);
    std::fill(begin + 2 * kept, end, 0.0);
  } else {
    std::copy_backward(begin, begin + 2 * kept, end);
    std::fill(begin, end - 2 * kept, 0.0);
  }
}

Eigen::VectorXd RadialElements::widen(const double* bristles) {
  const int before = window_;
  window_ = std::min(joint_.n_ce, 3 * window_ / 2);
  Eigen::VectorXd wide = Eigen::VectorXd::Zero(bristle_count());
  const int margin = (window_ - before) / 2;
  for (int i = 0; i < joint_.n_r; ++i) {
    int& first = first_[static_cast<std::size_t>(i)];
    first = wrap(first - margin);
    std::copy_n(bristles + 2 * i * before, 2 * before, wide.data() + 2 * (i * window_ + margin));
  }
  return wide;
}

}  // namespace engine
