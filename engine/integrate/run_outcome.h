// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "engine/model/run_options.h"

namespace engine {

/// End of a run: status, time reached, cost.
struct RunOutcome {
  RunStatus status = RunStatus::kSucceeded;
  double t = 0.0;        ///< reached, [s]
  std::string detail;    ///< of a failure, for the user
  int redundant_constraints = 0;  ///< their multipliers are those of minimum norm
  long steps = 0;        ///< accepted
  long evaluations = 0;  ///< of the equations of motion, rejected steps' included
};

}  // namespace engine
