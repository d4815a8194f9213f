// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "engine/kinematics/frame_motion.h"
#include "engine/model/mechanism.h"

namespace engine {

/// Radius of gyration, about a rotation's axis, of the bodies that it carries, [m]; 1 if they have no mass.
[[nodiscard]] double calc_gyration_radius(const Mechanism& mechanism, FrameIndex rotation,
                                          const std::vector<FrameMotion>& frames);

/// Weighted root-mean-square norm of local errors (SUNDIALS: WRMS). With radii set, errors of coordinates and
/// rates are measured in metres and metres per second: a rotation's by the radius of gyration, about its
/// axis, of the bodies that it carries. Charges and memories, which are no lengths, are measured as they are,
/// a charge by the root of the inductance. Without radii the spin of a thin link about itself, which moves
/// nothing else, would ask for the shortest steps.
class Tolerance {
 public:
  Tolerance(double relative, double absolute) : relative_(relative), absolute_(absolute) {}

  [[nodiscard]] double relative() const { return relative_; }

  /// Sets the radii of gyration, from the mechanism in one position. Until then each is 1.
  void set_radii(const Mechanism& mechanism, const std::vector<FrameIndex>& free,
                 const std::vector<FrameMotion>& frames);

  /// Lets the absolute tolerance follow motions slower than kSlow: as much of it as their speed is of
  /// kOrdinarySpeed.
  /// @param speed  the largest so far, [m/s]  @returns the factor
  double follow_speed(double speed);
  /// Largest speed among the joint coordinates, [m/s]; without radii, rotations count in [rad/s].
  /// @param rates  one a free coordinate
  [[nodiscard]] double calc_speed(const Eigen::Ref<const Eigen::VectorXd>& rates) const;

  /// Norm of an error of the state, over the entries under error control, each in units of its tolerance; 0
  /// without entries.
  /// @param error_weights  of these entries; their squares sum to 1: see MotionSystem::error_weights()
  [[nodiscard]] double measure(const Eigen::VectorXd& error, const Eigen::VectorXd& y0,
                               const Eigen::VectorXd& y1, const Eigen::VectorXd& error_weights) const;

  /// Factors of these entries: the root of the sum of squares of their products is measure() at y.
  void calc_weights(const Eigen::VectorXd& y, const Eigen::VectorXd& error_weights,
                    Eigen::VectorXd& weights) const;

 private:
  /// [m/s]; at rest there is rounding.
  static constexpr double kRest = 1e-8, kSlow = 0.01, kOrdinarySpeed = 0.1;

  double relative_, absolute_;
  double requested_absolute_ = absolute_;
  Eigen::VectorXd radii_;  ///< one a free coordinate, [m]; 1 for those that slide
  Eigen::VectorXd is_joint_;  ///< 1 for coordinates of joints, 0 for charges and memories
};

}  // namespace engine
