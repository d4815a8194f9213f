// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "engine/clearance/clearance_parameters.h"
#include "engine/clearance/journal_motion.h"
#include "engine/clearance/normal_force.h"

namespace engine {

/// The paper's radial contact elements: what each of the n_ce points on each ring of the journal remembers.
/// The law: elements_law.h.
///
/// Bristles exist for a window of elements about the arc that can touch, which follows the contact between
/// steps; an element that touches outside it is reported as missed, and the caller widens the window and
/// takes the step again.
class RadialElements {
 public:
  explicit RadialElements(const ClearanceParameters& joint);

  [[nodiscard]] const ClearanceParameters& parameters() const { return joint_; }
  [[nodiscard]] double element_stiffness() const { return element_stiffness_; }  ///< s, [N/m]
  [[nodiscard]] double element_damping() const {
    return element_damping_;
  }                                                                       ///< Kelvin and Voigt's d, [N s/m]
  [[nodiscard]] double spacing() const { return spacing_; }               ///< angle between elements, [rad]
  [[nodiscard]] const double* cosines() const { return cosine_.data(); }  ///< of each element's angle in {j}
  [[nodiscard]] const double* sines() const { return sine_.data(); }
  [[nodiscard]] int wrap(int k) const {
    const int remainder = k % joint_.n_ce;
    return remainder < 0 ? remainder + joint_.n_ce : remainder;
  }
  [[nodiscard]] const OnsetLatch& latch(int ring, int k) const {
    return latches_.data()[ring * joint_.n_ce + k];
  }
  [[nodiscard]] int bristle_count() const { return 2 * joint_.n_r * window_; }
  /// Index of an element's first bristle among them, -1 if it has none.
  [[nodiscard]] int bristle_index(int ring, int k) const {
    const int slot = wrap(k - first_.data()[ring]);
    return slot < window_ ? 2 * (ring * window_ + slot) : -1;
  }

  /// @returns whether the numbers of `count` elements from k on are contiguous, those of their bristles, too
  [[nodiscard]] bool are_side_by_side(int ring, int k, int count) const {
    const int slot = wrap(k - first_.data()[ring]);
    return k + count <= joint_.n_ce && slot + count <= window_;
  }

  /// Appends the penetration of each ring's deepest element.
  void add_penetrations(const JournalMotion& journal, std::vector<Penetration>& rings) const;

  /// Takes note of contacts that began or ended in a step; a bristle is relaxed where its contact has ended.
  ContactChange advance(const JournalMotion& start, const JournalMotion& end, double dt, double* bristles);

  /// Moves the windows to where the journal will be after dt. Elements in contact stay inside. @returns true
  /// if any window moved
  bool follow(const JournalMotion& journal, double dt, double* bristles);

  /// Makes the windows half as large again. @returns the bristles at their new indices
  [[nodiscard]] Eigen::VectorXd widen(const double* bristles);

 private:
  [[nodiscard]] Penetration calc_penetration(const RelativeMotion<double, double>& journal, int ring,
                                             int k) const;
  [[nodiscard]] double find_direction(const RelativeMotion<double, double>& journal, int ring) const;
  [[nodiscard]] OnsetLatch& latch(int ring, int k) {
    return latches_[static_cast<std::size_t>(ring * joint_.n_ce + k)];
  }
  [[nodiscard]] int element_of(int ring, int slot) const {
    return wrap(first_[static_cast<std::size_t>(ring)] + slot);
  }
  [[nodiscard]] int limit_shift(int ring, int shift);
  void shift_window(int ring, int shift, double* bristles);

  ClearanceParameters joint_;
  double element_stiffness_, element_damping_;
  double spacing_;
  int window_;                      ///< elements with a bristle, on each ring
  std::vector<int> first_;          ///< of each ring's window
  std::vector<double> cosine_, sine_;
  std::vector<OnsetLatch> latches_; ///< n_r x n_ce
};

}  // namespace engine
