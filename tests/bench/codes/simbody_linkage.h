// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/bench/codes/code_run.h"
#include "tests/bench/codes/plain_linkage.h"

namespace bench {

/// Runs a linkage in Simbody from rest, by Runge-Kutta-Merson with error control. The joint's memory of
/// contacts is used up: a linkage runs once.
/// @param accuracy  Simbody's measure of relative accuracy, [1]
/// @param duration  [s]
[[nodiscard]] CodeRun run_simbody(const PlainLinkage& plain, double accuracy, double duration);

/// Processor time of realizing Simbody's accelerations anew with the linkage as it starts, [s].
[[nodiscard]] double time_simbody_evaluation(const PlainLinkage& plain);

}  // namespace bench
