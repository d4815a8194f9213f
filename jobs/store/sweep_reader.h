// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "jobs/store/idempotency_record.h"
#include "jobs/store/plan_costs.h"
#include "jobs/store/queue_stats.h"
#include "jobs/store/rows.h"
#include "jobs/store/store_core.h"
#include "jobs/trajectories/trajectory_codec.h"

namespace jobs {

/// Reader of sweeps, jobs and their results. May be called from any thread. Throws StorageError.
class SweepReader {
 public:
  explicit SweepReader(StoreCore& core) : core_(core) {}

  [[nodiscard]] std::optional<SweepRow> find_sweep(const std::string& id) const;
  [[nodiscard]] PlanCosts find_costs(const SweepPlan& plan) const;
  /// @returns whether no job of the sweep is left to compute; empty if there is no such sweep. The cost is
  /// the same for sweeps of any size.
  [[nodiscard]] std::optional<bool> has_sweep_ended(const std::string& id) const;
  [[nodiscard]] std::optional<JobRow> find_job(const std::string& id) const;
  /// @returns whether a job has ended; empty if there is no such job
  [[nodiscard]] std::optional<bool> has_job_ended(const std::string& id) const;
  /// Newest first. @param state empty: all  @param before  an id; empty: the newest
  [[nodiscard]] std::vector<SweepRow> list_sweeps(const std::string& state, const std::string& before,
                                                  std::size_t limit) const;
  [[nodiscard]] std::vector<JobRow> list_jobs(const std::string& state, const std::string& before,
                                              std::size_t limit) const;
  [[nodiscard]] std::optional<SweepResults> find_results(
      const std::string& sweep_id, RowParameters parameters = RowParameters::kNone) const;
  /// The jobs of a sweep that have ended after that change, by change.
  [[nodiscard]] std::vector<ResultRow> find_ended(const std::string& sweep_id, std::int64_t after) const;
  /// The same of all that a listener is told; 0: since the beginning.
  [[nodiscard]] std::optional<SweepChanges> find_changes(const std::string& sweep_id,
                                                         std::int64_t after) const;
  /// The packed trajectory of a job that has one.
  [[nodiscard]] std::optional<std::string> find_trajectory(const std::string& job_id) const;
  /// Calls use() with the blob of a job's trajectory, which is read part by part. False if there is none.
  bool read_trajectory(const std::string& job_id, const std::function<void(const StoredBytes&)>& use) const;
  /// Response that is stored under an idempotency key, for a week.
  [[nodiscard]] std::optional<StoredResponse> find_response(const std::string& key) const;
  /// @throws StorageError if the store cannot be read, or its file is not under its name any more
  void check() const;
  [[nodiscard]] QueueStats read_queue_stats() const;

 private:
  StoreCore& core_;
};

}  // namespace jobs
