#pragma once

#include <vector>

#include <Eigen/Core>

#include "engine/clearance/radial_contact.h"

namespace engine {

/// The paper's radial contact elements: n_ce points on each ring of the journal, each with its own spring, latch and bristle.
///
///     Delta = rho - r_b,  f_e = s Delta,  s = K / n_r * 3 sqrt(c_r) / (4 sqrt 2) * 2 pi / n_ce
///
/// Only elements that can touch are looked at: the journal's offset e leaves an arc about its own direction. Bristles exist for a window
/// of elements about that arc, which follows the contact between steps; an element that touches outside it is reported as missed, and the
/// caller widens the window and takes the step again.
class RadialElements {
 public:
  explicit RadialElements(const ClearanceParameters& joint);

  [[nodiscard]] int bristle_count() const { return 2 * joint_.n_r * window_; }

  /// Adds the contact's load. @returns false if an element outside the window touched
  [[nodiscard]] bool calc(const JournalMotion& journal, const double* bristles, double* bristle_rates, ContactLoad& load) const;

  /// Appends the penetration of each ring's deepest element.
  void add_penetrations(const JournalMotion& journal, std::vector<Penetration>& rings) const;

  /// Takes note of contacts that began or ended in a step; a bristle is relaxed where its contact has ended.
  ContactChange advance(const JournalMotion& start, const JournalMotion& end, double dt, double* bristles);

  /// Moves the windows to where the journal will be after dt. Elements in contact stay inside. @returns true if any window moved
  bool follow(const JournalMotion& journal, double dt, double* bristles);

  /// Doubles the windows. @returns the bristles in their new places
  [[nodiscard]] Eigen::VectorXd widen(const double* bristles);

 private:
  /// One ring seen in the bearing's cross-section, with the arc of the journal that can touch.
  struct Ring {
    Eigen::Vector3d axial;   ///< journal centre to ring centre
    double direction;        ///< of the offset e, as an angle in {j}
    double half_arc;         ///< beside it elements can touch; < 0: none can
  };
  struct Element {
    Eigen::Vector3d r;       ///< from the journal centre
    Eigen::Vector3d n;
    Penetration penetration;
  };

  [[nodiscard]] Ring calc_ring(const JournalMotion& journal, int ring) const;
  [[nodiscard]] Element calc_element(const JournalMotion& journal, const Ring& ring, int k) const;
  [[nodiscard]] int wrap(int k) const { return ((k % joint_.n_ce) + joint_.n_ce) % joint_.n_ce; }
  [[nodiscard]] OnsetLatch& latch(int ring, int k) { return latches_[static_cast<std::size_t>(ring * joint_.n_ce + k)]; }
  [[nodiscard]] const OnsetLatch& latch(int ring, int k) const { return latches_[static_cast<std::size_t>(ring * joint_.n_ce + k)]; }
  [[nodiscard]] int element_of(int ring, int slot) const { return wrap(first_[static_cast<std::size_t>(ring)] + slot); }
  void shift_window(int ring, int shift, double* bristles);

  ClearanceParameters joint_;
  double element_stiffness_;        ///< s, [N/m]
  double spacing_;                  ///< angle between elements, [rad]
  int window_;                      ///< elements with a bristle, on each ring
  std::vector<int> first_;          ///< of each ring's window
  std::vector<double> cosine_, sine_;
  std::vector<OnsetLatch> latches_; ///< n_r x n_ce
};

}  // namespace engine
