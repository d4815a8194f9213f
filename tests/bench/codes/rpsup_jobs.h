// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/simulate_rpsup.h"
#include "tests/bench/codes/code_run.h"

namespace bench {

/// Runs a job as the service does: all channels and metrics.
/// @throws std::runtime_error if it fails
[[nodiscard]] CodeRun run_rpsup(const engine::RpsupParameters& parameters, const engine::RunOptions& options);

/// Processor time of one right-hand side of ours with every ring in contact, [s].
[[nodiscard]] double time_rpsup_evaluation(const engine::RpsupParameters& parameters);

}  // namespace bench
