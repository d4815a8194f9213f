// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "engine/model/mechanism.h"

namespace engine {

/// Pose, velocity and acceleration of one coordinate's frame F; all vectors in W.
struct FrameMotion {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();      ///< R_WF
  Eigen::Vector3d p = Eigen::Vector3d::Zero();          ///< origin, [m]
  Eigen::Vector3d p_parent = Eigen::Vector3d::Zero();   ///< origin seen from the parent frame's origin, [m]
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();       ///< of the coordinate
  Eigen::Vector3d w = Eigen::Vector3d::Zero();          ///< angular velocity, [rad/s]
  Eigen::Vector3d v = Eigen::Vector3d::Zero();          ///< of the origin, [m/s]
  Eigen::Vector3d wd = Eigen::Vector3d::Zero();         ///< angular acceleration, [rad/s^2]
  Eigen::Vector3d vd = Eigen::Vector3d::Zero();  ///< acceleration of the origin less that of gravity, [m/s^2]
};

/// The motion of the ground as the frames on it see it: at rest, gravity as an upward acceleration.
[[nodiscard]] FrameMotion ground_motion(const Mechanism& mechanism);

/// The motion of a frame; of the ground: at rest, without gravity. @param frames  one a coordinate
[[nodiscard]] inline FrameMotion motion_of(FrameIndex frame, const std::vector<FrameMotion>& frames) {
  return frame == kGround ? FrameMotion{} : frames[static_cast<std::size_t>(frame)];
}

/// Computes the pose of every frame from the joint coordinates, root to tip, Eq. (2).
/// @param q       one entry a coordinate
/// @param frames  one a coordinate; velocities and accelerations stay as they are
void calc_frame_poses(const Mechanism& mechanism, const Eigen::VectorXd& q, std::vector<FrameMotion>& frames);

/// Computes velocities and accelerations of frames whose poses are set, by the derivatives of Eq. (2) by
/// time.
/// @param qdd  where it is not known yet zero, and the result is the bias acceleration
void calc_frame_rates(const Mechanism& mechanism, const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd,
                      std::vector<FrameMotion>& frames);

/// Both, from q, qd and qdd.
void calc_frame_motions(const Mechanism& mechanism, const Eigen::VectorXd& q, const Eigen::VectorXd& qd,
                        const Eigen::VectorXd& qdd, std::vector<FrameMotion>& frames);

}  // namespace engine
