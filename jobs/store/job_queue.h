// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/requests/expand.h"
#include "jobs/requests/sweep_description.h"
#include "jobs/runs/executor.h"
#include "jobs/runs/run_record.h"
#include "jobs/store/idempotency_record.h"
#include "jobs/store/rows.h"
#include "jobs/store/store_core.h"

namespace jobs {

enum class CancelOutcome { kMissing, kDone, kEnded };

/// Job that is being computed.
struct RunningJob {
  std::string id;
  std::int64_t attempt = 0;
};

struct Cancellation {
  CancelOutcome outcome = CancelOutcome::kMissing;
  std::vector<RunningJob> running;  ///< those that were being computed
};

enum class DeleteOutcome { kMissing, kDone, kNotEnded, kOfStudy, kOfSweep };

/// Queue of the jobs: adds, claims, records, cancels and deletes them. May be called from any thread. Throws
/// StorageError.
class JobQueue {
 public:
  explicit JobQueue(StoreCore& core) : core_(core) {}

  /// Stores a sweep with its jobs, those whose result is known as succeeded. Returns its id.
  /// @throws QueueFull if more than max_queued jobs would wait
  std::string add_sweep(const SweepPlan& plan, const std::string& request, std::size_t max_queued,
                        const IdempotencyRecord<SweepRow>& idempotency = {});
  /// Stores nothing, and throws what add_sweep() would. Takes as long.
  void check_sweep(const SweepPlan& plan, const std::string& request, std::size_t max_queued);
  std::string add_job(const PlannedJob& job, std::size_t max_queued,
                      const IdempotencyRecord<JobRow>& idempotency = {});
  /// Adds jobs to a sweep and replaces its request. The sweep's study, if there is one, goes on. False, and
  /// nothing is stored, if the request is not `former` any more.
  bool extend_sweep(const std::string& id, const std::string& former, const std::string& request,
                    const std::vector<PlannedJob>& jobs, std::size_t max_queued);
  /// Adds cases to the request of a sweep that has some, and their jobs, however many wait: its study has
  /// been accepted, and would not go on. False, and nothing is stored, if there is no such sweep.
  bool add_cases(const std::string& id, const nlohmann::ordered_json& cases,
                 const std::vector<PlannedJob>& jobs);
  /// Queues the failed and cancelled jobs of a sweep again; those whose result has become known succeed at
  /// once. The sweep's study, if there is one, goes on. False if there is no such sweep.
  bool retry_sweep(const std::string& id, std::size_t max_queued);
  /// Gives the queued jobs of a sweep to another executor, also those that wait in a cluster's queue. False
  /// if there is no such sweep. @throws WrongState if the sweep has ended
  bool move_sweep(const std::string& id, const std::string& executor);
  /// Changes what people have written on a sweep. False if there is no such sweep.
  bool describe_sweep(const std::string& id, const SweepDescription& changes);

  /// Claims a job: of the sweeps of the highest priority the one that was served least recently, of that
  /// sweep the first job whose content nobody is computing.
  /// @param on_claim  called before anybody can see the job as running; if it throws, no job is claimed
  [[nodiscard]] std::optional<ClaimedJob> claim(const ExecutorFilter& filter = {},
                                                const OnClaim& on_claim = {});
  /// Stores the result of a run, and completes queued jobs of the same content. False, and nothing is stored,
  /// if the job is no longer this attempt's, as after a cancellation.
  bool record(const ClaimedJob& job, const RunRecord& record);
  /// record() and then claim() in one transaction, which costs less.
  [[nodiscard]] std::optional<ClaimedJob> record_and_claim(const ClaimedJob& job, const RunRecord& record,
                                                           const ExecutorFilter& filter,
                                                           const OnClaim& on_claim);
  /// Queues a job again that was not computed to its end. Nothing happens if it is no longer this attempt's.
  void requeue(const ClaimedJob& job);

  [[nodiscard]] Cancellation cancel_sweep(const std::string& id);
  /// Cancels a study that runs, and its jobs. Of a study that has ended, only the jobs.
  [[nodiscard]] Cancellation cancel_study(const std::string& id);
  [[nodiscard]] Cancellation cancel_job(const std::string& id);
  /// Deletes a sweep that has ended, and its study with it.
  /// @param study  id of that study; kOfStudy if the sweep has another one
  [[nodiscard]] DeleteOutcome delete_sweep(const std::string& id, const std::string& study = {});

  /// Deletes a job that has ended and is of no sweep.
  [[nodiscard]] DeleteOutcome delete_job(const std::string& id);

 private:
  struct Outcome;  ///< result of a run as it is stored

  [[nodiscard]] std::optional<ClaimedJob> claim(Statements& statements, const ExecutorFilter& filter,
                                                const OnClaim& on_claim);
  /// Scheduling order of an executor, found again if something may have queued jobs since the last claim.
  [[nodiscard]] std::set<SweepTurn>& find_turns(Statements& statements, const ExecutorFilter& filter);
  bool record(Statements& statements, const ClaimedJob& job, const Outcome& outcome);
  DeleteOutcome delete_sweep(SQLite::Database& database, const std::string& id, const std::string& study);
  /// Deletes the last jobs of a sweep that may be deleted. @returns whether jobs are left
  bool delete_some_jobs(const std::string& id, const std::string& study);
  /// Adds jobs to a sweep. False if there is none.
  bool add_jobs(SQLite::Database& database, const std::string& id, const std::vector<PlannedJob>& jobs,
                std::size_t max_queued);

  StoreCore& core_;
};

}  // namespace jobs
