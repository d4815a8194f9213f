// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/model/rpsup_parameters.h"

namespace engine {

/// One column of a trajectory or one metric.
struct QuantityInfo {
  std::string key;                ///< name, which ends in the unit
  std::string help;               ///< definition: one phrase, noun first
  std::string symbol{};           ///< of the paper, if it has one: see SYMBOLS.md
  bool integer = false;           ///< metrics: a count
  bool single_precision = false;  ///< channels: 24 bits are enough to store it (poses that are drawn)
};

/// Samples at k / output_rate, k = 0, 1, ...; a last one at the end of the run if that falls between two.
struct Trajectory {
  std::vector<QuantityInfo> channels;        ///< the first one is t_s
  std::vector<std::vector<double>> columns;  ///< one a channel, all of one length
};

/// The metrics that every run yields, in the order of RunResult::metrics.
[[nodiscard]] std::span<const QuantityInfo> metric_table();

/// The channels of a run with these parameters (a flexible coupler has a pose for each of its elements).
[[nodiscard]] std::vector<QuantityInfo> channel_table(const RpsupParameters& parameters);

}  // namespace engine
