// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace bench {

/// The measured coordinate at the end of a step, with the acceleration there. Units are those of the
/// coordinate, [m] or [rad], and seconds.
struct CoordinateSample {
  double t = 0.0;             ///< [s]
  double position = 0.0;
  double velocity = 0.0;
  double acceleration = 0.0;
};

/// Result of one job in one code.
struct CodeRun {
  double peak = 0.0;  ///< of the measured coordinate's acceleration in the steady window, [m/s^2], [rad/s^2]
  long evaluations = 0;  ///< of the equations of motion
};

}  // namespace bench
