// SPDX-License-Identifier: Apache-2.0
#include "jobs/service.h"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "jobs/base/content_id.h"
#include "jobs/base/ids.h"
#include "jobs/base/optional_json.h"
#include "jobs/base/provenance.h"
#include "jobs/base/time_text.h"
#include "jobs/cluster/slurm_executor.h"
#include "jobs/fits/fit_study.h"
#include "jobs/local/local_pool.h"
#include "jobs/optimisation/optimisation_study.h"
#include "jobs/requests/expand.h"
#include "jobs/requests/extend_request.h"
#include "jobs/requests/sweep_description.h"
#include "jobs/requests/sweep_request.h"
#include "jobs/results/page.h"
#include "jobs/results/plan_estimate.h"
#include "jobs/search/search_study.h"
#include "jobs/store/store.h"
#include "jobs/studies/study_runner.h"
#include "jobs/trajectories/trajectory_codec.h"
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
  return {{"job_id", job.id}, {"state", job.state}, {"error_reason", value_or_null(job.error_reason)},
          {"ended_at", time_text(job.ended_ms)}, {"reused", job.reused}};
}

std::array<std::unique_ptr<StudyRunner>, kStudyKinds.size()> make_runners(Store& store,
                                                                          const ServiceOptions& options) {
  const StudyLimits limits{.max_sweep_jobs = options.max_sweep_jobs,
                           .max_queued_jobs = options.max_queued_jobs,
                           .threads = options.threads};
  const auto find_measurement = [&store](const std::string& id) { return store.measurements.find(id); };
  return {std::make_unique<StudyRunner>(store, limits, make_search_study()),
          std::make_unique<StudyRunner>(store, limits, make_wear_study(store.reader)),
          std::make_unique<StudyRunner>(store, limits, make_optimisation_study()),
          std::make_unique<StudyRunner>(store, limits, make_fit_study(store.reader, find_measurement))};
}

void tell_other_engine(const Store& store, const std::function<void(const std::string&)>& log) {
  if (store.engine_before() == engine_version()) return;
  log("the store's results are of the engine " + store.engine_before() + ", this program's is " +
      engine_version() + ": jobs that are asked for again are computed again");
}

/// Uses that a store without room is open for, in words.
std::string describe_use_without_room(LogIndex log_index) {
  return log_index == LogIndex::kFile
             ? "the store is open for reading, cancelling and deleting only: "
             : "the store is open for reading only, and to no other process until the next start: ";
}

}  // namespace

Service::Service(ServiceOptions options)
    : options_(with_defaults(std::move(options))),
      store_(std::make_unique<Store>(options_.store, options_.store_quota)) {
  runners_ = make_runners(*store_, options_);
  tell_other_engine(*store_, options_.log);
  try {
    check_room();
  } catch (const StorageError& error) {
    options_.log(describe_use_without_room(store_->log_index()) + error.what());
  }
  // OpenSSL that finds no memory when it is first used does not work any more
  static_cast<void>(sha256_hex(""));
  if (options_.start == Start::kAtOnce) start();
}

Service::~Service() {
  stop();
  store_->keep(!executors_.empty());  // one that was never started has nothing to keep
}

void Service::start() {
  if (!executors_.empty()) return;
  JobSource source{.claim = [this](const OnClaim& on_claim) { claim(on_claim); },
                   .record = [this](const ClaimedJob& job, const RunRecord& run,
                                    const OnClaim& next) { record(job, run, next); },
                   .requeue = [this](const ClaimedJob& job) { requeue(job); },
                   .ran = options_.ran};
  const auto pool = std::make_shared<LocalPool>(std::move(source), options_.runner, options_.threads,
                                                options_.log, options_.job_limits);
  executors_.push_back(pool);
  if (has_cluster()) {
    // Jobs may have waited here for the same content there. The cluster's thread runs before the list of
    // executors has it, so it must not look into that.
    const auto tell_pool = [this, pool] {
      pool->wake();
      tell_change();
    };
    executors_.push_back(
        std::make_shared<cluster::SlurmExecutor>(options_.site, store_->batches, filter_of(kSlurmExecutor),
                                                 options_.job_limits, tell_pool, options_.log));
  }
  study_thread_ = std::jthread([this] { run_studies(); });
}

void Service::stop() {
  changes_.close();
  for (const auto& executor : executors_) executor->stop();
  tell_change();
  const std::lock_guard lock(stop_mutex_);
  if (study_thread_.joinable()) study_thread_.join();
}

json Service::submit_sweep(const nlohmann::ordered_json& request, const std::string& key) {
  const std::string text = request.dump();
  return answer_once(key, "POST /v1/sweeps " + sha256_hex(text), [&](const IdempotentRequest& idempotency) {
    const SweepPlan plan = plan_sweep(request, options_.max_sweep_jobs);
    if (!plan.executor.empty()) check_executor(plan.executor);
    json response;
    const auto make_response = [&](const SweepRow& row) {
      return text_of(response = sweep_resource(row, Detail::kFull));
    };
    store_->queue.add_sweep(plan, text, options_.max_queued_jobs,
                            {idempotency.key, idempotency.fingerprint, make_response});
    wake();
    return response;
  });
}

json Service::estimate_sweep(const nlohmann::ordered_json& request) const {
  const SweepPlan plan = plan_sweep(request, options_.max_sweep_jobs);
  if (!plan.executor.empty()) check_executor(plan.executor);
  if (may_have_no_room(plan))
    store_->queue.check_sweep(plan, request.dump(), options_.max_queued_jobs);
  SweepRow row;
  row.executor = plan.executor;
  json estimate = plan_estimate_json(plan, store_->reader.find_costs(plan), slots_for(row));
  estimate["max_jobs"] = options_.max_sweep_jobs;
  estimate["free_bytes"] = store_->find_bytes_left();
  return estimate;
}

/// @returns whether the queue or the store might refuse a sweep: rows of the store take less than four times
/// their parameters
bool Service::may_have_no_room(const SweepPlan& plan) const {
  std::size_t bytes = 1U << 20U;
  for (const PlannedJob& job : plan.jobs) bytes += 4 * (job.parameters.size() + job.swept.size());
  const auto queued = static_cast<std::size_t>(store_->reader.read_queue_stats().queued);
  return static_cast<std::int64_t>(bytes) > store_->find_bytes_left() ||
         queued + plan.jobs.size() > options_.max_queued_jobs;
}

json Service::submit_job(const json& parameters, const std::string& key) {
  const std::string fingerprint = "POST /v1/jobs " + sha256_hex(parameters.dump());
  return answer_once(key, fingerprint, [&](const IdempotentRequest& idempotency) {
    json response;
    const auto make_response = [&](const JobRow& row) {
      return text_of(response = job_json(row, Detail::kFull));
    };
    store_->queue.add_job(plan_job(parameters), options_.max_queued_jobs,
                          {idempotency.key, idempotency.fingerprint, make_response});
    wake();
    return response;
  });
}

json Service::answer_once(const std::string& key, const std::string& fingerprint, const Submit& submit) {
  check_open();
  if (key.empty()) return submit({key, fingerprint});
  const InFlightKeys::Use use(keys_, key);
  if (const auto found = store_->reader.find_response(key)) {
    if (found->fingerprint == fingerprint) return json::parse(found->text);
    throw InvalidRequest(std::vector<Fault>{
        {"", "this Idempotency-Key belongs to another request; a new request needs a new key"}});
  }
  return submit({key, fingerprint});
}

std::optional<json> Service::extend_sweep(const std::string& id, const nlohmann::ordered_json& addition) {
  check_open();
  for (bool done = false; !done;) {  // again, if another extension came in between
    const auto sweep = store_->reader.find_sweep(id);
    if (!sweep) return std::nullopt;
    if (sweep->study_id && !sweep->study_id->starts_with(kSearchPrefix))
      throw WrongState("the sweep holds the jobs of " + name_of_study(*sweep->study_id) +
                       ", which adds its jobs by itself");
    const Extension extension =
        plan_extension(nlohmann::ordered_json::parse(sweep->request), addition, options_.max_sweep_jobs);
    done = extension.jobs.empty();
    if (done) break;
    change_sweep(id, [&] {
      done = store_->queue.extend_sweep(id, sweep->request, extension.request.dump(), extension.jobs,
                                        options_.max_queued_jobs);
    });
  }
  wake();
  tell_change();
  return find_sweep(id);
}

std::optional<json> Service::retry_sweep(const std::string& id) {
  check_open();
  bool found = false;
  change_sweep(id, [&] { found = store_->queue.retry_sweep(id, options_.max_queued_jobs); });
  if (!found) return std::nullopt;
  wake();
  tell_change();
  return find_sweep(id);
}

std::optional<json> Service::move_sweep(const std::string& id, const json& request) {
  check_open();
  const std::string executor = parse_move_request(request);
  check_executor(executor);
  if (!store_->queue.move_sweep(id, executor)) return std::nullopt;
  wake();
  tell_change();
  return find_sweep(id);
}

std::optional<json> Service::describe_sweep(const std::string& id, const json& request) {
  check_open();
  if (!store_->queue.describe_sweep(id, parse_sweep_description(request))) return std::nullopt;
  return find_sweep(id);
}

std::optional<json> Service::find_sweep(const std::string& id) const {
  const auto row = store_->reader.find_sweep(id);
  return row ? std::optional(sweep_resource(*row, Detail::kFull)) : std::nullopt;
}

std::optional<json> Service::find_job(const std::string& id) const {
  const auto row = store_->reader.find_job(id);
  return row ? std::optional(job_json(*row, Detail::kFull)) : std::nullopt;
}

json Service::list_sweeps(const PageQuery& query) const {
  const PageChecker checker(query, kSweepPrefix, sweep_listing_keys());
  const auto rows = store_->reader.list_sweeps(query.state, query.cursor, query.limit + 1);
  return make_page(rows, query.limit, checker,
                   [&](const SweepRow& row) { return sweep_resource(row, Detail::kListing); });
}

json Service::list_jobs(const PageQuery& query) const {
  const PageChecker checker(query, kJobPrefix, job_listing_keys());
  const auto rows = store_->reader.list_jobs(query.state, query.cursor, query.limit + 1);
  return make_page(rows, query.limit, checker,
                   [&](const JobRow& row) { return job_json(row, Detail::kListing, checker.wanted()); });
}

std::optional<ResultTable> Service::find_results(const std::string& sweep_id,
                                                 const ResultQuery& query) const {
  const auto sweep = store_->reader.find_sweep(sweep_id);
  if (!sweep) return std::nullopt;
  const auto others = find_other_columns(query, swept_of(*sweep));
  const auto results = store_->reader.find_results(sweep_id, needed_parameters(others));
  if (!results) return std::nullopt;
  ResultTable table = result_table(*results, others, query.metric);
  jobs::apply(query, table, kSweepColumns);
  return table;
}

std::optional<engine::Trajectory> Service::find_trajectory(const std::string& job_id,
                                                           const TrajectoryQuery& query) const {
  const auto blob = store_->reader.find_trajectory(job_id);
  if (!blob) return std::nullopt;
  try {
    return read_trajectory(std::as_bytes(std::span(*blob)), query);
  } catch (const DamagedTrajectory& damage) {
    throw StorageError("the trajectory of " + job_id + " cannot be read: " + damage.what());
  }
}

std::optional<TrajectoryView> Service::find_trajectory_view(
    const std::string& job_id, const TrajectoryQuery& query,
    const std::function<bool(const std::string&)>& wanted) const {
  std::optional<TrajectoryView> view;
  try {
    store_->reader.read_trajectory(job_id, [&](const StoredBytes& blob) {
      view.emplace(blob, query);
      if (wanted(view->fingerprint())) view->load(blob);
    });
  } catch (const DamagedTrajectory& damage) {
    throw StorageError("the trajectory of " + job_id + " cannot be read: " + damage.what());
  }
  return view;
}

void Service::check_store() const { store_->reader.check(); }

void Service::check_room() const { store_->check_room(); }

std::optional<SweepNews> Service::find_news(const std::string& sweep_id, std::int64_t after) const {
  const auto changes = store_->reader.find_changes(sweep_id, after);
  if (!changes) return std::nullopt;
  SweepNews news{.progress = progress_json(with_parts_done(changes->sweep), slots_at_work(changes->sweep),
                                           options_.executor),
                 .ended = has_ended(changes->sweep.counts), .jobs = {}};
  for (const EndedJob& job : changes->ended) news.jobs.push_back({job.change, ended_job_json(job)});
  return news;
}

QueueStats Service::read_queue_stats() const { return store_->reader.read_queue_stats(); }

json Service::list_executors() const {
  json items = json::array();
  const std::string refusal = store_->refusal();
  for (const auto& executor : executors_) {
    items.push_back(executor->status());
    if (!refusal.empty()) items.back()["problems"].push_back("results wait to be stored: " + refusal);
  }
  if (options_.executor != kLocalExecutor) std::reverse(items.begin(), items.end());
  return {{"items", std::move(items)}};
}

std::optional<json> Service::cancel_sweep(const std::string& id) {
  const bool found = finish_cancelling(store_->queue.cancel_sweep(id), "the sweep has ended");
  return found ? find_sweep(id) : std::nullopt;
}

std::optional<json> Service::cancel_job(const std::string& id) {
  return finish_cancelling(store_->queue.cancel_job(id), "the job has ended") ? find_job(id) : std::nullopt;
}

bool Service::delete_sweep(const std::string& id) { return delete_sweep(id, ""); }

bool Service::delete_sweep(const std::string& id, const std::string& study) {
  const DeleteOutcome outcome = store_->queue.delete_sweep(id, study);
  if (outcome == DeleteOutcome::kOfStudy) {
    const auto sweep = store_->reader.find_sweep(id);
    const std::string owner = sweep ? sweep->study_id.value_or("") : "";
    throw WrongState("the sweep holds the jobs of " + name_of_study(owner) +
                     "; delete that one, and the sweep goes with it");
  }
  if (outcome == DeleteOutcome::kNotEnded) throw WrongState("the sweep has not ended; cancel it first");
  if (outcome == DeleteOutcome::kMissing) return false;
  finish_deleting("sweep " + id);
  return true;
}

bool Service::delete_job(const std::string& id) {
  const DeleteOutcome outcome = store_->queue.delete_job(id);
  if (outcome == DeleteOutcome::kOfSweep)
    throw WrongState("the job is one of a sweep, which is deleted as a whole");
  if (outcome == DeleteOutcome::kNotEnded) throw WrongState("the job has not ended; cancel it first");
  if (outcome == DeleteOutcome::kMissing) return false;
  finish_deleting("job " + id);
  return true;
}

void Service::finish_deleting(const std::string& what) {
  tell_change();
  try {
    store_->release_free_pages();
  } catch (const std::exception& error) {  // the store's errors, or no memory
    options_.log(what + " is deleted, but the file could not be made smaller yet: " + error.what());
  }
}

bool Service::wait_for_sweep(const std::string& id, std::chrono::milliseconds at_most) const {
  return changes_.wait_for(at_most, [&] { return store_->reader.has_sweep_ended(id); });
}

bool Service::wait_for_job(const std::string& id, std::chrono::milliseconds at_most) const {
  return changes_.wait_for(at_most, [&] { return store_->reader.has_job_ended(id); });
}

void Service::claim(const OnClaim& on_claim) {
  if (store_->queue.claim(filter_of(kLocalExecutor), on_claim)) ++activity_;
}

void Service::requeue(const ClaimedJob& job) {
  store_->queue.requeue(job);
  tell_change();
}

void Service::record(const ClaimedJob& job, const RunRecord& run, const OnClaim& next) {
  if (next) {
    static_cast<void>(store_->queue.record_and_claim(job, run, filter_of(kLocalExecutor), next));
  } else {
    store_->queue.record(job, run);
  }
  tell_change();
}

bool Service::finish_cancelling(const Cancellation& cancellation, const char* why_not) {
  if (cancellation.outcome == CancelOutcome::kMissing) return false;
  if (cancellation.outcome == CancelOutcome::kEnded && why_not != nullptr) throw WrongState(why_not);
  for (const RunningJob& job : cancellation.running) {
    for (const auto& executor : executors_) executor->stop_job(job.id, job.attempt);
  }
  wake();  // jobs of the same content may have waited
  tell_change();
  return true;
}

void Service::check_open() const {
  if (changes_.is_closed()) throw Stopped("the service is shutting down");
}

void Service::check_executor(const std::string& name) const {
  if (name == kLocalExecutor || has_cluster()) return;
  throw InvalidRequest(std::vector<Fault>{{"/executor", "this service has no cluster; it has \"local\""}});
}

void Service::wake() {
  for (const auto& executor : executors_) executor->wake();
}

void Service::tell_change() {
  ++activity_;
  changes_.add_change();
}

ExecutorFilter Service::filter_of(std::string_view executor) const {
  return {.executor = std::string(executor), .default_executor = options_.executor};
}

int Service::slots_for(const SweepRow& row) const {
  const std::string& name = row.executor.empty() ? options_.executor : row.executor;
  return name == kSlurmExecutor && has_cluster() ? options_.site.slots * options_.site.threads
                                                 : options_.threads;
}

int Service::slots_at_work(const SweepRow& row) const {
  return store_->refusal().empty() ? slots_for(row) : 0;
}

SweepRow Service::with_parts_done(SweepRow row) const {
  const auto fill_in = [this](Costs& costs) {
    for (auto& [kind, cost] : costs) {
      for (RunningCost& job : cost.running) {
        for (const auto& executor : executors_)
          if (const auto part = executor->find_part_done(job.id)) job.part_done = part;
      }
    }
  };
  fill_in(row.costs);
  for (auto& rival : row.rivals) {
    auto filled = std::make_shared<RivalSweep>(*rival);
    fill_in(filled->costs);
    rival = std::move(filled);
  }
  return row;
}

json Service::sweep_resource(const SweepRow& row, Detail detail) const {
  json sweep = sweep_json(with_parts_done(row), slots_at_work(row), detail, options_.executor);
  if (row.executor.empty()) sweep["executor"] = options_.executor;
  return sweep;
}

}  // namespace jobs
