// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "engine/kinematics/frame_motion.h"
#include "engine/kinematics/tree_model.h"
#include "engine/model/mechanism.h"

namespace engine {

/// Force and moment about a frame's origin, in W.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< [N m]
};

/// The generalised forces that hold a given motion of the open chains: M qdd + h + g of Eqs. (5)-(7) less
/// what the loads do. Newton and Euler's recursion in W, each frame about its own origin (about a common one,
/// the spin inertia of a slender body would lose its last digits).
class InverseDynamics {
 public:
  explicit InverseDynamics(const Mechanism& mechanism);

  /// External forces for the next calc(); cleared by it.
  void add_load(FrameIndex frame, const Wrench& about_origin);

  /// Computes the forces, one a coordinate, [N] or [N m], from the frames' motions, accelerations with them,
  /// and the loads added since. Allocates nothing.
  const Eigen::VectorXd& calc(const std::vector<FrameMotion>& frames);
  /// The force that a coordinate's joint transmits to its frame, about the frame's origin, after calc().
  [[nodiscard]] const Wrench& transmitted(FrameIndex frame) const {
    return transmitted_[static_cast<std::size_t>(frame)];
  }

 private:
  void calc_net_forces(const std::vector<FrameMotion>& frames);

  TreeModel model_;
  std::vector<Wrench> loads_;
  std::vector<Wrench> transmitted_;  ///< by the joint of each frame
  Eigen::VectorXd forces_;
};

}  // namespace engine
