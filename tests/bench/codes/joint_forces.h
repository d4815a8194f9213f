// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace bench {

/// Pose and velocity of a body's frame, all in W.
struct BodyMotion {
  Eigen::Matrix3d R;
  Eigen::Vector3d p, v, w;
};

/// Force through the journal's centre and moment about it, on the journal; on the bearing the opposite. All
/// in W.
struct JournalLoad {
  Eigen::Vector3d p_j;
  Eigen::Vector3d force, moment;
};

/// The engine's joint with clearance inside another code: that code moves the bodies and gets the forces.
/// A plain interface, for programs that cannot read the engine's headers.
class JointForces {
 public:
  virtual ~JointForces() = default;

  [[nodiscard]] virtual int bristle_count() const = 0;

  /// @param bearing, journal         the bodies that carry them
  /// @param bristles, bristle_rates  bristle_count() entries
  [[nodiscard]] virtual JournalLoad calc(const BodyMotion& bearing, const BodyMotion& journal,
                                         const double* bristles, double* bristle_rates) const = 0;

  /// Takes note of the contacts that began or ended since the last call; a bristle whose contact has ended is
  /// relaxed.
  /// @returns true if any did
  virtual bool end_step(double t, const BodyMotion& bearing, const BodyMotion& journal, double* bristles) = 0;
};

}  // namespace bench
