// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string_view>

#include "engine/simulate_linkage.h"
#include "validation/support/runs.h"

namespace validation {

inline constexpr const char* kStepTolerance = "the steps' tolerance of 1e-10";

/// A run of a described linkage that must succeed.
[[nodiscard]] inline RunResult run_linkage(const Linkage& linkage, const RunOptions& options) {
  RunResult result = simulate_linkage(linkage, options, 0.0, {});
  if (result.status != RunStatus::kSucceeded)
    throw std::runtime_error("a run of the validation failed: " + result.detail);
  return result;
}

/// The same, in steps of a tolerance of 1e-10.
[[nodiscard]] inline RunResult run_linkage(const Linkage& linkage, Integrator integrator, double duration,
                                           double output_rate = 100.0) {
  return run_linkage(linkage, RunOptions{.duration = duration,
                                         .output_rate = output_rate,
                                         .integrator = integrator,
                                         .relative_tolerance = 1e-10,
                                         .absolute_tolerance = 1e-10});
}

/// A metric of a described linkage's run by its key.
[[nodiscard]] inline double metric_of(const Linkage& linkage, const RunResult& run, std::string_view key) {
  const LinkageTables tables = linkage_tables(linkage);
  for (std::size_t i = 0; i < tables.metrics.size(); ++i)
    if (tables.metrics[i].key == key) return run.metrics.at(i);
  throw std::out_of_range("no metric of that key");
}

}  // namespace validation
