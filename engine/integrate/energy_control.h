// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/dynamics/evaluation.h"
#include "engine/model/run_options.h"

namespace engine {

/// Holds each step of an implicit method to the energy account. Such a method steps over the fastest motions, and in lasting contact its
/// errors of the friction work all have one sign: steps that each look accurate add up to an account that does not close. So a step may be
/// out of balance by a part of the mean power with which drives, losses and motion have exchanged energy so far, times its length.
class EnergyControl {
 public:
  explicit EnergyControl(const RunOptions& options)
      : relative_(kPart * std::max(options.relative_tolerance, kFinest)), absolute_(kPart * std::max(options.absolute_tolerance, kFinest)) {}

  /// Imbalance of a step that starts at t0, in units of what is allowed.
  [[nodiscard]] double measure(const EnergyAccount& start, const EnergyAccount& end, double t0, double dt) const;

  /// The step from start to end is part of the run.
  void accept(const EnergyAccount& start, const EnergyAccount& end) {
    exchanged_ += end.calc_turned_over_since(start) + std::abs(end.kinetic - start.kinetic);
  }

 private:
  static constexpr double kPart = 0.25;    // of the tolerance: with it peaks and account of runs at one tolerance are about equally good
  static constexpr double kFinest = 1e-7;  // tolerances below have the steps resolve all that moves, and the account is one of roundings

  double relative_;           ///< of the mean power
  double absolute_;           ///< [W]
  double exchanged_ = 0.0;    ///< [J]
};

}  // namespace engine
