// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "engine/analysis/run_result.h"
#include "engine/model/run_options.h"
#include "jobs/parameters/job_spec.h"

namespace jobs {

/// Computes one job; tests put their own in the place of engine::simulate_rpsup.
using Runner = std::function<engine::RunResult(const JobSpec&, const engine::StopQuery&)>;

/// Record of one run of a job.
struct RunRecord {
  enum class End { kSucceeded, kFailed, kStopped };

  End end = End::kSucceeded;
  nlohmann::json metrics;          ///< object by key, null for what does not apply; null unless succeeded
  /// Of a failure: engine::status_name, "time_limit", "memory_limit" or "internal"
  std::string error_reason;
  std::string error_detail;
  std::optional<double> error_t_s; ///< simulated time reached; empty if unknown
  /// As far as the run came; all channels but the time marked as of single precision
  engine::Trajectory trajectory;
  double wall_time_s = 0.0;
  double cpu_time_s = 0.0;
};

/// Told what a run of a job left. Must not throw.
using RunListener = std::function<void(const JobSpec&, const RunRecord&)>;

/// Runs one job on this thread and measures it. Whatever the runner throws becomes a failure with the reason
/// "internal", or "memory_limit" if it is NeedsTooMuchMemory or that the machine has none left.
/// @param spec  may be filled in by the runner; its linkage says which metrics there are
/// @param most_s  wall time after which the run is stopped and has failed with the reason "time_limit"; 0:
///     none
[[nodiscard]] RunRecord run_and_record(const JobSpec& spec, const Runner& runner,
                                       const engine::StopQuery& stop_requested, double most_s = 0.0);

/// The engine as a runner.
[[nodiscard]] Runner engine_runner();

}  // namespace jobs
