// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "engine/clearance/clearance_parameters.h"
#include "engine/clearance/journal_motion.h"
#include "engine/clearance/normal_force.h"

namespace engine {

/// Contact of the journal's two faces, 0 at +z and 1 at -z, with the bearing's shoulders: what each point
/// remembers. The law: faces_law.h.
class AxialFaces {
 public:
  explicit AxialFaces(const ClearanceParameters& joint);

  [[nodiscard]] const ClearanceParameters& parameters() const { return joint_; }
  [[nodiscard]] static double side(int face) { return face == 0 ? 1.0 : -1.0; }
  /// Axial position of a face's points, in {j}, [m].
  [[nodiscard]] double z(int face) const { return side(face) * 0.5 * joint_.L_b; }
  [[nodiscard]] int face_points() const { return face_points_; }                    ///< of each face
  /// Latches of a face's points. These and the following arrays may be read eight at a time, the last ones
  /// beyond the points.
  [[nodiscard]] const OnsetLatch* latches(int face) const { return latches_.data() + face * face_points_; }
  /// The points of either face: positions across the journal's axis, in {j}, and their setback, 0. Those
  /// beyond them stand back so far that they never touch. [m]
  [[nodiscard]] const double* x() const { return x_.data(); }
  [[nodiscard]] const double* y() const { return y_.data(); }
  [[nodiscard]] const double* setback() const { return setback_.data(); }
  [[nodiscard]] double point_stiffness() const { return point_stiffness_; }    ///< [N/m]
  [[nodiscard]] double point_damping() const { return point_damping_; }        ///< [N s/m]
  /// Distance from the bearing's middle at which a point touches, [m].
  [[nodiscard]] double limit() const { return 0.5 * joint_.L_b + joint_.c_a; }

  /// Largest distance of a face's points from the bearing's middle, along its axis. p_z is the journal
  /// centre's; x_z, y_z, z_z are the third row of R_bj.
  [[nodiscard]] double calc_farthest_point(double side, double p_z, double x_z, double y_z,
                                           double z_z) const {
    return side * p_z + 0.5 * joint_.L_b * z_z +
           (1.0 + 1e-12) * joint_.r_j() * std::sqrt(x_z * x_z + y_z * y_z);
  }

  /// Takes note of contacts that began or ended in a step. Changes are abrupt with
  /// Kelvin and Voigt's damping alone: by other laws the force of a point begins and ends at zero.
  ContactChange advance(const JournalMotion& start, const JournalMotion& end, double dt);

 private:
  void add_points();
  /// Takes note of a face's points that touch or part. @returns whether any did
  bool advance_points(int face, const JournalMotion& start, const JournalMotion& end, double dt);

  ClearanceParameters joint_;
  int face_points_;
  double point_stiffness_, point_damping_;
  std::vector<double> x_, y_, setback_;
  std::vector<OnsetLatch> latches_;  ///< face after face
  int touching_[2] = {0, 0};         ///< latched points of each face
};

}  // namespace engine
