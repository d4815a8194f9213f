// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "engine/dynamics/evaluation.h"
#include "engine/dynamics/state_layout.h"
#include "engine/kinematics/tree_model.h"
#include "engine/model/applied_force.h"

namespace engine {

/// The applied forces of a mechanism's force elements, and the laws of its body loads, at one instant.
class AppliedForces {
 public:
  /// @param mechanism  must outlive this
  AppliedForces(const Mechanism& mechanism, const TreeModel& model);

  /// Values for the kernel; they stay where they are.
  [[nodiscard]] AppliedValues values() const { return {values_.data(), body_loads_.data()}; }

  /// Computes the values. Allocates nothing.
  /// @param reactions  normal forces by reactions, one an Actuation, [N]
  void calc(double t, const Eigen::VectorXd& y, const std::vector<DrivenMotion>& drives,
            const StateLayout& layout, const Eigen::VectorXd& reactions);

  /// Forces, works and their part in the energy account. Losses of actuators count as structural loss.
  void read_out(const Eigen::VectorXd& y, const StateLayout& layout, Evaluation& at) const;

 private:
  /// Source of a coordinate's motion: the free coordinates or a drive.
  struct Source {
    int free = -1;   ///< number among the free coordinates; -1: it is driven, or there is none
    int drive = -1;  ///< the drive that gives it
  };
  /// A force element with its applied forces [first, end).
  struct Group {
    Source coordinate, winding, memory;
    std::size_t first = 0, end = 0;
  };
  void read_out_elements(const Eigen::VectorXd& y, const StateLayout& layout, Evaluation& at) const;
  void read_out_body_loads(const Eigen::VectorXd& y, const StateLayout& layout, Evaluation& at) const;
  [[nodiscard]] static Source find_source(const TreeModel& model, FrameIndex coordinate);

  const Mechanism& mechanism_;
  std::vector<AppliedForce> forces_;
  std::vector<Group> groups_;  ///< one an Actuation
  std::vector<AppliedForceValue> values_;
  std::vector<SignalPoint> body_loads_;
};

}  // namespace engine
