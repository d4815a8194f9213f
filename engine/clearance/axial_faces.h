#pragma once

#include <vector>

#include <Eigen/Core>

#include "engine/clearance/clearance_parameters.h"
#include "engine/clearance/journal_motion.h"
#include "engine/clearance/normal_force.h"

namespace engine {

/// Contact of the journal's two faces with the bearing's shoulders: points on circles, no friction.
///
///     delta = +-z_b - (L_b / 2 + c_a),  f = K_a / (points of a face) delta (1 + chi rate / rate_onset)
class AxialFaces {
 public:
  explicit AxialFaces(const ClearanceParameters& joint);

  void calc(const JournalMotion& journal, ContactLoad& load) const;

  /// Takes note of contacts that began or ended in a step. @returns true if any did
  bool advance(const JournalMotion& start, const JournalMotion& end, double dt);

 private:
  /// Calls visit(point, side, delta) for every point of both faces; side is +1 or -1.
  template <typename Visit>
  void for_each_point(const JournalMotion& journal, const Visit& visit) const;
  [[nodiscard]] Penetration calc_penetration(const JournalMotion& journal, std::size_t point, double side, double delta) const;

  ClearanceParameters joint_;
  double point_stiffness_;                ///< [N/m]
  std::vector<Eigen::Vector3d> points_;   ///< of the face at +z in {j}, then of the one at -z, [m]
  std::vector<OnsetLatch> latches_;
};

}  // namespace engine
