// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/model/rpsup_parameters.h"
#include "engine/model/run_options.h"

namespace bench {

/// Whether a case was there when tolerances and defaults were chosen.
enum class CaseKind { kKnown, kFresh };

/// A case whose peak converges as tolerances tighten.
struct PrecisionCase {
  std::string name;
  CaseKind kind;
  engine::RpsupParameters parameters;
};

/// An integrator with a tolerance or a step.
struct Setting {
  std::string integrator;
  double value;  ///< relative tolerance, [1]; step, [s]
  engine::RunOptions options;
};

/// Result of one setting for one case; a run that failed has neither peak nor error.
struct Measurement {
  const PrecisionCase* what;
  const Setting* setting;
  double cpu_seconds;
  double evaluations;
  double peak;   ///< [m/s^2]
  double error;  ///< relative to the tight reference
};

[[nodiscard]] std::vector<PrecisionCase> precision_cases();
[[nodiscard]] std::vector<Setting> precision_settings();

/// Peak of the case by dopri5 at a tolerance of 1e-9, [m/s^2].
[[nodiscard]] double find_reference_peak(const PrecisionCase& what);
[[nodiscard]] Measurement measure(const PrecisionCase& what, const Setting& setting, double reference_peak);

}  // namespace bench
