// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "jobs/base/executor_names.h"

namespace jobs {

/// Takes jobs from the store, computes them, and leaves their results there. Nothing above it knows how. All
/// members may be called from any thread.
class Executor {
 public:
  Executor() = default;
  virtual ~Executor() = default;
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  /// There may be new jobs, or some that are not wanted any more.
  virtual void wake() = 0;
  /// Stops an attempt of a job if it is being computed; its record comes to nothing unless the store still
  /// wants it. A later attempt, of a job that was queued again, goes on.
  virtual void stop_job(const std::string& id, std::int64_t attempt) = 0;
  /// Part of its time that a running job has simulated; empty: not known.
  [[nodiscard]] virtual std::optional<double> find_part_done(const std::string& /*id*/) const { return {}; }
  /// Ends the executor's own threads. Returns when that is done.
  virtual void stop() = 0;
  /// {"name", "slots": how many jobs it can compute at a time, "tasks": {"pending", "running"}, "nodes":
  /// [...], "waiting": [...], "problems": [...]}: what it does beside computing jobs, what its tasks wait
  /// for, and what a human should know.
  [[nodiscard]] virtual nlohmann::json status() const = 0;
};

/// Jobs that an executor takes: those of sweeps that name it, or that name none if it is the default.
struct ExecutorFilter {
  std::string executor{kLocalExecutor};
  std::string default_executor{kLocalExecutor};  ///< of sweeps that name none, and of single jobs
};

}  // namespace jobs
