// SPDX-License-Identifier: Apache-2.0
#include "jobs/service.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <span>
#include <thread>
#include <utility>

#include "jobs/base/content_id.h"
#include "jobs/base/in_flight_keys.h"
#include "jobs/base/provenance.h"
#include "jobs/base/time_text.h"
#include "jobs/cluster/slurm_executor.h"
#include "jobs/local/local_pool.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/requests/expand.h"
#include "jobs/requests/extend_request.h"
#include "jobs/results/page.h"
#include "jobs/results/resource_json.h"
#include "jobs/results/result_query.h"
#include "jobs/runs/run_record.h"
#include "jobs/search/limit_study.h"
#include "jobs/store/store.h"
#include "jobs/studies/study_runner.h"
#include "jobs/trajectories/trajectory_codec.h"
#include "jobs/trajectories/trajectory_query.h"
#include "jobs/wear/wear_study.h"

namespace jobs {
namespace {

using nlohmann::json;

ServiceOptions with_defaults(ServiceOptions options) {
  if (!options.runner) options.runner = engine_runner();
  if (!options.log) options.log = [](const std::string&) {};
  return options;
}

json ended_job_json(const EndedJob& job) {
  return {{"job_id", job.id}, {"state", job.state}, {"error_reason", job.error_reason ? json(*job.error_reason) : json()},
          {"ended_at", time_text(job.ended_ms)}, {"reused", job.reused}};
}

}  // namespace

class Service::Impl {
 public:
  explicit Impl(ServiceOptions options)
      : options_(with_defaults(std::move(options))),
        store_(options_.store, options_.store_quota) {
    if (store_.engine_before() != engine_version()) {
      options_.log("the store's results are of the engine " + store_.engine_before() + ", this program's is " + engine_version() +
                   ": jobs that are asked for again are computed again");
    }
    static_cast<void>(sha256_hex(""));  // OpenSSL that finds no memory when it is first used does not work any more
    if (options_.start == Start::kAtOnce) start();
  }

  void start() {
    if (!executors_.empty()) return;
    executors_.push_back(std::make_unique<LocalPool>(JobSource{.claim = [this](const OnClaim& on_claim) { claim(on_claim); },
                                                               .record = [this](const ClaimedJob& job, const RunRecord& run,
                                                                                const OnClaim& next) { record(job, run, next); },
                                                               .requeue = [this](const ClaimedJob& job) { store_.requeue(job); },
                                                               .ran = options_.ran},
                                                     options_.runner, options_.threads, options_.log, options_.job_limits));
    if (has_cluster()) {
      executors_.push_back(std::make_unique<cluster::SlurmExecutor>(
          options_.site, store_, filter_of(kSlurmExecutor), options_.job_limits, [this] { tell_change(); }, options_.log));
    }
    study_thread_ = std::jthread([this] { run_studies(); });
  }

  json submit_sweep(const nlohmann::ordered_json& request, const std::string& key) {
    check_open();
    const std::string text = request.dump();
    return once(key, "POST /v1/sweeps " + sha256_hex(text), [&](const std::string& name, std::string& answer) {
      const SweepPlan plan = plan_sweep(request, options_.max_sweep_jobs);
      if (!plan.executor.empty()) check_executor(plan.executor);
      const IdempotencyRecord<SweepRow> kept{.key = key, .fingerprint = name, .make_response = [&](const SweepRow& row) {
                                        return answer = text_of(sweep_resource(row, Detail::kFull));
                                      }};
      const std::string id = store_.add_sweep(plan, text, options_.max_queued_jobs, kept);
      wake();
      return find_sweep(id).value();
    });
  }

  json submit_job(const json& parameters, const std::string& key) {
    check_open();
    return once(key, "POST /v1/jobs " + sha256_hex(parameters.dump()), [&](const std::string& name, std::string& answer) {
      const IdempotencyRecord<JobRow> kept{
          .key = key, .fingerprint = name, .make_response = [&](const JobRow& row) { return answer = text_of(job_json(row, Detail::kFull)); }};
      const std::string id = store_.add_job(plan_job(parameters), options_.max_queued_jobs, kept);
      wake();
      return find_job(id).value();
    });
  }

  std::optional<json> extend_sweep(const std::string& id, const nlohmann::ordered_json& addition) {
    check_open();
    for (bool done = false; !done;) {  // again, if another extension came in between
      const auto sweep = store_.find_sweep(id);
      if (!sweep) return std::nullopt;
      const Extension extension = plan_extension(nlohmann::ordered_json::parse(sweep->request), addition, options_.max_sweep_jobs);
      done = extension.jobs.empty();
      if (done) break;
      change_sweep(id, [&] {
        done = store_.extend_sweep(id, sweep->request, extension.request.dump(), extension.jobs, options_.max_queued_jobs);
      });
    }
    wake();
    tell_change();
    return find_sweep(id);
  }

  std::optional<json> retry_sweep(const std::string& id) {
    check_open();
    bool found = false;
    change_sweep(id, [&] { found = store_.retry_sweep(id, options_.max_queued_jobs); });
    if (!found) return std::nullopt;
    wake();
    tell_change();
    return find_sweep(id);
  }

  std::optional<json> move_sweep(const std::string& id, const json& request) {
    check_open();
    check_move(request);
    if (!store_.move_sweep(id, request.at("executor"))) return std::nullopt;
    wake();
    tell_change();
    return find_sweep(id);
  }

  [[nodiscard]] std::optional<json> find_sweep(const std::string& id) const {
    const auto row = store_.find_sweep(id);
    return row ? std::optional(sweep_resource(*row, Detail::kFull)) : std::nullopt;
  }

  [[nodiscard]] std::optional<json> find_job(const std::string& id) const {
    const auto row = store_.find_job(id);
    return row ? std::optional(job_json(*row, Detail::kFull)) : std::nullopt;
  }

  [[nodiscard]] json list_sweeps(const PageQuery& query) const {
    const PageChecker checker(query, kSweepPrefix, sweep_listing_keys());
    return make_page(store_.list_sweeps(query.state, query.cursor, query.limit + 1), query.limit, checker,
                     [&](const SweepRow& row) { return sweep_resource(row, Detail::kListing); });
  }

  [[nodiscard]] json list_jobs(const PageQuery& query) const {
    const PageChecker checker(query, kJobPrefix, job_listing_keys());
    return make_page(store_.list_jobs(query.state, query.cursor, query.limit + 1), query.limit, checker,
                     [&](const JobRow& row) { return job_json(row, Detail::kListing, checker.wanted()); });
  }

  [[nodiscard]] std::optional<ResultTable> find_results(const std::string& sweep_id, const ResultQuery& query) const {
    const auto sweep = store_.find_sweep(sweep_id);
    if (!sweep) return std::nullopt;
    const auto others = find_other_columns(query, swept_of(*sweep));
    const auto results = store_.find_results(sweep_id, needed_parameters(others));
    if (!results) return std::nullopt;
    ResultTable table = result_table(*results, others);
    jobs::apply(query, table, kSweepColumns);
    return table;
  }

  [[nodiscard]] std::optional<engine::Trajectory> find_trajectory(const std::string& job_id, const TrajectoryQuery& query) const {
    const auto blob = store_.find_trajectory(job_id);
    if (!blob) return std::nullopt;
    try {
      return read_trajectory(std::as_bytes(std::span(*blob)), query);
    } catch (const DamagedTrajectory& damage) {
      throw StorageError("the trajectory of " + job_id + " cannot be read: " + damage.what());
    }
  }

  [[nodiscard]] std::optional<SweepNews> find_news(const std::string& sweep_id, std::int64_t after) const {
    const auto changes = store_.find_changes(sweep_id, after);
    if (!changes) return std::nullopt;
    SweepNews news{.progress = progress_json(changes->sweep, slots_for(changes->sweep)), .ended = has_ended(changes->sweep.counts), .jobs = {}};
    for (const EndedJob& job : changes->ended) news.jobs.push_back({.change = job.change, .job = ended_job_json(job)});
    return news;
  }

  json submit_study(Study study, const nlohmann::ordered_json& request, const std::string& key) {
    check_open();
    const char* const route = study == Study::kLimit ? "POST /v1/searches " : "POST /v1/wear-studies ";
    return once(key, route + sha256_hex(request.dump()), [&](const std::string& name, std::string& answer) {
      json begun = runner(study).submit(request, {.key = key, .fingerprint = name, .response = &answer});
      wake();
      tell_change();  // its first results may be known already
      return begun;
    });
  }

  [[nodiscard]] std::optional<SweepNews> find_study_news(Study study, const std::string& id, std::int64_t after) const {
    const auto row = runner(study).find_row(id);
    if (!row) return std::nullopt;
    auto news = find_news(row->sweep_id, after);
    if (!news) return std::nullopt;
    const bool runs = row->state == "running";
    news->progress = {{"id", id}, {"sweep_id", row->sweep_id}, {"state", row->state}, {"counts", news->progress.at("counts")},
                      {"progress", runs ? runner(study).find_progress(id) : 1.0}};
    news->ended = news->ended && !runs;
    return news;
  }

  bool wait_for_study(Study study, const std::string& id, std::chrono::milliseconds at_most) const {
    return wait_for_end(at_most, [&]() -> std::optional<bool> {
      const auto row = runner(study).find_row(id);
      return row ? std::optional(row->state != "running") : std::nullopt;
    });
  }

  [[nodiscard]] const StudyRunner& runner(Study study) const { return study == Study::kLimit ? search_runner_ : wear_runner_; }
  [[nodiscard]] StudyRunner& runner(Study study) { return study == Study::kLimit ? search_runner_ : wear_runner_; }

  std::optional<json> cancel_study(Study study, const std::string& id) {
    const bool found = runner(study).cancel(id, [this](const std::string& sweep) { finish_cancelling(store_.cancel_sweep(sweep), nullptr); });
    return found ? runner(study).find(id) : std::nullopt;
  }

  std::optional<json> retry_study(Study study, const std::string& id) {
    check_open();
    const auto retry_sweep = [this](const std::string& sweep) { store_.retry_sweep(sweep, options_.max_queued_jobs); };
    if (!runner(study).retry(id, retry_sweep)) return std::nullopt;
    wake();
    tell_change();
    return runner(study).find(id);
  }

  bool delete_study(Study study, const std::string& id) {
    const auto sweep = runner(study).find_ended_sweep(id);
    return sweep && delete_sweep(*sweep);
  }

  [[nodiscard]] QueueStats read_queue_stats() const { return store_.read_queue_stats(); }

  [[nodiscard]] json list_executors() const {
    json items = json::array();
    for (const auto& executor : executors_) items.push_back(executor->status());
    if (options_.executor != kLocalExecutor) std::reverse(items.begin(), items.end());
    return {{"items", std::move(items)}};
  }

  [[nodiscard]] std::uint64_t activity() const { return activity_; }

  [[nodiscard]] bool copy_store_to(const std::filesystem::path& file) const {
    return copy_store(options_.store, file, [this] { return stopped_.load(); });
  }
  [[nodiscard]] const std::filesystem::path& store_file() const { return options_.store; }

  std::optional<json> cancel_sweep(const std::string& id) {
    return finish_cancelling(store_.cancel_sweep(id), "the sweep has ended") ? find_sweep(id) : std::nullopt;
  }

  std::optional<json> cancel_job(const std::string& id) { return finish_cancelling(store_.cancel_job(id), "the job has ended") ? find_job(id) : std::nullopt; }

  bool delete_sweep(const std::string& id) {
    const DeleteOutcome outcome = store_.delete_sweep(id);
    if (outcome == DeleteOutcome::kNotEnded) throw WrongState("the sweep has not ended; cancel it first");
    if (outcome == DeleteOutcome::kMissing) return false;
    tell_change();
    try {
      store_.release_free_pages();
    } catch (const std::exception& error) {  // the store's errors, or no memory
      options_.log("sweep " + id + " is deleted, but the file could not be made smaller yet: " + error.what());
    }
    return true;
  }

  bool wait_for_sweep(const std::string& id, std::chrono::milliseconds at_most) const {
    return wait_for_end(at_most, [&] { return store_.has_sweep_ended(id); });
  }

  bool wait_for_job(const std::string& id, std::chrono::milliseconds at_most) const {
    return wait_for_end(at_most, [&] { return store_.has_job_ended(id); });
  }

  void stop() {
    stopped_ = true;
    for (const auto& executor : executors_) executor->stop();
    tell_change();
    const std::lock_guard lock(stop_mutex_);
    if (study_thread_.joinable()) study_thread_.join();
  }

 private:
  /// Answers a request that has a key as it was answered before, or does submit(name of the request, its answer to be).
  template <typename Submit>
  json once(const std::string& key, const std::string& name, const Submit& submit) {
    std::string answer;
    if (key.empty()) return submit(name, answer);
    const InFlightKeys::Use use(keys_, key);
    if (const auto found = store_.find_response(key)) {
      if (found->fingerprint == name) return json::parse(found->text);
      throw InvalidRequest(std::vector<Fault>{{"", "this Idempotency-Key belongs to another request; a new request needs a new key"}});
    }
    submit(name, answer);
    return json::parse(answer);  // as it is kept, so that both answers are the same
  }

  /// Blocks until has_ended() says true, or for that long, or until stop(). What it has said, or false if there is nothing to wait for.
  template <typename HasEnded>
  bool wait_for_end(std::chrono::milliseconds at_most, const HasEnded& has_ended) const {
    // Where jobs end by the thousand a second, who waits for the last one is not to ask the store after each.
    constexpr std::chrono::milliseconds kBetweenLooks{5};
    // The largest waits would overflow the clock.
    const auto until = std::chrono::steady_clock::now() + std::min<std::chrono::milliseconds>(at_most, std::chrono::years(10));
    for (;;) {
      std::unique_lock lock(change_mutex_);
      const std::uint64_t seen = changes_;
      lock.unlock();
      const auto looked = std::chrono::steady_clock::now();
      const std::optional<bool> ended = has_ended();
      if (!ended) return false;
      if (*ended) return true;
      lock.lock();
      if (!changed_.wait_until(lock, until, [&] { return changes_ != seen || stopped_; }) || stopped_) return false;
      lock.unlock();
      std::this_thread::sleep_until(looked + kBetweenLooks);
    }
  }

  /// Changes the jobs of a sweep, which studies must not look at meanwhile.
  void change_sweep(const std::string& id, const std::function<void()>& change) {
    search_runner_.change_sweep(id, [&] { wear_runner_.change_sweep(id, change); });
  }

  void claim(const OnClaim& on_claim) {
    if (store_.claim(filter_of(kLocalExecutor), on_claim)) ++activity_;
  }

  void check_open() const {
    if (stopped_) throw Stopped("the service is shutting down");
  }

  void wake() {
    for (const auto& executor : executors_) executor->wake();
  }

  [[nodiscard]] bool has_cluster() const { return !options_.site.folder.empty(); }
  [[nodiscard]] StudyLimits study_limits() const {
    return {.max_sweep_jobs = options_.max_sweep_jobs, .max_queued_jobs = options_.max_queued_jobs, .threads = options_.threads};
  }
  [[nodiscard]] ExecutorFilter filter_of(std::string_view executor) const { return {.executor = std::string(executor), .default_executor = options_.executor}; }

  void check_executor(const std::string& name) const {
    if (name == kLocalExecutor || has_cluster()) return;
    throw InvalidRequest(std::vector<Fault>{{"/executor", "this service has no cluster; it has \"local\""}});
  }

  void check_move(const json& request) const {
    if (!request.is_object()) throw InvalidRequest(std::vector<Fault>{{"", "must be an object with \"executor\""}});
    std::vector<Fault> faults;
    constexpr std::array<std::string_view, 1> kKeys{"executor"};
    for (const auto& [key, value] : request.items()) {
      if (key != kKeys.front()) faults.push_back({pointer_token(key), describe_unknown_key(key, kKeys)});
    }
    const json name = request.value("executor", json());
    if (std::ranges::find(kExecutorNames, name) == kExecutorNames.end()) faults.push_back({"/executor", "must be \"local\" or \"slurm\""});
    if (!faults.empty()) throw InvalidRequest(std::move(faults));
    check_executor(name);
  }

  [[nodiscard]] int slots_for(const SweepRow& row) const {
    const std::string& name = row.executor.empty() ? options_.executor : row.executor;
    return name == kSlurmExecutor && has_cluster() ? options_.site.slots * options_.site.threads : options_.threads;
  }

  [[nodiscard]] json sweep_resource(const SweepRow& row, Detail detail) const {
    json sweep = sweep_json(row, slots_for(row), detail);
    if (row.executor.empty()) sweep["executor"] = options_.executor;
    return sweep;
  }

  /// @param next  takes the next job; empty: nobody does
  void record(const ClaimedJob& job, const RunRecord& run, const OnClaim& next) {
    if (next) {
      static_cast<void>(store_.record_and_claim(job, run, filter_of(kLocalExecutor), next));
    } else {
      store_.record(job, run);
    }
    tell_change();
  }

  /// Does the rest of a cancellation. False if there is nothing of that id. @param why_not  null if it may have ended
  bool finish_cancelling(const Cancellation& cancellation, const char* why_not) {
    if (cancellation.outcome == CancelOutcome::kMissing) return false;
    if (cancellation.outcome == CancelOutcome::kEnded && why_not != nullptr) throw WrongState(why_not);
    for (const std::string& job : cancellation.running) {
      for (const auto& executor : executors_) executor->stop_job(job);
    }
    wake();  // jobs of the same content may have waited
    tell_change();
    return true;
  }

  void tell_change() {
    ++activity_;
    {
      const std::lock_guard lock(change_mutex_);
      ++changes_;
    }
    changed_.notify_all();
  }

  /// Lets studies go on whenever something has changed, until the service is stopped.
  void run_studies() {
    constexpr std::chrono::seconds kPause{5};  // after a failure of the store
    for (std::uint64_t seen = 0; !stopped_;) {
      bool failed = false;
      {
        const std::lock_guard lock(change_mutex_);
        seen = changes_;
      }
      try {
        const StudyChanges limits = search_runner_.advance();
        const StudyChanges wear = wear_runner_.advance();
        if (limits.added || wear.added) wake();
        if (limits.any || wear.any) tell_change();
      } catch (const std::exception& error) {  // the store's errors, or no memory
        options_.log(std::string("the studies could not go on yet: ") + error.what());
        failed = true;
      }
      std::unique_lock lock(change_mutex_);
      const auto done = [&] { return stopped_.load() || (!failed && changes_ != seen); };
      if (failed) changed_.wait_for(lock, kPause, done);
      else changed_.wait(lock, done);
    }
  }

  const ServiceOptions options_;
  std::atomic<bool> stopped_ = false;
  mutable std::mutex change_mutex_;  // guards changes_
  mutable std::condition_variable changed_;
  std::uint64_t changes_ = 0;  ///< how often a sweep may have ended
  std::atomic<std::uint64_t> activity_ = 0;
  InFlightKeys keys_;
  Store store_;
  StudyRunner search_runner_{store_, study_limits(), make_limit_study()};
  StudyRunner wear_runner_{store_, study_limits(), make_wear_study(store_)};
  std::vector<std::unique_ptr<Executor>> executors_;  // end before the store they work for; none before start()
  std::mutex stop_mutex_;          // guards the joining of study_thread_
  std::jthread study_thread_;          // of run_studies()
};

Service::Service(ServiceOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}
Service::~Service() { stop(); }

void Service::start() { impl_->start(); }
json Service::submit_sweep(const nlohmann::ordered_json& request, const std::string& key) { return impl_->submit_sweep(request, key); }
json Service::submit_job(const json& parameters, const std::string& key) { return impl_->submit_job(parameters, key); }
std::optional<json> Service::extend_sweep(const std::string& id, const nlohmann::ordered_json& addition) { return impl_->extend_sweep(id, addition); }
std::optional<json> Service::retry_sweep(const std::string& id) { return impl_->retry_sweep(id); }
std::optional<json> Service::move_sweep(const std::string& id, const json& request) { return impl_->move_sweep(id, request); }
json Service::list_executors() const { return impl_->list_executors(); }
std::optional<json> Service::find_sweep(const std::string& id) const { return impl_->find_sweep(id); }
std::optional<json> Service::find_job(const std::string& id) const { return impl_->find_job(id); }
json Service::list_sweeps(const PageQuery& query) const { return impl_->list_sweeps(query); }
json Service::list_jobs(const PageQuery& query) const { return impl_->list_jobs(query); }
std::optional<ResultTable> Service::find_results(const std::string& sweep_id, const ResultQuery& query) const {
  return impl_->find_results(sweep_id, query);
}
std::optional<SweepNews> Service::find_news(const std::string& sweep_id, std::int64_t after) const { return impl_->find_news(sweep_id, after); }
std::uint64_t Service::activity() const { return impl_->activity(); }
bool Service::copy_store_to(const std::filesystem::path& file) const { return impl_->copy_store_to(file); }
const std::filesystem::path& Service::store_file() const { return impl_->store_file(); }
std::optional<engine::Trajectory> Service::find_trajectory(const std::string& job_id, const TrajectoryQuery& query) const {
  return impl_->find_trajectory(job_id, query);
}
json Service::submit_study(Study study, const nlohmann::ordered_json& request, const std::string& key) {
  return impl_->submit_study(study, request, key);
}
std::optional<SweepNews> Service::find_study_news(Study study, const std::string& id, std::int64_t after) const {
  return impl_->find_study_news(study, id, after);
}
bool Service::wait_for_study(Study study, const std::string& id, std::chrono::milliseconds at_most) const {
  return impl_->wait_for_study(study, id, at_most);
}
std::optional<json> Service::find_study(Study study, const std::string& id) const { return impl_->runner(study).find(id); }
json Service::list_studies(Study study, const PageQuery& query) const { return impl_->runner(study).list(query); }
std::optional<ResultTable> Service::find_study_table(Study study, const std::string& id, const ResultQuery& query) const {
  auto table = impl_->runner(study).find_table(id);
  if (table) jobs::apply(query, *table, kStudyColumns);
  return table;
}
std::optional<json> Service::cancel_study(Study study, const std::string& id) { return impl_->cancel_study(study, id); }
std::optional<json> Service::retry_study(Study study, const std::string& id) { return impl_->retry_study(study, id); }
bool Service::delete_study(Study study, const std::string& id) { return impl_->delete_study(study, id); }
QueueStats Service::read_queue_stats() const { return impl_->read_queue_stats(); }
std::optional<json> Service::cancel_sweep(const std::string& id) { return impl_->cancel_sweep(id); }
std::optional<json> Service::cancel_job(const std::string& id) { return impl_->cancel_job(id); }
bool Service::delete_sweep(const std::string& id) { return impl_->delete_sweep(id); }
bool Service::wait_for_sweep(const std::string& id, std::chrono::milliseconds at_most) const { return impl_->wait_for_sweep(id, at_most); }
bool Service::wait_for_job(const std::string& id, std::chrono::milliseconds at_most) const { return impl_->wait_for_job(id, at_most); }
void Service::stop() { impl_->stop(); }

}  // namespace jobs
