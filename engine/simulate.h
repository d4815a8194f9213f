#pragma once

#include <string>

#include "engine/integrate/observer.h"
#include "engine/model/mechanism.h"
#include "engine/run_options.h"

namespace engine {

/// How a run ended, and what it took.
struct RunEnd {
  RunStatus status = RunStatus::kSucceeded;
  double t = 0.0;
  std::string detail;    ///< of a failure, for the user
  long steps = 0;        ///< accepted
  long evaluations = 0;  ///< of the equations of motion, rejected steps' included
};

/// Runs a mechanism from its assembled position, at rest but for what the drives ask at t = 0.
///
/// A mechanism whose drives alone decide its motion is solved at each instant, not integrated, unless the paper's fixed-step method
/// (or drives with multipliers) is asked for.
[[nodiscard]] RunEnd simulate(const Mechanism& mechanism, const RunOptions& options, Observer& observer);

}  // namespace engine
