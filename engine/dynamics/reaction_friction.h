// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "engine/dynamics/evaluation.h"
#include "engine/dynamics/joint_reactions.h"
#include "engine/model/mechanism.h"

namespace engine {

/// Normal forces of dry friction in joints without play, by the joints' reactions, which friction changes in
/// turn.
///
/// A joint bears its reaction, force F and moment M about its place on the second body, at both ends of its
/// length L, half of F and a couple:
///
///     N = |F_r / 2 + a x M / L| + |F_r / 2 - a x M / L| + N_a
///
/// F_r is the part of F across the axis a. N_a is the magnitude of the part along a of a joint that turns, 0
/// of one that slides. Without a length N = |F_r| + N_a. Of a joint of several freedoms F has no part along
/// those in which it slides: nothing is borne there. (A screw bears its thrust: its slide is no freedom.)
///
/// At one state the reactions are affine in the forces of friction, and these in N. N = g(N) is solved by
/// Broyden's method. Source: C. T. Kelley, Iterative Methods for Linear and Nonlinear Equations (1995),
/// chapter 7. Where friction wedges the joints there is no solution. Of several, the one is taken on which
/// reactions settle in joints that yield a little: dN/dt ~ g(N) - N is stable there.
class ReactionFriction {
 public:
  /// @param mechanism  must outlive this
  explicit ReactionFriction(const Mechanism& mechanism);

  /// @returns whether no friction depends on reactions
  [[nodiscard]] bool empty() const { return joints_.empty(); }
  /// Normal forces by reactions, one an Actuation, 0 of those that have none, [N]
  [[nodiscard]] const Eigen::VectorXd& normal_forces() const { return normal_forces_; }

  /// Begins to solve at a new state, from the last solution.
  void start() { has_last_ = false; }
  /// @param at  accelerations and loads that came of normal_forces()
  /// @returns whether these are the solution; otherwise they are new ones to try
  [[nodiscard]] bool improve(const Evaluation& at);
  /// Takes up the last solution again: forces that were tried in vain are none of the next state.
  void give_up();

 private:
  struct Joint {
    Eigen::Index actuation = 0;
    FrameIndex coordinate = 0;
    FrameIndex last = 0;  ///< coordinate of the joint: its frame is that of the second body
    bool turns = false;
    double length = 0.0;
    std::vector<FrameIndex> slides = {};  ///< other freedoms of the joint
  };
  [[nodiscard]] double calc_normal_force(const Joint& joint, const Evaluation& at) const;
  void update_inverse();

  std::vector<Joint> joints_;
  JointReactions reactions_;
  Eigen::VectorXd normal_forces_, last_solution_;
  Eigen::MatrixXd inverse_;  ///< of 1 - dg/dN, kept from state to state
  Eigen::VectorXd residual_, last_residual_, step_, image_, row_;
  bool has_last_ = false;
};

}  // namespace engine
