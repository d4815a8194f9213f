// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/analysis/quantities.h"
#include "jobs/base/change_signal.h"
#include "jobs/base/in_flight_keys.h"
#include "jobs/base/study_kind.h"
#include "jobs/cluster/site.h"
#include "jobs/results/page_query.h"
#include "jobs/results/resource_json.h"
#include "jobs/results/result_query.h"
#include "jobs/results/result_table.h"
#include "jobs/runs/executor.h"
#include "jobs/runs/job_limits.h"
#include "jobs/runs/run_record.h"
#include "jobs/store/idempotency_record.h"
#include "jobs/store/queue_stats.h"
#include "jobs/store/rows.h"
#include "jobs/store/store_quota.h"
#include "jobs/trajectories/trajectory_query.h"
#include "jobs/trajectories/trajectory_view.h"

namespace jobs {

class Store;
class StudyRunner;
struct Cancellation;
struct Measurement;
struct SweepPlan;
struct TrajectoryExport;

/// Time at which a service begins to compute.
enum class Start { kAtOnce, kWhenTold };

struct ServiceOptions {
  std::filesystem::path store;  ///< the SQLite file; made if it does not exist
  int threads = 2;              ///< jobs computed at a time, >= 1
  std::size_t max_sweep_jobs = 10'000;
  std::size_t max_queued_jobs = 100'000;
  JobLimits job_limits{};  ///< of each job
  StoreQuota store_quota{};
  Start start = Start::kAtOnce;
  cluster::Site site{};            ///< the cluster; without a folder there is none
  std::string executor = "local";  ///< of sweeps that name none: "local", or "slurm" if there is a cluster
  Runner runner;                   ///< empty: the engine
  /// Told, from any thread, what needs a human's eye (a disk that is full, say); empty: nobody. Must not
  /// throw.
  std::function<void(const std::string&)> log;
  /// Told, from any thread, of each run on this machine before it is recorded; empty: nobody
  RunListener ran{};
};

/// News of a sweep since a change.
struct SweepNews {
  /// {"sweep_id", "state", "counts", "progress", "eta_s", "eta_low_s", "eta_high_s"}; of a study {"id",
  /// "sweep_id", "state", "counts", "progress"}
  nlohmann::json progress;
  bool ended = false;
  /// End of a job: {"job_id", "state", "error_reason", "ended_at", "reused"}.
  struct JobEvent {
    std::int64_t change = 0;  ///< EndedJob::change
    nlohmann::json job;
  };
  std::vector<JobEvent> jobs;  ///< by change
};

/// Service of sweeps, jobs and studies: validates, stores, computes and hands them out. One per store.
///
/// Every JSON it returns is the resource as the HTTP interface and the command line show it. All members may
/// be called from any thread. Exceptions: InvalidRequest (a faulty request; of a query "/limit", "/state",
/// "/cursor", "/fields/0", "/order_by/0", "/clearance_mm_gt", "/channels/0", "/from", "/to", "/points" are
/// the pointers), WrongState, StorageError, Stopped (of new work, after stop()).
class Service {
 public:
  /// Opens the store (its lock is held until destruction), queues again what a former process left running,
  /// and starts the pool if that is to be done at once.
  explicit Service(ServiceOptions options);
  ~Service();  ///< stop()
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// Starts the pool if it has not been started. Not beside calls of other members.
  void start();

  /// Stores a sweep and its jobs, or nothing at all. When it returns, the sweep survives a crash.
  /// @param request  order-preserving, since the axes multiply in the order in which they were written, the
  ///     last one fastest: parse the body with nlohmann::ordered_json::parse
  /// @throws QueueFull if more than max_queued_jobs would be waiting
  /// @param key  chosen by the client; for a week, the same request under the same key is answered as before,
  ///     and nothing new is stored. Another request under it is an InvalidRequest, one that comes while the
  ///     first is answered a WrongState. Empty: none
  nlohmann::json submit_sweep(const nlohmann::ordered_json& request, const std::string& key = {});
  /// Cost of a sweep that is not submitted: plan_estimate_json(), with "max_jobs" and "free_bytes".
  /// @throws InvalidRequest with every fault that submit_sweep() finds
  [[nodiscard]] nlohmann::json estimate_sweep(const nlohmann::ordered_json& request) const;
  nlohmann::json submit_job(const nlohmann::json& parameters, const std::string& key = {});

  /// Adds values to the axes of a sweep, and cases to its cases; only what is new is computed. See
  /// plan_extension().
  std::optional<nlohmann::json> extend_sweep(const std::string& id, const nlohmann::ordered_json& addition);
  /// Queues the failed and cancelled jobs of a sweep again; those that have succeeded stay.
  std::optional<nlohmann::json> retry_sweep(const std::string& id);
  /// Gives the queued jobs of a sweep to another executor; what is being computed stays where it is.
  /// @param request  {"executor": name}
  std::optional<nlohmann::json> move_sweep(const std::string& id, const nlohmann::json& request);
  /// Changes what people have written on a sweep. See parse_sweep_description().
  std::optional<nlohmann::json> describe_sweep(const std::string& id, const nlohmann::json& request);

  [[nodiscard]] std::optional<nlohmann::json> find_sweep(const std::string& id) const;
  [[nodiscard]] std::optional<nlohmann::json> find_job(const std::string& id) const;
  [[nodiscard]] nlohmann::json list_sweeps(
      const PageQuery& query) const;  ///< {"items": [...], "next_cursor": ""}
  [[nodiscard]] nlohmann::json list_jobs(const PageQuery& query) const;
  [[nodiscard]] std::optional<ResultTable> find_results(const std::string& sweep_id,
                                                        const ResultQuery& query = {}) const;
  /// Empty if there is no such job or it has no trajectory (yet).
  [[nodiscard]] std::optional<engine::Trajectory> find_trajectory(const std::string& job_id,
                                                                  const TrajectoryQuery& query) const;

  /// The same, to be read a block at a time.
  /// @param wanted  told a name of the numbers, equal only for equal ones: false if they need not be read
  /// @returns the part, which is loaded if it is wanted
  [[nodiscard]] std::optional<TrajectoryView> find_trajectory_view(
      const std::string& job_id, const TrajectoryQuery& query,
      const std::function<bool(const std::string& fingerprint)>& wanted) const;

  /// Checks that the store can be read and is in its place. @throws StorageError
  void check_store() const;
  /// Checks that the store's disk is not full. @throws StorageError, full
  void check_room() const;

  /// Stores a study and the jobs of its first evaluations, or nothing at all; others follow by themselves.
  /// See parse_search_request(), parse_wear_request(), parse_optimisation_request() and parse_fit_request().
  /// @param key as of submit_sweep()
  nlohmann::json submit_study(StudyKind kind, const nlohmann::ordered_json& request,
                              const std::string& key = {});
  [[nodiscard]] std::optional<nlohmann::json> find_study(StudyKind kind, const std::string& id) const;
  [[nodiscard]] nlohmann::json list_studies(StudyKind kind, const PageQuery& query) const;
  /// Flat rows: the limits of a search, the cycles of a bearing that is worn, the candidates of an
  /// optimisation, the points of a fit. @param query of the columns that they have
  [[nodiscard]] std::optional<ResultTable> find_study_table(StudyKind kind, const std::string& id,
                                                            const ResultQuery& query = {}) const;
  /// Measured signals beside those of the best jobs; empty if there is no such study, or it has none.
  [[nodiscard]] std::optional<ResultTable> find_study_signals(StudyKind kind, const std::string& id,
                                                              const ResultQuery& query = {}) const;
  std::optional<nlohmann::json> cancel_study(StudyKind kind, const std::string& id);
  /// Queues failed and cancelled jobs of a study again, and lets it go on.
  std::optional<nlohmann::json> retry_study(StudyKind kind, const std::string& id);
  /// Deletes a study that has ended, with the sweep of its evaluations. False if there is none.
  bool delete_study(StudyKind kind, const std::string& id);

  /// Stores a measurement, or nothing at all. @param key as of submit_sweep()
  nlohmann::json submit_measurement(const Measurement& measurement, const std::string& key = {});
  [[nodiscard]] std::optional<nlohmann::json> find_measurement(const std::string& id) const;
  /// {"items": [...], "next_cursor": ""}; items have no runs
  [[nodiscard]] nlohmann::json list_measurements(const PageQuery& query) const;
  /// Samples of one run, the time as t_s. See find_trajectory_view().
  /// @param run  number of the run, from 0; empty: the only one
  [[nodiscard]] std::optional<TrajectoryView> find_measurement_data(
      const std::string& id, std::optional<std::size_t> run, const TrajectoryQuery& query,
      const std::function<bool(const std::string& fingerprint)>& wanted) const;
  /// False if there is none.
  bool delete_measurement(const std::string& id);

  [[nodiscard]] QueueStats read_queue_stats() const;
  /// Executors: {"items": [status, ...]}, the default one first. See Executor::status().
  [[nodiscard]] nlohmann::json list_executors() const;

  /// Cancels what has not ended; running jobs stop within half a second. Returns the resource; empty if there
  /// is none. Cancelling what is already cancelled changes nothing; what has ended otherwise throws
  /// WrongState.
  std::optional<nlohmann::json> cancel_sweep(const std::string& id);
  std::optional<nlohmann::json> cancel_job(const std::string& id);

  /// Deletes a sweep that has ended, with its jobs and the results that no other job shares. False if there
  /// is none. @throws WrongState if it has not ended, or belongs to a study
  bool delete_sweep(const std::string& id);

  /// The same of a job of no sweep
  bool delete_job(const std::string& id);

  /// Jobs that have ended since that change; 0: since the beginning.
  [[nodiscard]] std::optional<SweepNews> find_news(const std::string& sweep_id, std::int64_t after) const;
  /// Jobs of a study that have ended since that change. The study has ended when nothing is left to compute
  /// for it.
  [[nodiscard]] std::optional<SweepNews> find_study_news(StudyKind kind, const std::string& id,
                                                         std::int64_t after) const;
  /// A number that grows whenever a job begins or ends, or is changed otherwise.
  [[nodiscard]] std::uint64_t activity() const { return activity_; }

  /// Writes a consistent copy of the store to a file that does not exist, while everything goes on.
  /// @returns false if the service was stopped before it was done; then there is no file
  bool copy_store_to(const std::filesystem::path& file) const;
  /// Writes the trajectories of a sweep into one file, see jobs::write_trajectories().
  /// @param stop  asked before each job; empty: nobody is
  /// @returns false if there is no such sweep  @throws Stopped if stop() or stop of the service came first
  bool write_trajectories(const std::string& sweep_id, const TrajectoryExport& wanted,
                          const std::filesystem::path& file, const std::function<bool()>& stop = {}) const;
  [[nodiscard]] const std::filesystem::path& store_file() const { return options_.store; }

  /// Blocks until the sweep has ended, or for that long, or until stop(). True if it has ended; false at once
  /// if there is none.
  bool wait_for_sweep(const std::string& id, std::chrono::milliseconds at_most) const;
  /// The same of a job
  bool wait_for_job(const std::string& id, std::chrono::milliseconds at_most) const;
  /// The same of a study
  bool wait_for_study(StudyKind kind, const std::string& id, std::chrono::milliseconds at_most) const;

  /// Ends the pool: running jobs are stopped and go back to the queue. Nothing can be submitted afterwards.
  void stop();

 private:
  using Submit = std::function<nlohmann::json(const IdempotentRequest&)>;
  /// Response that is stored under the request's key; without one, that of submit(), which stores it.
  nlohmann::json answer_once(const std::string& key, const std::string& fingerprint, const Submit& submit);

  void check_open() const;
  void check_executor(const std::string& name) const;
  void wake();  ///< the executors
  void tell_change();
  [[nodiscard]] bool has_cluster() const { return !options_.site.folder.empty(); }
  [[nodiscard]] ExecutorFilter filter_of(std::string_view executor) const;
  [[nodiscard]] int slots_for(const SweepRow& row) const;
  /// The same; none while the store takes no results.
  [[nodiscard]] int slots_at_work(const SweepRow& row) const;
  [[nodiscard]] bool may_have_no_room(const SweepPlan& plan) const;
  /// With what the executors know of its running jobs, and of its rivals'.
  [[nodiscard]] SweepRow with_parts_done(SweepRow row) const;
  [[nodiscard]] nlohmann::json sweep_resource(const SweepRow& row, Detail detail) const;

  void claim(const OnClaim& on_claim);
  void requeue(const ClaimedJob& job);
  /// @param next  takes the next job; empty: nobody does
  void record(const ClaimedJob& job, const RunRecord& run, const OnClaim& next);
  /// @param study  study that the sweep belongs to; empty: none
  bool delete_sweep(const std::string& id, const std::string& study);
  /// Does the rest of a deletion.
  void finish_deleting(const std::string& what);
  /// Does the rest of a cancellation. False if there is nothing of that id. @param why_not null if it may
  /// have ended
  bool finish_cancelling(const Cancellation& cancellation, const char* why_not);

  [[nodiscard]] StudyRunner& runner(StudyKind kind) const {
    return *runners_[static_cast<std::size_t>(kind)];
  }
  /// Changes the jobs of a sweep while no study, of the first kind or a later one, looks at them.
  void change_sweep(const std::string& id, const std::function<void()>& change, std::size_t first_kind = 0);
  /// Lets studies go on after each change, until stop().
  void run_studies();

  const ServiceOptions options_;
  ChangeSignal changes_;  ///< by which a sweep or a study may have ended
  std::atomic<std::uint64_t> activity_ = 0;
  InFlightKeys keys_;
  std::unique_ptr<Store> store_;
  std::array<std::unique_ptr<StudyRunner>, kStudyKinds.size()> runners_;  ///< by StudyKind
  /// End before the store they work for; none before start()
  std::vector<std::shared_ptr<Executor>> executors_;
  std::mutex stop_mutex_;      ///< guards the joining of study_thread_
  std::jthread study_thread_;  ///< of run_studies()
};

}  // namespace jobs
