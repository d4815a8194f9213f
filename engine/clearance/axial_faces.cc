// SPDX-License-Identifier: Apache-2.0
#include "engine/clearance/axial_faces.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "engine/clearance/faces_law.h"

namespace engine {

AxialFaces::AxialFaces(const ClearanceParameters& joint)
    : joint_(joint),
      face_points_(joint.n_a * joint.n_ce_axial),
      point_stiffness_(joint.K_a / face_points_),
      point_damping_(joint.damping / face_points_) {
  add_points();
  constexpr std::size_t kReadTogether = Lanes::kCount;
  latches_.resize(2 * x_.size() + kReadTogether);
  setback_.resize(x_.size(), 0.0);
  setback_.resize(x_.size() + kReadTogether, 1.0);
  x_.resize(setback_.size());
  y_.resize(setback_.size());
}

void AxialFaces::add_points() {
  for (int circle = 1; circle <= joint_.n_a; ++circle)
    for (int k = 0; k < joint_.n_ce_axial; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / joint_.n_ce_axial;
      const double radius = joint_.r_j() * circle / joint_.n_a;
      x_.push_back(radius * std::cos(angle));
      y_.push_back(radius * std::sin(angle));
    }
}

ContactChange AxialFaces::advance(const JournalMotion& start, const JournalMotion& end, double dt) {
  const Eigen::Vector3d axial = end.R_bj.row(2);
  ContactChange change;
  for (const int face : {0, 1}) {
    const bool touched = touching_[face] > 0;
    if (!touched &&
        calc_farthest_point(side(face), end.p_bj.z(), axial.x(), axial.y(), axial.z()) <= limit())
      continue;
    change.any |= advance_points(face, start, end, dt);
    if (!touched && touching_[face] > 0) ++change.face_onsets;
  }
  change.abrupt = change.any && point_damping_ > 0.0;
  return change;
}

bool AxialFaces::advance_points(int face, const JournalMotion& start, const JournalMotion& end, double dt) {
  const FaceMotion<double, double> at_start = calc_face_motion(*this, face, to_relative_motion(start));
  const FaceMotion<double, double> at_end = calc_face_motion(*this, face, to_relative_motion(end));
  bool any = false;
  for (int k = 0; k < face_points_; ++k) {
    OnsetLatch& latch = latches_[static_cast<std::size_t>(face * face_points_ + k)];
    const double x = this->x()[k], y = this->y()[k];
    const bool touches = at_end.calc_delta(x, y) > 0.0;
    if (touches == latch.in_contact()) continue;
    any |= latch.advance({at_start.calc_delta(x, y), at_start.calc_rate(x, y)},
                         {at_end.calc_delta(x, y), at_end.calc_rate(x, y)}, dt, joint_.minimum_onset_rate);
    touching_[face] += touches ? 1 : -1;  // the point has just touched, or parted
  }
  return any;
}

}  // namespace engine
