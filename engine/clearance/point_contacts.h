// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "engine/clearance/clearance_parameters.h"
#include "engine/clearance/journal_motion.h"
#include "engine/clearance/normal_force.h"

namespace engine {

/// Contacts of a ball in a socket, or of a block's corners with the walls of a slot: where each may occur,
/// and what it remembers. The law: point_contacts_law.h.
class PointContacts {
 public:
  /// A corner and one of the two walls that it may touch.
  struct Corner {
    Vec3<double> at;     ///< in {j}, [m]
    int axis = 0;        ///< normal of the wall in {b}: 0 along x, 1 along y
    double side = 1.0;   ///< +1 or -1: the wall's side
    double reach = 0.0;  ///< distance of the wall from the slot's middle, [m]
  };

  explicit PointContacts(const ClearanceParameters& joint);

  [[nodiscard]] const ClearanceParameters& parameters() const { return joint_; }
  /// Number of contacts that may occur: one of a ball, 16 of a block.
  [[nodiscard]] int count() const { return static_cast<int>(latches_.size()); }
  [[nodiscard]] const Corner& corner(int i) const { return corners_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const OnsetLatch& latch(int i) const { return latches_[static_cast<std::size_t>(i)]; }
  /// +1 or -1: the pole of the socket, on its axis, around which the tangents are smooth.
  [[nodiscard]] double pole() const { return pole_; }
  /// Bristle components in the state: two a contact.
  [[nodiscard]] int bristle_count() const { return 2 * count(); }

  /// Appends the penetration of each contact.
  void add_penetrations(const JournalMotion& journal, std::vector<Penetration>& contacts) const;

  /// Before a step: takes the other pole for the tangents where the ball is nearer to it. @returns true if so
  bool follow(const JournalMotion& journal, double* bristles);

  /// Takes note of contacts that began or ended in a step; a bristle is relaxed where its contact has ended.
  ContactChange advance(const JournalMotion& start, const JournalMotion& end, double dt, double* bristles);

 private:
  [[nodiscard]] Penetration calc_penetration(const RelativeMotion<double, double>& journal, int i) const;

  ClearanceParameters joint_;
  std::vector<Corner> corners_;
  std::vector<OnsetLatch> latches_;
  double pole_ = 1.0;
};

}  // namespace engine
