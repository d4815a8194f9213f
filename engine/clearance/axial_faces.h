#pragma once

#include <vector>

#include "engine/clearance/clearance_parameters.h"
#include "engine/clearance/journal_motion.h"
#include "engine/clearance/normal_force.h"

namespace engine {

/// A contact point of a journal's face, in {j}.
struct FacePoint {
  double x, y, z;  ///< [m]
  double side;     ///< +1: of the face at +z; -1
};

/// Contact of the journal's two faces with the bearing's shoulders: what each point remembers. The law: faces_law.h.
class AxialFaces {
 public:
  explicit AxialFaces(const ClearanceParameters& joint);

  [[nodiscard]] const ClearanceParameters& parameters() const { return joint_; }
  [[nodiscard]] const FacePoint* points() const { return points_.data(); }
  [[nodiscard]] const OnsetLatch* latches() const { return latches_.data(); }  ///< one a point
  [[nodiscard]] int point_count() const { return static_cast<int>(points_.size()); }
  [[nodiscard]] double point_stiffness() const { return point_stiffness_; }    ///< [N/m]
  [[nodiscard]] double limit() const { return 0.5 * joint_.L_b + joint_.c_a; } ///< how far from the bearing's middle a point touches, [m]

  /// Takes note of contacts that began or ended in a step. @returns true if any did
  bool advance(const JournalMotion& start, const JournalMotion& end, double dt);

 private:
  ClearanceParameters joint_;
  double point_stiffness_;
  std::vector<FacePoint> points_;  ///< of the face at +z, then of the one at -z
  std::vector<OnsetLatch> latches_;
};

}  // namespace engine
