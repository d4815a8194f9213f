// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "engine/dynamics/motion_system.h"
#include "engine/model/mechanism.h"

namespace engine {

/// A mechanism, and the position and disturbance in which it is looked at.
struct MechanismCase {
  std::string name;
  Mechanism mechanism;
  FrameIndex pressed;  ///< coordinate that stands off from where the loop closes, so that the journal is
                       ///< pressed into the bearing
  double offset;       ///< of it, [m] or [rad]
  double step;  ///< of the differences, [m] or [rad]: far below the penetration, or far above rounding where
                ///< nothing touches
  double disturbance = 1.0;  ///< of the rates: those of dependent constraints must fit, or the least
                             ///< multipliers are another kind of solution
};
inline void PrintTo(const MechanismCase& c, std::ostream* out) { *out << c.name; }

/// Mechanisms with every kind of coordinate, contact and force; all journals but that of `apart` are in
/// contact.
[[nodiscard]] std::vector<MechanismCase> make_mechanism_cases();

/// A mechanism in motion, its bristles bent.
class MovingMechanism {
 public:
  MovingMechanism(const MechanismCase& c, std::string_view instruction_set);

  void evaluate(double t, const Eigen::VectorXd& state, Eigen::VectorXd& rates);

  /// The state's derivative by one direction from four points, of order 4. @param direction  an entry of y,
  /// or -1 for time
  [[nodiscard]] Eigen::VectorXd differ(Eigen::Index direction, double step);

  static constexpr double kTime = 0.7;
  MotionSystem system;
  Eigen::VectorXd y, f;
};

/// The ways to solve an implicit step's systems that a mechanism takes.
[[nodiscard]] std::vector<NewtonSolver> solvers_of(const MotionSystem& system);

}  // namespace engine
