// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "jobs/base/provenance.h"
#include "jobs/runs/executor.h"
#include "jobs/store/rows.h"
#include "jobs/store/store_core.h"

namespace jobs {

/// Jobs that a cluster computes, many at a time: a batch is a list of jobs of one sweep. May be called from
/// any thread. Throws StorageError.
class ClusterBatches {
 public:
  explicit ClusterBatches(StoreCore& core) : core_(core) {}

  /// Claims jobs of the sweep whose turn it is, as JobQueue::claim() does. They count as queued until
  /// set_running().
  [[nodiscard]] std::optional<BatchRow> claim(const ExecutorFilter& filter, std::size_t most_jobs);
  [[nodiscard]] std::vector<BatchRow> list() const;
  /// Indices of a batch's jobs that are still to be computed; ascending.
  [[nodiscard]] std::vector<std::uint32_t> find_open_indices(std::int64_t batch) const;
  /// The jobs of those indices.
  [[nodiscard]] std::vector<BatchJob> find_open_jobs(std::int64_t batch) const;
  /// Stores results of a batch, and completes queued jobs of the same content. Leaves out results of jobs
  /// that are not open any more, or whose content is of another engine. Returns how many were stored.
  std::size_t record(std::int64_t batch, const Provenance& provenance,
                     const std::vector<BatchRecord>& records);
  /// Marks jobs of a batch as running, and others as waiting again.
  void set_running(std::int64_t batch, const std::vector<std::uint32_t>& running,
                   const std::vector<std::uint32_t>& waiting);
  /// Deletes a batch; its open jobs can be claimed again.
  void end(std::int64_t batch);
  /// Mean wall time of a simulated second of the newest results, by PlannedJob::kind, [s].
  [[nodiscard]] std::map<std::string, double> find_cost_rates() const;
  /// Identity of this store among all others.
  [[nodiscard]] std::string find_identity() const;

 private:
  StoreCore& core_;
};

/// Releases the jobs of batches that a former program with another engine made: their results would be that
/// engine's.
void release_batches_of_other_engines(SQLite::Database& database);

}  // namespace jobs
