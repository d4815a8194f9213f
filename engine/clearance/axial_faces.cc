#include "engine/clearance/axial_faces.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "engine/clearance/faces_law.h"

namespace engine {

AxialFaces::AxialFaces(const ClearanceParameters& joint)
    : joint_(joint), point_stiffness_(joint.K_a / (joint.n_a * joint.n_ce_axial)) {
  for (const double side : {1.0, -1.0})
    for (int circle = 1; circle <= joint.n_a; ++circle)
      for (int k = 0; k < joint.n_ce_axial; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / joint.n_ce_axial;
        const double radius = joint.r_j() * circle / joint.n_a;
        points_.push_back({radius * std::cos(angle), radius * std::sin(angle), side * 0.5 * joint.L_b, side});
      }
  latches_.resize(points_.size());
}

bool AxialFaces::advance(const JournalMotion& start, const JournalMotion& end, double dt) {
  const Eigen::Vector3d axial = end.R_bj.row(2);
  const double p_z = end.p_bj.z();
  const double most = limit();
  bool changed = false;
  const std::size_t count = points_.size() / 2;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const FacePoint& point = points_[k];
    int& touching = touching_[k / count];
    if (k % count == 0 && touching == 0 && calc_reach(point.side, p_z, axial.x(), axial.y(), axial.z()) <= most) {
      k += count - 1;
      continue;
    }
    const double r_z = point.x * axial.x() + point.y * axial.y() + point.z * axial.z();
    const bool touches = point.side * (p_z + r_z) - most > 0.0;
    if (touches == latches_[k].in_contact()) continue;
    const FacePenetration<double, double> at_end = calc_face_penetration(to_relative_motion(end), point, most);
    const FacePenetration<double, double> at_start = calc_face_penetration(to_relative_motion(start), point, most);
    changed |= latches_[k].advance({at_start.delta, at_start.rate}, {at_end.delta, at_end.rate}, dt, joint_.minimum_onset_rate);
    touching += static_cast<int>(latches_[k].in_contact()) - static_cast<int>(!touches);
  }
  return changed;
}

}  // namespace engine
