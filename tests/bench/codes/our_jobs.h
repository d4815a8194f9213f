// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "engine/simulate_linkage.h"
#include "engine/simulate_rpsup.h"
#include "tests/bench/codes/code_run.h"

namespace bench {

/// Runs a job as the service does: all channels and metrics.
/// @throws std::runtime_error if it fails
[[nodiscard]] CodeRun run_rpsup(const engine::RpsupParameters& parameters, const engine::RunOptions& options);
/// The same of a described linkage.
/// @param measured  freedom whose peak acceleration counts, a rotation
[[nodiscard]] CodeRun run_linkage(const engine::Linkage& linkage, const std::string& measured,
                                  const engine::RunOptions& options);

/// Processor time of one right-hand side of ours with every ring in contact, the drives' laws included, [s].
/// @param instruction_set  one of engine::instruction_sets(); empty: the best one
[[nodiscard]] double time_rpsup_evaluation(const engine::RpsupParameters& parameters,
                                           std::string_view instruction_set);
/// The same of a mechanism as it starts.
[[nodiscard]] double time_evaluation(const engine::Mechanism& mechanism, std::string_view instruction_set);

}  // namespace bench
