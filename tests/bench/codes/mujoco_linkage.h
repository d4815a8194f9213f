// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/bench/codes/code_run.h"
#include "tests/bench/codes/plain_linkage.h"

namespace bench {

enum class MujocoIntegrator { kEuler, kRk4 };

/// Runs a linkage in MuJoCo from rest. The joint's memory of contacts is used up: a linkage runs once.
/// @param step, duration  [s]
[[nodiscard]] CodeRun run_mujoco(const PlainLinkage& plain, MujocoIntegrator integrator, double step,
                                 double duration);

/// Processor time of MuJoCo's mj_forward with the linkage as it starts, [s].
[[nodiscard]] double time_mujoco_evaluation(const PlainLinkage& plain);

}  // namespace bench
