// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/base/ids.h"
#include "jobs/base/provenance.h"
#include "jobs/requests/expand.h"
#include "jobs/runs/executor.h"
#include "jobs/runs/run_record.h"
#include "jobs/store/queue_stats.h"
#include "jobs/store/rows.h"
#include "jobs/store/store_connection.h"
#include "jobs/store/store_quota.h"

namespace jobs {

/// Response that is stored with the row that a request makes, so that the same request sent again gets it again: the
/// Idempotency-Key header field of the IETF draft of that name.
template <typename Row>
struct IdempotencyRecord {
  std::string key;          ///< chosen by the client; empty: nothing is stored
  std::string fingerprint;  ///< identifies the request: method, route and hash of the body
  std::function<std::string(const Row&)> make_response;
};

struct StoredResponse {
  std::string fingerprint, text;
};

/// Job that a worker has claimed.
struct ClaimedJob {
  std::int64_t seq = 0;
  std::string id;
  std::int64_t attempt = 0;  ///< a record must name it: what an earlier attempt left is void
  std::string parameters;
};

/// Called with a job while it is being claimed.
using OnClaim = std::function<void(const ClaimedJob&)>;

/// Jobs that are given to a cluster together.
struct BatchRow {
  std::int64_t seq = 0;
  std::string id, sweep_id;  ///< the latter empty: of single jobs
};

/// A job of a batch.
struct BatchJob {
  std::uint32_t batch_index = 0;
  std::string parameters, kind;
  double duration_s = 0.0;   ///< simulated
};

/// Result of a job of a batch.
struct BatchRecord {
  std::uint32_t batch_index = 0;
  const RunRecord* record = nullptr;           ///< its trajectory is not looked at
  const std::string* packed_trajectory = nullptr;  ///< by encode_trajectory; empty: none
};

enum class CancelOutcome { kMissing, kDone, kEnded };

struct Cancellation {
  CancelOutcome outcome = CancelOutcome::kMissing;
  std::vector<std::string> running;  ///< jobs that were being computed
};

enum class DeleteOutcome { kMissing, kDone, kNotEnded };

/// Everything that is kept on disk, and all the SQL. May be called from any thread. Throws StorageError.
/// Of what is kept, no time is before one that it follows, even if the clock is set back in between.
class Store {
 public:
  /// Opens or makes the file, and queues again what a former process left running.
  /// @param room  what would add to more is a StoreLimitReached, while reading, cancelling and deleting go on
  explicit Store(const std::filesystem::path& file, const StoreQuota& room = {});

  /// Engine for which the newest job was planned when the store was opened; this program's own in a new store.
  [[nodiscard]] const std::string& engine_before() const { return engine_before_; }

  /// Stores a sweep with its jobs, those whose result is known as succeeded. Returns its id.
  /// @throws QueueFull if more than max_queued jobs would wait
  std::string add_sweep(const SweepPlan& plan, const std::string& request, std::size_t max_queued, const IdempotencyRecord<SweepRow>& idempotency = {});
  std::string add_job(const PlannedJob& job, std::size_t max_queued, const IdempotencyRecord<JobRow>& idempotency = {});
  /// Response that is stored under a key, for a week.
  [[nodiscard]] std::optional<StoredResponse> find_response(const std::string& key) const;

  /// Adds jobs to a sweep and replaces its request. False, and nothing is stored, if the request is not `former` any more.
  bool extend_sweep(const std::string& id, const std::string& former, const std::string& request, const std::vector<PlannedJob>& jobs,
                    std::size_t max_queued);
  /// Adds cases to the request of a sweep that has some, and their jobs. False, and nothing is stored, if there is no such sweep.
  bool add_cases(const std::string& id, const nlohmann::ordered_json& cases, const std::vector<PlannedJob>& jobs);
  /// Queues the failed and cancelled jobs of a sweep again; those whose result has become known succeed at once. Its study, if it has one,
  /// goes on. False if there is no such sweep.
  bool retry_sweep(const std::string& id, std::size_t max_queued);

  /// Takes a job: of the sweeps of the highest priority the one that was served least recently, of that the first whose content
  /// nobody is computing. @param on_claim  told of it before anybody can see it as running; if it throws, no job is on_claim
  [[nodiscard]] std::optional<ClaimedJob> claim(const ExecutorFilter& filter = {}, const OnClaim& on_claim = {});
  /// Stores what a run left, and settles every queued job of the same content. False, and nothing is stored, if the job
  /// is no longer this attempt's (it was cancelled).
  bool record(const ClaimedJob& job, const RunRecord& record);
  /// Does both, which costs less together: record() and then claim(), or nothing if either fails.
  [[nodiscard]] std::optional<ClaimedJob> record_and_claim(const ClaimedJob& job, const RunRecord& record, const ExecutorFilter& filter, const OnClaim& on_claim);
  /// Puts a job back that was not computed to its end. Nothing happens if it is no longer this attempt's.
  void requeue(const ClaimedJob& job);

  /// Takes jobs of one sweep for a cluster, whose turn it is as in claim(). They count as queued until they are said to run.
  [[nodiscard]] std::optional<BatchRow> claim_batch(const ExecutorFilter& filter, std::size_t most_jobs);
  [[nodiscard]] std::vector<BatchRow> find_batches() const;
  /// Indices of a batch's jobs that are still to be computed; ascending.
  [[nodiscard]] std::vector<std::uint32_t> find_open_indices(std::int64_t batch) const;
  /// The jobs of those indices.
  [[nodiscard]] std::vector<BatchJob> find_open_jobs(std::int64_t batch) const;
  /// Stores what became of jobs of a batch, and settles queued jobs of the same content. What is not wanted any more, or was computed by another
  /// engine than it should have been, is left out. Returns how many were stored.
  std::size_t record_batch(std::int64_t batch, const Provenance& provenance, const std::vector<BatchRecord>& records);
  /// Says which jobs of a batch have begun to run, and which wait again.
  void set_running(std::int64_t batch, const std::vector<std::uint32_t>& running, const std::vector<std::uint32_t>& waiting);
  /// Forgets a batch; what it has not computed is free to be taken again.
  void end_batch(std::int64_t batch);
  /// Mean wall time of a simulated second of the newest results, by PlannedJob::kind, [s].
  [[nodiscard]] std::map<std::string, double> find_cost_rates() const;
  /// This store among all others.
  [[nodiscard]] std::string find_identity() const;
  /// Gives the queued jobs of a sweep to another executor, those that wait in a cluster's queue, too. False if there is no such sweep.
  /// @throws WrongState if it has ended
  bool move_sweep(const std::string& id, const std::string& executor);

  [[nodiscard]] Cancellation cancel_sweep(const std::string& id);
  [[nodiscard]] Cancellation cancel_job(const std::string& id);
  [[nodiscard]] DeleteOutcome delete_sweep(const std::string& id);
  /// Makes the file smaller by what deleting has freed, which needs room on the disk for a while. What has not been released is used again.
  void release_free_pages() { writer_.release_free_pages(); }

  [[nodiscard]] std::optional<SweepRow> find_sweep(const std::string& id) const;
  /// Whether no job of the sweep is left to compute; empty if there is no such sweep. Costs the same for sweeps of any size.
  [[nodiscard]] std::optional<bool> has_sweep_ended(const std::string& id) const;
  [[nodiscard]] std::optional<JobRow> find_job(const std::string& id) const;
  [[nodiscard]] std::optional<bool> has_job_ended(const std::string& id) const;  ///< empty if there is no such job
  /// Newest first. @param state empty: all  @param before  an id; empty: the newest
  [[nodiscard]] std::vector<SweepRow> list_sweeps(const std::string& state, const std::string& before, std::size_t limit) const;
  [[nodiscard]] std::vector<JobRow> list_jobs(const std::string& state, const std::string& before, std::size_t limit) const;
  [[nodiscard]] std::optional<SweepResults> find_results(const std::string& sweep_id, RowParameters parameters = RowParameters::kNone) const;
  /// The jobs of a sweep that have ended after that change, by change.
  [[nodiscard]] std::vector<ResultRow> find_ended(const std::string& sweep_id, std::int64_t after) const;
  /// What has ended after that change; 0: everything.
  [[nodiscard]] std::optional<SweepChanges> find_changes(const std::string& sweep_id, std::int64_t after) const;
  /// Stores a study with the sweep of its first evaluations. Returns its id. @throws QueueFull as add_sweep does
  /// @param prefix  of its id: the type of the study
  std::string add_study(std::string_view prefix, const SweepPlan& plan, const std::string& sweep_request, const std::string& request,
                         std::size_t max_queued, const IdempotencyRecord<StudySnapshot>& idempotency = {});
  [[nodiscard]] std::optional<StudyRow> find_study(const std::string& id) const;
  /// Studies of one type, newest first. @param state empty: all  @param before  an id; empty: the newest
  [[nodiscard]] std::vector<StudyRow> list_studies(std::string_view prefix, const std::string& state, const std::string& before, std::size_t limit) const;
  /// Gives a study another state. False, and nothing is stored, if it is not in the former one.
  bool set_study_state(const std::string& id, const std::string& former, const std::string& state, const std::optional<std::string>& error = {});

  [[nodiscard]] QueueStats read_queue_stats() const;
  /// The packed trajectory of a job that has one.
  [[nodiscard]] std::optional<std::string> find_trajectory(const std::string& job_id) const;

 private:
  struct Outcome;  ///< what a run left, as it is stored

  /// Puts what was running when the process ended back into the queue.
  void begin();
  [[nodiscard]] std::optional<ClaimedJob> claim(Statements& statements, const ExecutorFilter& filter, const OnClaim& on_claim);
  bool record(Statements& statements, const ClaimedJob& job, const Outcome& outcome);
  void check_quota_of(SQLite::Database& database) const;
  /// Adds jobs to a sweep. False if there is none.
  bool add_jobs(SQLite::Database& database, const std::string& id, const std::vector<PlannedJob>& jobs, std::size_t max_queued);

  const std::filesystem::path file_;
  const StoreQuota room_;
  StoreLock lock_;
  // Readers close before the writer, which is then the one that empties the log.
  Writer writer_;
  mutable ReaderPool readers_;
  IdMaker ids_;
  // Which sweep was served when, as counted by claims; single jobs are sweep 0 together. Guarded by the writer's lock.
  std::map<std::int64_t, std::uint64_t> served_;
  std::uint64_t claims_ = 0;
  std::string engine_before_ = engine_version();  ///< engine of the newest content when the store was opened
  std::int64_t changes_ = 0;  ///< the last EndedJob::change; guarded by the writer's lock
};

/// Writes a consistent copy of a store, a store itself, to a file that does not exist. The store may be in use by any process, which goes on.
/// @param stop  asked now and then; true ends the copying, and there is no file
/// @returns whether there is a copy
bool copy_store(const std::filesystem::path& store, const std::filesystem::path& file, const std::function<bool()>& stop);

}  // namespace jobs
