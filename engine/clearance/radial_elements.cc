#include "engine/clearance/radial_elements.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace engine {

namespace {

/// Half the arc of the journal that can lie outside the bore when its centre is at distance e: |e + r_j u|^2 > r_b^2.
/// @returns < 0 if none can
double calc_half_arc(const ClearanceParameters& joint, double distance, double distance_in_ring_plane) {
  const double r_j = joint.r_j();
  const double needed = joint.c_r * (2.0 * r_j + joint.c_r) - distance * distance;  // r_b^2 - r_j^2 - e^2
  if (needed >= 2.0 * r_j * distance_in_ring_plane) return -1.0;
  if (needed <= -2.0 * r_j * distance_in_ring_plane) return std::numbers::pi;
  return std::acos(needed / (2.0 * r_j * distance_in_ring_plane));
}

/// A window that holds contacts of 20 micrometres depth, more than any metal joint of this size survives, with two elements to spare.
int calc_first_window(const ClearanceParameters& joint) {
  const double distance = joint.c_r + 20e-6;
  const double half = calc_half_arc(joint, distance, distance) * joint.n_ce / (2.0 * std::numbers::pi);
  return std::min(joint.n_ce, 2 * static_cast<int>(std::ceil(half)) + 5);
}

}  // namespace

RadialElements::RadialElements(const ClearanceParameters& joint)
    : joint_(joint),
      element_stiffness_(joint.K / joint.n_r * 3.0 * std::sqrt(joint.c_r) / (4.0 * std::numbers::sqrt2) * 2.0 * std::numbers::pi / joint.n_ce),
      spacing_(2.0 * std::numbers::pi / joint.n_ce),
      window_(calc_first_window(joint)),
      first_(static_cast<std::size_t>(joint.n_r), 0),
      latches_(static_cast<std::size_t>(joint.n_r) * static_cast<std::size_t>(joint.n_ce)) {
  for (int k = 0; k < joint.n_ce; ++k) {
    cosine_.push_back(std::cos(spacing_ * k));
    sine_.push_back(std::sin(spacing_ * k));
  }
}

RadialElements::Ring RadialElements::calc_ring(const JournalMotion& journal, int ring) const {
  Ring result;
  result.axial = ring_position(joint_, ring) * journal.R_bj.col(2);
  const Eigen::Vector3d centre = journal.p_bj + result.axial;
  const Eigen::Vector3d offset(centre.x(), centre.y(), 0.0);
  const Eigen::Vector3d offset_j = journal.R_bj.transpose() * offset;
  result.direction = std::atan2(offset_j.y(), offset_j.x());
  result.half_arc = calc_half_arc(joint_, offset.norm(), offset_j.head<2>().norm());
  return result;
}

RadialElements::Element RadialElements::calc_element(const JournalMotion& journal, const Ring& ring, int k) const {
  const auto i = static_cast<std::size_t>(k);
  Element element;
  element.r = ring.axial + joint_.r_j() * (cosine_[i] * journal.R_bj.col(0) + sine_[i] * journal.R_bj.col(1));
  const Eigen::Vector3d point = journal.p_bj + element.r;
  const double rho = std::hypot(point.x(), point.y());
  element.n = Eigen::Vector3d(point.x(), point.y(), 0.0) / rho;
  element.penetration = {rho - joint_.r_b, element.n.dot(journal.calc_velocity(element.r))};
  return element;
}

bool RadialElements::calc(const JournalMotion& journal, const double* bristles, double* bristle_rates, ContactLoad& load) const {
  std::fill_n(bristle_rates, bristle_count(), 0.0);
  bool inside = true;
  for (int i = 0; i < joint_.n_r; ++i) {
    const Ring ring = calc_ring(journal, i);
    if (ring.half_arc < 0.0) continue;
    const int low = static_cast<int>(std::ceil((ring.direction - ring.half_arc) / spacing_));
    const int high = std::min(low + joint_.n_ce - 1, static_cast<int>(std::floor((ring.direction + ring.half_arc) / spacing_)));
    for (int unwrapped = low; unwrapped <= high; ++unwrapped) {
      const int k = wrap(unwrapped);
      const Element element = calc_element(journal, ring, k);
      const auto& [delta, rate] = element.penetration;
      if (!(delta > 0.0)) continue;
      const int slot = wrap(k - first_[static_cast<std::size_t>(i)]);
      inside = inside && slot < window_;
      const int at = slot < window_ ? 2 * (i * window_ + slot) : -1;
      const double onset = latch(i, k).onset_rate(rate, joint_.minimum_onset_rate);
      const NormalForce normal = calc_normal_force(element_stiffness_ * delta, rate, onset, joint_.chi);
      add_radial_touch(joint_, journal, {element.r, element.n, normal, rate}, at < 0 ? nullptr : bristles + at,
                       at < 0 ? nullptr : bristle_rates + at, load);
      load.elastic_energy += 0.5 * normal.elastic * delta;
      load.max_penetration = std::max(load.max_penetration, delta);
    }
  }
  return inside;
}

void RadialElements::add_penetrations(const JournalMotion& journal, std::vector<Penetration>& rings) const {
  for (int i = 0; i < joint_.n_r; ++i) {
    const Ring ring = calc_ring(journal, i);
    const int nearest = static_cast<int>(std::lround(ring.direction / spacing_));
    Penetration deepest = calc_element(journal, ring, wrap(nearest)).penetration;
    for (const int k : {nearest - 1, nearest + 1}) {  // in a tilted journal the deepest may be beside the nearest
      const Penetration other = calc_element(journal, ring, wrap(k)).penetration;
      if (other.delta > deepest.delta) deepest = other;
    }
    rings.push_back(deepest);
  }
}

ContactChange RadialElements::advance(const JournalMotion& start, const JournalMotion& end, double dt, double* bristles) {
  ContactChange change;
  for (int i = 0; i < joint_.n_r; ++i) {
    const Ring ring_start = calc_ring(start, i);
    const Ring ring_end = calc_ring(end, i);
    bool was_on = false;
    bool is_on = false;
    for (int slot = 0; slot < window_; ++slot) {
      const int k = element_of(i, slot);
      OnsetLatch& onset = latch(i, k);
      was_on = was_on || onset.in_contact();
      const Penetration at_end = calc_element(end, ring_end, k).penetration;
      if (onset.in_contact() || at_end.delta > 0.0)
        change.any |= onset.advance(calc_element(start, ring_start, k).penetration, at_end, dt, joint_.minimum_onset_rate);
      is_on = is_on || onset.in_contact();
      double* bristle = bristles + 2 * (i * window_ + slot);
      if (!onset.in_contact()) bristle[0] = bristle[1] = 0.0;
    }
    change.ring_onsets += is_on && !was_on ? 1 : 0;
  }
  return change;
}

bool RadialElements::follow(const JournalMotion& journal, double dt, double* bristles) {
  if (window_ == joint_.n_ce) return false;
  bool moved = false;
  JournalMotion later = journal;
  later.p_bj += dt * journal.v;
  for (int i = 0; i < joint_.n_r; ++i) {
    const int wanted = static_cast<int>(std::lround(calc_ring(later, i).direction / spacing_)) - window_ / 2;
    int shift = wrap(wanted - first_[static_cast<std::size_t>(i)]);
    if (shift > joint_.n_ce / 2) shift -= joint_.n_ce;
    if (std::abs(shift) <= window_ / 8) continue;
    shift_window(i, shift, bristles);
    moved = true;
  }
  return moved;
}

/// Moves a window by `shift` elements, or as far as no element in contact leaves it.
void RadialElements::shift_window(int ring, int shift, double* bristles) {
  int free = 0;
  while (free < window_ && !latch(ring, element_of(ring, shift > 0 ? free : window_ - 1 - free)).in_contact()) ++free;
  if (free < window_) shift = std::clamp(shift, -free, free);
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
  window_ = std::min(joint_.n_ce, 2 * window_);
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
