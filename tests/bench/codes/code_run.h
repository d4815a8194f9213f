// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace bench {

/// The slider at the end of a step, with the acceleration there.
struct SliderSample {
  double t = 0.0;             ///< [s]
  double position = 0.0;      ///< [m]
  double velocity = 0.0;      ///< [m/s]
  double acceleration = 0.0;  ///< [m/s^2]
};

/// Sees each step of a run; may be empty.
using StepViewer = std::function<void(const SliderSample&)>;

/// What one job gave in one code.
struct CodeRun {
  double peak = 0.0;     ///< of the slider's acceleration in the steady window, [m/s^2]
  long evaluations = 0;  ///< of the equations of motion
};

}  // namespace bench
