// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "engine/kinematics/frame_motion.h"
#include "engine/model/mechanism.h"

namespace engine {

/// How large a local error may be. With radii set, errors of coordinates and rates are measured where they do harm, in metres and metres per
/// second: a rotation's by the radius of gyration, about its axis, of all that it carries. The spin of a thin rod about itself would else
/// ask for the shortest steps, and change nothing.
class Tolerance {
 public:
  Tolerance(double relative, double absolute) : relative_(relative), absolute_(absolute) {}

  [[nodiscard]] double relative() const { return relative_; }

  /// Sets the radii of gyration, from the mechanism in one position. Until then each is 1.
  void set_radii(const Mechanism& mechanism, const std::vector<FrameIndex>& free, const std::vector<FrameMotion>& frames);

  /// Root mean square over the first entries of an error of the state, each in units of its tolerance; of none 0.
  /// @param error_weights  of these entries, whose squares sum to 1: see MotionSystem::error_weights()
  [[nodiscard]] double measure(const Eigen::VectorXd& error, const Eigen::VectorXd& y0, const Eigen::VectorXd& y1,
                               const Eigen::VectorXd& error_weights) const;

  /// What each of these entries is to be multiplied by, so that the root of the sum of squares is what measure() would give at y.
  void calc_weights(const Eigen::VectorXd& y, const Eigen::VectorXd& error_weights, Eigen::VectorXd& weights) const;

 private:
  double relative_, absolute_;
  Eigen::VectorXd radii_;  ///< one a free coordinate, [m]; 1 for those that slide
};

}  // namespace engine
