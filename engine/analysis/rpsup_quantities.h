// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "engine/analysis/run_channels.h"
#include "engine/analysis/run_metrics.h"
#include "engine/analysis/sliding_work.h"
#include "engine/integrate/run_outcome.h"
#include "engine/model/rpsup.h"

namespace engine {

/// Sampled channels of an RPSUP linkage. Their readings refer to all arguments.
/// @param sliding_work  follows the run
[[nodiscard]] std::vector<Channel> rpsup_channels(const RpsupParameters& parameters, const Rpsup& rpsup,
                                                  const SlidingWork& sliding_work);

/// Quantities of an RPSUP linkage that RunMetrics measures.
[[nodiscard]] Measured rpsup_measured(const RpsupParameters& parameters, const Rpsup& rpsup);

/// The metrics of a run, in the order of metric_table().
/// @param metrics  of rpsup_measured()
/// @param ideal    the ideal linkage's peak in the steady window, if there is one
[[nodiscard]] std::vector<double> calc_rpsup_metrics(const RpsupParameters& parameters,
                                                     const RunMetrics& metrics,
                                                     const SlidingWork& sliding_work,
                                                     const RunOutcome& outcome,
                                                     const std::optional<Peak>& ideal);

}  // namespace engine
