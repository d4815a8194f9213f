// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
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
#include "jobs/base/states.h"
#include "jobs/runs/executor.h"
#include "jobs/runs/run_record.h"
#include "jobs/store/load.h"
#include "jobs/store/store_connection.h"
#include "jobs/store/store_room.h"

namespace jobs {

/// How many jobs of a sweep are in each state, by JobState.
using StateCounts = std::array<std::int64_t, kJobStates.size()>;

/// What is left to compute of a sweep, and what its jobs have cost so far, by PlannedJob::kind.
struct CostOfKind {
  std::int64_t queued = 0, running = 0;
  std::int64_t computed = 0;        ///< ended jobs that were computed, not reused
  double wall_time_s = 0.0;         ///< of those together, each on one thread
  double wall_time_squares_s2 = 0;  ///< the sum of their squares
};

struct SweepRow {
  std::string id, name;
  std::string request;                               ///< empty in listings and changes
  std::string swept;
  bool replicated = false;
  std::int64_t priority = 0;
  std::string executor;                              ///< empty: it named none
  std::int64_t created_ms = 0;
  std::optional<std::int64_t> started_ms, ended_ms;  ///< of its first job, and of its last one if all have ended
  StateCounts counts{};
  std::map<std::string, CostOfKind> costs;           ///< only of sweeps that have not ended
};

/// The run behind a result.
struct RunRow {
  double wall_time_s = 0.0, cpu_time_s = 0.0;
  std::string host, cpu, version, commit, compiler, engine;
  std::string libm, numerics;  ///< empty: of a time when they were not noted
};

struct JobRow {
  std::string id;
  std::optional<std::string> sweep_id;
  std::optional<std::int64_t> replicate;
  std::string state;
  std::string parameters;              ///< empty in listings
  std::optional<std::string> metrics;  ///< empty in listings
  std::optional<std::string> error_reason;
  std::string error_detail;
  std::optional<double> error_t_s;
  std::int64_t created_ms = 0;
  std::optional<std::int64_t> started_ms, ended_ms;
  std::int64_t attempts = 0;
  bool reused = false;
  std::optional<RunRow> run;
};

/// Study: a search or a wear study, whose evaluations are the jobs of a sweep.
struct StudyRow {
  std::string id, sweep_id, name, request, state;
  std::optional<std::string> error;  ///< why it could not go on
  std::int64_t created_ms = 0;
  std::optional<std::int64_t> ended_ms;
};

/// One job's line in the table of its sweep.
struct ResultRow {
  std::string job_id, state, swept;
  std::optional<std::int64_t> replicate;
  std::optional<std::string> metrics;
  std::string parameters{};  ///< only if they were asked for
  std::int64_t change = 0;   ///< EndedJob::change; 0: it has not ended
  std::optional<std::string> error_reason{}, error_detail{};  ///< of what failed
};

/// All jobs of a sweep in one snapshot of the store.
struct SweepResults {
  SweepRow sweep;
  std::vector<ResultRow> rows;  ///< in the order in which the sweep was expanded, what was added to it later last
};

/// Study with its jobs, in one snapshot of the store.
struct StudySnapshot {
  StudyRow study;
  SweepResults results;
};

/// A job that has ended.
struct EndedJob {
  std::int64_t change = 0;  ///< grows from end to end; what ended in one transaction shares it
  std::string id, state;
  std::optional<std::string> error_reason;
  std::int64_t ended_ms = 0;
  bool reused = false;
};

/// What has happened to a sweep since a change.
struct SweepChanges {
  SweepRow sweep;
  std::vector<EndedJob> ended;  ///< by change
};

/// How the answer to a request is kept, so that the same request sent again gets it again.
template <typename Row>
struct KeptAnswer {
  std::string key;                                  ///< chosen by the client; empty: nothing is kept
  std::string request;                              ///< what tells the request from others
  std::function<std::string(const Row&)> make_text; ///< the answer
};

struct FoundAnswer {
  std::string request, text;
};

/// A job that a worker has taken.
struct ClaimedJob {
  std::int64_t seq = 0;
  std::string id;
  std::int64_t attempt = 0;  ///< a record must name it: what an earlier attempt left is void
  std::string parameters;
};

/// Told of a job as it is being claimed.
using Taken = std::function<void(const ClaimedJob&)>;

/// Jobs that were given to a cluster together.
struct BatchRow {
  std::int64_t seq = 0;
  std::string id, sweep_id;  ///< the latter empty: of single jobs
};

/// A job of a batch.
struct PlacedJob {
  std::uint32_t place = 0;
  std::string parameters, kind;
  double duration_s = 0.0;   ///< simulated
};

/// What a job of a batch has come to.
struct PlacedRecord {
  std::uint32_t place = 0;
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
  explicit Store(const std::filesystem::path& file, const StoreRoom& room = {});

  /// Engine for which the newest job was planned when the store was opened; this program's own in a new store.
  [[nodiscard]] const std::string& engine_before() const { return engine_before_; }

  /// Stores a sweep with its jobs, those whose result is known as succeeded. Returns its id.
  /// @throws QueueFull if more than max_queued jobs would wait
  std::string add_sweep(const SweepPlan& plan, const std::string& request, std::size_t max_queued, const KeptAnswer<SweepRow>& kept = {});
  std::string add_job(const PlannedJob& job, std::size_t max_queued, const KeptAnswer<JobRow>& kept = {});
  /// The answer that is kept under a key, for a week.
  [[nodiscard]] std::optional<FoundAnswer> find_answer(const std::string& key) const;

  /// Adds jobs to a sweep and replaces its request. False, and nothing is stored, if the request is not `former` any more.
  bool extend_sweep(const std::string& id, const std::string& former, const std::string& request, const std::vector<PlannedJob>& jobs,
                    std::size_t max_queued);
  /// Adds cases to the request of a sweep that has some, and their jobs. False, and nothing is stored, if there is no such sweep.
  bool add_cases(const std::string& id, const nlohmann::ordered_json& cases, const std::vector<PlannedJob>& jobs);
  /// Queues the failed and cancelled jobs of a sweep again; those whose result has become known succeed at once. Its study, if it has one,
  /// goes on. False if there is no such sweep.
  bool retry_sweep(const std::string& id, std::size_t max_queued);

  /// Takes a job: of the sweeps of the highest priority the one that was served least recently, of that the first whose content
  /// nobody is computing. @param taken  told of it before anybody can see it as running; if it throws, no job is taken
  [[nodiscard]] std::optional<ClaimedJob> claim(const Lane& lane = {}, const Taken& taken = {});
  /// Stores what a run left, and settles every queued job of the same content. False, and nothing is stored, if the job
  /// is no longer this attempt's (it was cancelled).
  bool record(const ClaimedJob& job, const RunRecord& record);
  /// Does both, which costs less together: record() and then claim(), or nothing if either fails.
  [[nodiscard]] std::optional<ClaimedJob> record_and_claim(const ClaimedJob& job, const RunRecord& record, const Lane& lane, const Taken& taken);
  /// Puts a job back that was not computed to its end. Nothing happens if it is no longer this attempt's.
  void give_back(const ClaimedJob& job);

  /// Takes jobs of one sweep for a cluster, whose turn it is as in claim(). They count as queued until they are said to run.
  [[nodiscard]] std::optional<BatchRow> claim_batch(const Lane& lane, std::size_t most_jobs);
  [[nodiscard]] std::vector<BatchRow> find_batches() const;
  /// The places of a batch whose jobs are still to be computed; ascending.
  [[nodiscard]] std::vector<std::uint32_t> find_wanted(std::int64_t batch) const;
  /// The same with all about them.
  [[nodiscard]] std::vector<PlacedJob> find_placed(std::int64_t batch) const;
  /// Stores what became of jobs of a batch, and settles queued jobs of the same content. What is not wanted any more, or was computed by another
  /// engine than it should have been, is left out. Returns how many were stored.
  std::size_t record_placed(std::int64_t batch, const Provenance& provenance, const std::vector<PlacedRecord>& records);
  /// Says which jobs of a batch have begun to run, and which wait again.
  void mark_placed(std::int64_t batch, const std::vector<std::uint32_t>& running, const std::vector<std::uint32_t>& waiting);
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
  /// @param parameters  whether rows carry all parameters
  [[nodiscard]] std::optional<SweepResults> find_results(const std::string& sweep_id, bool parameters) const;
  /// The jobs of a sweep that have ended after that change, by change.
  [[nodiscard]] std::vector<ResultRow> find_ended(const std::string& sweep_id, std::int64_t after) const;
  /// What has ended after that change; 0: everything.
  [[nodiscard]] std::optional<SweepChanges> find_changes(const std::string& sweep_id, std::int64_t after) const;
  /// Stores a study with the sweep of its first evaluations. Returns its id. @throws QueueFull as add_sweep does
  /// @param prefix  of its id: the type of the study
  std::string add_study(std::string_view prefix, const SweepPlan& plan, const std::string& sweep_request, const std::string& request,
                         std::size_t max_queued, const KeptAnswer<StudySnapshot>& kept = {});
  [[nodiscard]] std::optional<StudyRow> find_study(const std::string& id) const;
  /// Studies of one type, newest first. @param state empty: all  @param before  an id; empty: the newest
  [[nodiscard]] std::vector<StudyRow> list_studies(std::string_view prefix, const std::string& state, const std::string& before, std::size_t limit) const;
  /// Gives a study another state. False, and nothing is stored, if it is not in the former one.
  bool set_study_state(const std::string& id, const std::string& former, const std::string& state, const std::optional<std::string>& error = {});

  [[nodiscard]] Load find_load() const;
  /// The packed trajectory of a job that has one.
  [[nodiscard]] std::optional<std::string> find_trajectory(const std::string& job_id) const;

 private:
  struct Outcome;  ///< what a run left, as it is stored

  /// Puts what was running when the process ended back into the queue.
  void begin();
  [[nodiscard]] std::optional<ClaimedJob> claim(Statements& statements, const Lane& lane, const Taken& taken);
  bool record(Statements& statements, const ClaimedJob& job, const Outcome& outcome);
  void check_quota_of(SQLite::Database& database) const;
  /// Adds jobs to a sweep. False if there is none.
  bool add_jobs(SQLite::Database& database, const std::string& id, const std::vector<PlannedJob>& jobs, std::size_t max_queued);

  const std::filesystem::path file_;
  const StoreRoom room_;
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

/// The state of a sweep as its jobs make it.
[[nodiscard]] std::string_view sweep_state(const StateCounts& counts);
[[nodiscard]] bool has_ended(const StateCounts& counts);

}  // namespace jobs
