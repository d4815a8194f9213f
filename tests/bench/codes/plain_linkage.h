// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "tests/bench/codes/joint_forces.h"

namespace bench {

/// A driven coordinate at one instant.
struct PlainDriven {
  double q, qd, qdd;
};

/// One coordinate of the joint that carries a body.
struct PlainCoordinate {
  std::string name;
  bool slides = false;                        ///< along the axis; else it turns about it
  int axis = 0;                               ///< x, y, z: 0, 1, 2
  double stiffness = 0.0, damping = 0.0;
  std::function<PlainDriven(double)> drive;   ///< empty: free
  double start = 0.0, start_rate = 0.0;       ///< at t = 0
};

/// A body and the joint that carries it. Its frame is parallel to its parent's while its coordinates are
/// zero.
struct PlainBody {
  int parent = -1;                            ///< index of a body before it; -1: the ground
  Eigen::Vector3d p_PJ = Eigen::Vector3d::Zero();  ///< the joint in the parent's frame, [m]
  std::vector<PlainCoordinate> joint;              ///< one, two turns, or turns about z, y and x
  double mass = 0.0;                          ///< [kg]
  Eigen::Vector3d com = Eigen::Vector3d::Zero();  ///< [m]
  /// moments about the frame's origin; its axes are principal, [kg m^2]
  Eigen::Vector3d inertia = Eigen::Vector3d::Zero();
};

/// Two points that coincide: a spherical joint that closes a loop.
struct PlainLoop {
  int bodies[2];
  Eigen::Vector3d points[2];  ///< in the bodies' frames, [m]
};

/// The linkage as any multibody code takes it, without a word of the engine's: some of them cannot read its
/// headers.
struct PlainLinkage {
  Eigen::Vector3d gravity_W = Eigen::Vector3d::Zero();  ///< [m/s^2]
  std::vector<PlainBody> bodies;              ///< parents first
  std::vector<PlainLoop> loops;
  int measured = 0;                           ///< body whose last coordinate is
  int bearing = 0, journal = 0;               ///< bodies
  std::unique_ptr<JointForces> forces;        ///< between bearing and journal; null: none
  double steady_from = 0.0;                   ///< start of the window in which peaks count, [s]
};

}  // namespace bench
