#pragma once


#include <Eigen/Core>
#include <Eigen/Geometry>

namespace engine {

/// The journal as seen from the bearing: frame {j} in frame {b}, all in {b}. z is both parts' axis.
struct JournalMotion {
  Eigen::Matrix3d R_bj = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_bj = Eigen::Vector3d::Zero();  ///< journal centre, [m]
  Eigen::Vector3d v = Eigen::Vector3d::Zero();     ///< of the journal centre relative to {b}, [m/s]
  Eigen::Vector3d w = Eigen::Vector3d::Zero();     ///< of the journal relative to {b}, [rad/s]

  /// Velocity of the journal's material point at r from its centre, less that of the bearing's at the same place.
  [[nodiscard]] Eigen::Vector3d calc_velocity(const Eigen::Vector3d& r) const { return v + w.cross(r); }
};

/// What all contacts of one joint do together. Force and moment act on the journal, about its centre, in {b}; on the bearing the opposite.
struct ContactLoad {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< [N m]
  double radial_normal_sum = 0.0;                    ///< [N]
  double friction_sum = 0.0;                         ///< magnitudes, [N]
  double max_penetration = 0.0;                      ///< of radial contacts, [m]
  double elastic_energy = 0.0;                       ///< [J]
  double impact_power = 0.0;                         ///< lost in the normal law, [W]
  double friction_power = 0.0;                       ///< [W]

  void add_force(const Eigen::Vector3d& r, const Eigen::Vector3d& f) {
    force += f;
    moment += r.cross(f);
  }
};

}  // namespace engine
