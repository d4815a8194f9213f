// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "engine/simulate_rpsup.h"
#include "validation/engine_names.h"

namespace validation {

/// A metric of a finished run by its key.
[[nodiscard]] inline double metric(const RunResult& run, std::string_view key) {
  const auto table = metric_table();
  for (std::size_t i = 0; i < table.size(); ++i)
    if (table[i].key == key) return run.metrics.at(i);
  throw std::out_of_range(std::string(key));
}

/// A channel of a run by its key.
[[nodiscard]] inline const std::vector<double>& column(const RunResult& run, std::string_view key) {
  for (std::size_t i = 0; i < run.trajectory.channels.size(); ++i)
    if (run.trajectory.channels[i].key == key) return run.trajectory.columns[i];
  throw std::out_of_range(std::string(key));
}

/// A run that must succeed.
[[nodiscard]] inline RunResult run_rpsup(const RpsupParameters& parameters, const RunOptions& options) {
  RunResult run = simulate_rpsup(parameters, options, {});
  if (run.status != RunStatus::kSucceeded)
    throw std::runtime_error("a run of the validation failed: " + run.detail);
  return run;
}

}  // namespace validation
