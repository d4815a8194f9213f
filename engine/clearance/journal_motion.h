// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "engine/clearance/contact_law.h"

namespace engine {

/// The journal as seen from the bearing: frame {j} in frame {b}, all in {b}. z is both parts' axis.
struct JournalMotion {
  Eigen::Matrix3d R_bj = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_bj = Eigen::Vector3d::Zero();  ///< journal centre, [m]
  Eigen::Vector3d v = Eigen::Vector3d::Zero();     ///< of the journal centre relative to {b}, [m/s]
  Eigen::Vector3d w = Eigen::Vector3d::Zero();     ///< of the journal relative to {b}, [rad/s]

  /// Velocity of the journal's material point at r from its centre, less that of the bearing's at the same
  /// place.
  [[nodiscard]] Eigen::Vector3d calc_velocity(const Eigen::Vector3d& r) const { return v + w.cross(r); }
};

/// Load of all contacts of one joint. Force and moment act on the journal, about its centre, in {b};
/// on the bearing the opposite.
struct ContactLoad {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< [N m]
  double radial_normal_sum = 0.0;                    ///< [N]
  double face_normal_sum = 0.0;                      ///< [N]
  double friction_sum = 0.0;                         ///< magnitudes, [N]
  double max_penetration = 0.0;                      ///< of radial contacts, [m]
  double elastic_energy = 0.0;                       ///< [J]
  double impact_power = 0.0;                         ///< lost in the normal law, [W]
  double friction_power = 0.0;                       ///< [W]
  bool face_touches = false;                         ///< a point of a face is beyond its shoulder
};

/// The same as the contact laws take it.
[[nodiscard]] inline RelativeMotion<double, double> to_relative_motion(const JournalMotion& journal) {
  const auto vector = [](const auto& v) { return Vec3<double>{v[0], v[1], v[2]}; };
  return {{vector(journal.R_bj.col(0)), vector(journal.R_bj.col(1)), vector(journal.R_bj.col(2))},
          vector(journal.p_bj), vector(journal.v), vector(journal.w)};
}

/// Load by the contact laws, as observers take it.
[[nodiscard]] inline ContactLoad to_contact_load(const JointLoad<double>& load) {
  const auto vector = [](const Vec3<double>& v) { return Eigen::Vector3d(v.x, v.y, v.z); };
  return {.force = vector(load.force),
          .moment = vector(load.moment),
          .radial_normal_sum = load.radial_normal_sum,
          .face_normal_sum = load.face_normal_sum,
          .friction_sum = load.friction_sum,
          .max_penetration = load.max_penetration,
          .elastic_energy = load.elastic_energy,
          .impact_power = load.impact_power,
          .friction_power = load.friction_power,
          .face_touches = load.face_touches};
}

}  // namespace engine
