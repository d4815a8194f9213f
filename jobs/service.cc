#include "jobs/service.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "jobs/expand.h"
#include "jobs/local_pool.h"
#include "jobs/parameter_value.h"
#include "jobs/resource_json.h"
#include "jobs/run_record.h"
#include "jobs/store.h"
#include "jobs/time_text.h"
#include "jobs/trajectory_codec.h"

namespace jobs {
namespace {

using nlohmann::json;

ServiceOptions with_defaults(ServiceOptions options) {
  if (!options.runner) options.runner = engine_runner();
  if (!options.log) options.log = [](const std::string&) {};
  return options;
}

void check_page(const PageQuery& query, std::string_view id_prefix) {
  constexpr std::size_t kLargestPage = 1000;
  std::vector<Fault> faults;
  if (query.limit < 1 || query.limit > kLargestPage) faults.push_back({"/limit", "must be an integer in [1, " + std::to_string(kLargestPage) + "]"});
  if (!query.cursor.empty() && !is_id(query.cursor, id_prefix)) faults.push_back({"/cursor", "must be the next_cursor of another page"});
  if (!query.state.empty() && std::ranges::find(kJobStates, query.state) == kJobStates.end()) {
    faults.push_back({"/state", "must be one of queued, running, succeeded, failed, cancelled"});
  }
  if (!faults.empty()) throw InvalidRequest(std::move(faults));
}

/// @param rows  one more than the page takes, if there are as many
template <typename Row, typename ToJson>
json page_json(const std::vector<Row>& rows, std::size_t limit, const ToJson& to_json) {
  json items = json::array();
  for (std::size_t i = 0; i < std::min(limit, rows.size()); ++i) items.push_back(to_json(rows[i]));
  return {{"items", std::move(items)}, {"next_cursor", rows.size() > limit ? rows[limit - 1].id : ""}};
}

void check_trajectory_query(const TrajectoryQuery& query, const std::vector<engine::QuantityInfo>& channels) {
  std::vector<std::string_view> known;
  for (const auto& channel : channels) known.push_back(channel.key);
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < query.channels.size(); ++i) {
    if (std::ranges::find(known, query.channels[i]) != known.end()) continue;
    faults.push_back({"/channels/" + std::to_string(i), "\"" + query.channels[i] + "\": " + describe_unknown_key(query.channels[i], known)});
  }
  if (query.from && std::isnan(*query.from)) faults.push_back({"/from", "must be a number"});
  if (query.to && std::isnan(*query.to)) faults.push_back({"/to", "must be a number"});
  if (query.from && query.to && *query.from > *query.to) faults.push_back({"/to", "must not be less than from"});
  if (!faults.empty()) throw InvalidRequest(std::move(faults));
}

/// t_s first, then the channels that are asked for, each once.
std::vector<std::string> wanted_channels(const std::vector<std::string>& asked) {
  if (asked.empty()) return {};
  std::vector<std::string> wanted{"t_s"};
  for (const std::string& channel : asked) {
    if (std::ranges::find(wanted, channel) == wanted.end()) wanted.push_back(channel);
  }
  return wanted;
}

/// @param trajectory  with t_s as its first column
void cut(const TrajectoryQuery& query, engine::Trajectory& trajectory) {
  if (trajectory.columns.empty()) return;
  const std::vector<double>& t = trajectory.columns.front();
  const auto begin = query.from ? std::ranges::lower_bound(t, *query.from) - t.begin() : std::ptrdiff_t{0};
  const auto end = query.to ? std::ranges::upper_bound(t, *query.to) - t.begin() : std::ssize(t);
  for (std::vector<double>& column : trajectory.columns) column = std::vector<double>(column.begin() + begin, column.begin() + std::max(begin, end));
}

}  // namespace

class Service::Impl {
 public:
  explicit Impl(ServiceOptions options)
      : options_(with_defaults(std::move(options))),
        store_(options_.store) {
    if (options_.start == Start::kAtOnce) start();
  }

  void start() {
    if (pool_) return;
    pool_.emplace(JobSource{.claim = [this] { return store_.claim(); },
                            .record = [this](const ClaimedJob& job, const RunRecord& run) { record(job, run); },
                            .give_back = [this](const ClaimedJob& job) { store_.give_back(job); }},
                  options_.runner, options_.threads, options_.log);
  }

  json submit_sweep(const nlohmann::ordered_json& request) {
    check_open();
    const SweepPlan plan = plan_sweep(request, options_.max_sweep_jobs);
    const std::string id = store_.add_sweep(plan, request.dump(), options_.max_queued_jobs);
    wake();
    return find_sweep(id).value();
  }

  json submit_job(const json& parameters) {
    check_open();
    const std::string id = store_.add_job(plan_job(parameters), options_.max_queued_jobs);
    wake();
    return find_job(id).value();
  }

  [[nodiscard]] std::optional<json> find_sweep(const std::string& id) const {
    const auto row = store_.find_sweep(id);
    return row ? std::optional(sweep_json(*row, options_.threads, Detail::kFull)) : std::nullopt;
  }

  [[nodiscard]] std::optional<json> find_job(const std::string& id) const {
    const auto row = store_.find_job(id);
    return row ? std::optional(job_json(*row, Detail::kFull)) : std::nullopt;
  }

  [[nodiscard]] json list_sweeps(const PageQuery& query) const {
    check_page(query, kSweepPrefix);
    return page_json(store_.list_sweeps(query.state, query.cursor, query.limit + 1), query.limit,
                     [&](const SweepRow& row) { return sweep_json(row, options_.threads, Detail::kListing); });
  }

  [[nodiscard]] json list_jobs(const PageQuery& query) const {
    check_page(query, kJobPrefix);
    return page_json(store_.list_jobs(query.state, query.cursor, query.limit + 1), query.limit,
                     [](const JobRow& row) { return job_json(row, Detail::kListing); });
  }

  [[nodiscard]] std::optional<ResultTable> find_results(const std::string& sweep_id) const {
    const auto sweep = store_.find_sweep(sweep_id);
    if (!sweep) return std::nullopt;
    return result_table(*sweep, store_.list_results(sweep_id));
  }

  [[nodiscard]] std::optional<engine::Trajectory> find_trajectory(const std::string& job_id, const TrajectoryQuery& query) const {
    const auto blob = store_.find_trajectory(job_id);
    if (!blob) return std::nullopt;
    try {
      const auto bytes = std::as_bytes(std::span(*blob));
      check_trajectory_query(query, decode_channels(bytes));
      engine::Trajectory trajectory = decode_trajectory(bytes, wanted_channels(query.channels));
      cut(query, trajectory);
      return trajectory;
    } catch (const DamagedTrajectory& damage) {
      throw StorageError("the trajectory of " + job_id + " cannot be read: " + damage.what(), 0, false);
    }
  }

  [[nodiscard]] Load find_load() const { return store_.find_load(); }

  std::optional<json> cancel_sweep(const std::string& id) {
    return apply(store_.cancel_sweep(id), "the sweep has ended") ? find_sweep(id) : std::nullopt;
  }

  std::optional<json> cancel_job(const std::string& id) { return apply(store_.cancel_job(id), "the job has ended") ? find_job(id) : std::nullopt; }

  bool delete_sweep(const std::string& id) {
    const DeleteOutcome outcome = store_.delete_sweep(id);
    if (outcome == DeleteOutcome::kNotEnded) throw WrongState("the sweep has not ended; cancel it first");
    if (outcome == DeleteOutcome::kDone) tell_change();
    return outcome == DeleteOutcome::kDone;
  }

  bool wait_for_sweep(const std::string& id, std::chrono::milliseconds at_most) const {
    // The largest waits would overflow the clock.
    const auto until = std::chrono::steady_clock::now() + std::min<std::chrono::milliseconds>(at_most, std::chrono::years(10));
    for (;;) {
      std::unique_lock lock(change_mutex_);
      const std::uint64_t seen = changes_;
      lock.unlock();
      const auto ended = store_.has_sweep_ended(id);
      if (!ended) return false;
      if (*ended) return true;
      lock.lock();
      if (!changed_.wait_until(lock, until, [&] { return changes_ != seen; })) return false;
    }
  }

  void stop() {
    stopped_ = true;
    if (pool_) pool_->stop();
  }

 private:
  void check_open() const {
    if (stopped_) throw WrongState("the service has been stopped and takes nothing new");
  }

  void wake() {
    if (pool_) pool_->wake();
  }

  void record(const ClaimedJob& job, const RunRecord& run) {
    store_.record(job, run);
    tell_change();
  }

  /// Does the rest of a cancellation. False if there is nothing of that id.
  bool apply(const Cancellation& cancellation, const char* why_not) {
    if (cancellation.outcome == CancelOutcome::kMissing) return false;
    if (cancellation.outcome == CancelOutcome::kEnded) throw WrongState(why_not);
    for (const std::string& job : cancellation.running) {
      if (pool_) pool_->stop_job(job);
    }
    wake();  // jobs of the same content may have waited
    tell_change();
    return true;
  }

  void tell_change() {
    {
      const std::lock_guard lock(change_mutex_);
      ++changes_;
    }
    changed_.notify_all();
  }

  const ServiceOptions options_;
  std::atomic<bool> stopped_ = false;
  mutable std::mutex change_mutex_;  // guards changes_
  mutable std::condition_variable changed_;
  std::uint64_t changes_ = 0;  ///< how often a sweep may have ended
  Store store_;
  std::optional<LocalPool> pool_;  // ends before the store it works for; empty before start()
};

Service::Service(ServiceOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}
Service::~Service() { stop(); }

void Service::start() { impl_->start(); }
json Service::submit_sweep(const nlohmann::ordered_json& request) { return impl_->submit_sweep(request); }
json Service::submit_job(const json& parameters) { return impl_->submit_job(parameters); }
std::optional<json> Service::find_sweep(const std::string& id) const { return impl_->find_sweep(id); }
std::optional<json> Service::find_job(const std::string& id) const { return impl_->find_job(id); }
json Service::list_sweeps(const PageQuery& query) const { return impl_->list_sweeps(query); }
json Service::list_jobs(const PageQuery& query) const { return impl_->list_jobs(query); }
std::optional<ResultTable> Service::find_results(const std::string& sweep_id) const { return impl_->find_results(sweep_id); }
std::optional<engine::Trajectory> Service::find_trajectory(const std::string& job_id, const TrajectoryQuery& query) const {
  return impl_->find_trajectory(job_id, query);
}
Load Service::find_load() const { return impl_->find_load(); }
std::optional<json> Service::cancel_sweep(const std::string& id) { return impl_->cancel_sweep(id); }
std::optional<json> Service::cancel_job(const std::string& id) { return impl_->cancel_job(id); }
bool Service::delete_sweep(const std::string& id) { return impl_->delete_sweep(id); }
bool Service::wait_for_sweep(const std::string& id, std::chrono::milliseconds at_most) const { return impl_->wait_for_sweep(id, at_most); }
void Service::stop() { impl_->stop(); }

Outcome run_job(const json& parameters, const engine::StopQuery& stop_requested) {
  const json completed = complete_parameters(parameters, "");
  const std::int64_t started_ms = now_unix_ms();
  RunRecord record = run_and_record(to_job_spec(completed), engine_runner(), stop_requested);
  return {.job = unstored_job_json(completed, record, started_ms, now_unix_ms()), .trajectory = rounded_to_stored(std::move(record.trajectory))};
}

}  // namespace jobs
