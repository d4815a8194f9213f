// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/dynamics/evaluation.h"
#include "engine/model/run_options.h"

namespace engine {

/// Error control by the energy account of each step of an implicit method. Such a method steps over the
/// fastest motions. In lasting contact its errors of the friction work all have one sign: steps that are
/// accurate one by one add up to an account that does not close. The imbalance of a step may be a part of the
/// mean power with which drives, losses and motion have exchanged energy so far, times its length.
class EnergyControl {
 public:
  /// @param rigid_mass  mass of a mechanism without contacts and dampers, [kg]; 0: another mechanism. Errors
  /// of a rigid mechanism have both signs. Its steps may also err by a part of their own exchange, and by the
  /// errors of Newton's iterations, which no shorter step makes less. Its absolute tolerance is for each
  /// kilogram.
  EnergyControl(const RunOptions& options, double rigid_mass)
      : rigid_(rigid_mass > 0.0),
        relative_(kPart * std::max(options.relative_tolerance, kFinest)),
        absolute_(kPart * std::max(options.absolute_tolerance, kFinest) * (rigid_ ? rigid_mass : 1.0)) {}

  /// Lets the absolute part follow the energies of slow motions. @param factor  of their speeds
  void follow_speed(double factor) { scale_ = factor * factor; }

  /// Imbalance of a step that starts at t0, in units of the allowed one.
  [[nodiscard]] double measure(const EnergyAccount& start, const EnergyAccount& end, double t0,
                               double dt) const;

  /// The step from start to end is part of the run.
  void accept(const EnergyAccount& start, const EnergyAccount& end) {
    exchanged_ += calc_exchange(start, end);
  }

 private:
  [[nodiscard]] static double calc_exchange(const EnergyAccount& start, const EnergyAccount& end) {
    return end.calc_turned_over_since(start) + std::abs(end.kinetic - start.kinetic);
  }

  // Part of the tolerance: makes peaks and account of a run about equally good.
  static constexpr double kPart = 0.25;
  // Below this tolerance steps resolve all motion, and the imbalance is rounding.
  static constexpr double kFinest = 1e-7;

  bool rigid_;
  double relative_;           ///< of the mean power
  double absolute_;           ///< [W]
  double scale_ = 1.0;        ///< of the absolute part
  double exchanged_ = 0.0;    ///< [J]
};

}  // namespace engine
