// SPDX-License-Identifier: Apache-2.0
#include "engine/clearance/point_contacts.h"

#include "engine/clearance/point_contacts_law.h"

namespace engine {

namespace {

std::vector<PointContacts::Corner> list_corners(const ClearanceParameters& joint) {
  std::vector<PointContacts::Corner> corners;
  if (joint.geometry != ContactGeometry::kBlockInSlot) return corners;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-0.5, 0.5}) {
        const Vec3<double> at{x * joint.block_x, y * joint.block_y, z * joint.L_b};
        corners.push_back({at, 0, x, joint.block_x + joint.c_r});
        corners.push_back({at, 1, y, joint.block_y + joint.c_y});
      }
  return corners;
}

}  // namespace

PointContacts::PointContacts(const ClearanceParameters& joint)
    : joint_(joint),
      corners_(list_corners(joint)),
      latches_(joint.geometry == ContactGeometry::kBallInSocket ? 1 : corners_.size()) {}

Penetration PointContacts::calc_penetration(const RelativeMotion<double, double>& journal, int i) const {
  const SurfacePoint<double> point = locate_contact(*this, journal, i);
  return {point.delta, dot(point.n, journal.calc_velocity(point.r))};
}

void PointContacts::add_penetrations(const JournalMotion& journal, std::vector<Penetration>& contacts) const {
  const RelativeMotion<double, double> motion = to_relative_motion(journal);
  for (int i = 0; i < count(); ++i) contacts.push_back(calc_penetration(motion, i));
}

bool PointContacts::follow(const JournalMotion& journal, double* bristles) {
  constexpr double kFar = -0.5;  // cosine from the pole
  if (joint_.geometry != ContactGeometry::kBallInSocket) return false;
  const SurfacePoint<double> point = locate_ball(*this, to_relative_motion(journal));
  if (!(pole_ * point.n.z < kFar)) return false;
  const Vec3<double> bristle = bristles[0] * point.t + bristles[1] * point.s;
  pole_ = -pole_;
  const SurfacePoint<double> turned = locate_ball(*this, to_relative_motion(journal));
  bristles[0] = dot(turned.t, bristle);
  bristles[1] = dot(turned.s, bristle);
  return true;
}

ContactChange PointContacts::advance(const JournalMotion& start, const JournalMotion& end, double dt,
                                     double* bristles) {
  const RelativeMotion<double, double> motion_start = to_relative_motion(start),
                                       motion_end = to_relative_motion(end);
  ContactChange change;
  for (int i = 0; i < count(); ++i) {
    OnsetLatch& latch = latches_[static_cast<std::size_t>(i)];
    const Penetration at_end = calc_penetration(motion_end, i);
    if ((at_end.delta > 0.0) != latch.in_contact()) {
      change.any |= latch.advance(calc_penetration(motion_start, i), at_end, dt, joint_.minimum_onset_rate);
      change.abrupt = change.any;
      change.ring_onsets += latch.in_contact() ? 1 : 0;
    }
    if (!latch.in_contact()) bristles[2 * i] = bristles[2 * i + 1] = 0.0;
  }
  return change;
}

}  // namespace engine
