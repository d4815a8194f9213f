#pragma once

#include <cmath>
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
  [[nodiscard]] int face_points() const { return static_cast<int>(points_.size()) / 2; }  ///< of each face
  [[nodiscard]] double point_stiffness() const { return point_stiffness_; }    ///< [N/m]
  [[nodiscard]] double limit() const { return 0.5 * joint_.L_b + joint_.c_a; } ///< how far from the bearing's middle a point touches, [m]

  /// How far the points of a face may at most be beyond the bearing's middle. p_z is the journal centre's; x_z,
  /// y_z, z_z are the third row of R_bj.
  [[nodiscard]] double calc_reach(double side, double p_z, double x_z, double y_z, double z_z) const {
    return side * p_z + 0.5 * joint_.L_b * z_z + (1.0 + 1e-12) * joint_.r_j() * std::sqrt(x_z * x_z + y_z * y_z);
  }

  /// Takes note of contacts that began or ended in a step. @returns true if any did
  bool advance(const JournalMotion& start, const JournalMotion& end, double dt);

 private:
  ClearanceParameters joint_;
  double point_stiffness_;
  std::vector<FacePoint> points_;  ///< of the face at +z, then of the one at -z
  std::vector<OnsetLatch> latches_;
  int touching_[2] = {0, 0};       ///< latched points of each face
};

}  // namespace engine
