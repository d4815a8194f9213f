// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/slurm_executor.h"

#include <algorithm>
#include <fstream>
#include <numeric>
#include <utility>

#include "jobs/base/provenance.h"
#include "jobs/cluster/shared_folder.h"

namespace jobs::cluster {
namespace {

using std::chrono::milliseconds;

constexpr int kUsualArraySize = 1001;  ///< Slurm's default, where it cannot be asked
constexpr double kMostJobs = 10'000;
constexpr std::size_t kLogTail = 1'000;
constexpr double kSpareTime_s = 300.0;
constexpr milliseconds kFirstPause{1'000};
constexpr milliseconds kLongestPause{60'000};
constexpr std::chrono::seconds kFirstRefusalPause{30};
constexpr int kMostDoublings = 5;

double cost_of(const BatchJob& job, const std::map<std::string, double>& rates, double unknown_s) {
  const auto rate = rates.find(job.kind);
  return rate == rates.end() ? unknown_s : rate->second * job.duration_s;
}

/// A log may hold anything; JSON takes UTF-8 only.
std::string as_utf8(const std::string& text) {
  return nlohmann::json::parse(
             nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace))
      .get<std::string>();
}

/// @param log  of its last task
RunRecord make_failed_record(const LostJob& job, const std::filesystem::path& log) {
  const std::string tail = tail_of(log, kLogTail);
  RunRecord record;
  record.end = RunRecord::End::kFailed;
  record.error_reason = job.reason;
  record.error_detail =
      as_utf8(job.detail + (tail.empty() ? "; its log is empty" : "; the end of its log: " + tail));
  return record;
}

/// Tasks that leave something every so often must not be too much for the folder together: 20 a second.
double delivery_interval_s(int running) { return std::max(30.0, running / 20.0); }

}  // namespace

SlurmExecutor::SlurmExecutor(Site site, ClusterBatches& batches, ExecutorFilter filter,
                             const JobLimits& limits, std::function<void()> changed,
                             std::function<void(const std::string&)> log)
    : site_(std::move(site)),
      batches_(batches),
      filter_(std::move(filter)),
      limits_(limits),
      changed_(std::move(changed)),
      log_(std::move(log)),
      slurm_(site_, stop_.get_token()) {
  thread_ = std::jthread([this] { work(); });
}

SlurmExecutor::~SlurmExecutor() { stop(); }

void SlurmExecutor::wake() {
  {
    const std::lock_guard lock(mutex_);
    ++wakes_;
  }
  woken_.notify_all();
}

void SlurmExecutor::stop() {
  const std::lock_guard lock(stop_mutex_);
  stop_.request_stop();
  if (thread_.joinable()) thread_.join();
}

nlohmann::json SlurmExecutor::status() const {
  nlohmann::json status = status_.json();
  status.update({{"name", kSlurmExecutor}, {"slots", site_.slots * site_.threads}});
  return status;
}

void SlurmExecutor::work() {
  milliseconds pause = site_.folder_poll;
  while (!stop_.stop_requested()) {
    // Before the round, which may fail before refresh_wanted()
    const std::uint64_t seen = count_wakes();
    try {
      do_round(Clock::now());
      pause = site_.folder_poll;
      tell_problem("folder", "");
    } catch (const std::exception& error) {  // the folder's errors, the store's, or no memory
      tell_problem("folder", error.what());
      pause = std::clamp(2 * pause, kFirstPause, kLongestPause);
    }
    std::unique_lock lock(mutex_);
    woken_.wait_for(lock, stop_.get_token(), pause, [&] { return wakes_ != seen; });
  }
}

std::uint64_t SlurmExecutor::count_wakes() {
  const std::lock_guard lock(mutex_);
  return wakes_;
}

void SlurmExecutor::do_round(Clock::time_point now) {
  begin();
  take_results();
  refresh_wanted();
  if (now >= next_look_) look(now);
  take_jobs(now);
}

/// First steps, which are repeated until they succeed.
void SlurmExecutor::begin() {
  if (max_array_size_ > 0) return;
  folder_ = site_.folder / batches_.find_identity();
  std::filesystem::create_directories(folder_);
  std::filesystem::permissions(folder_, std::filesystem::perms(0700));
  if (!lock_) lock_.emplace(folder_);
  program_ = share_program(site_);
  take_over_batches();
  std::string problem;
  const auto limits = slurm_.find_limits(problem);
  max_array_size_ = limits ? limits->max_array_size : kUsualArraySize;
}

/// Batches of a former program: those the store knows, and folders that it does not know any more, whose
/// tasks nobody wants.
void SlurmExecutor::take_over_batches() {
  live_.clear();
  std::set<std::string> known;
  for (const BatchRow& row : batches_.list()) {
    add_batch(row);
    known.insert(row.id);
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_directory() && !known.contains(name)) add_batch({.seq = 0, .id = name, .sweep_id = {}});
  }
}

SlurmExecutor::Live& SlurmExecutor::add_batch(const BatchRow& row) {
  live_.push_back(std::make_unique<Live>(Live{.batch = Batch(row, folder_, site_.grace), .costs_s = {}}));
  Live& live = *live_.back();
  live.batch.read_lists();
  const auto rates = batches_.find_cost_rates();
  std::vector<BatchIndex> wanted;
  for (const BatchJob& job : batches_.find_open_jobs(row.seq)) {
    wanted.push_back(job.batch_index);
    // A job of an unknown kind: the shortest length of a task, so that each job is one.
    live.costs_s[job.batch_index] = cost_of(job, rates, site_.least_task_s * site_.threads);
  }
  live.batch.set_wanted(wanted);
  return live;
}

void SlurmExecutor::prepare(const Live& live) const {
  if (live.batch.is_prepared()) return;
  const BatchRow& row = live.batch.row();
  const double interval_s = delivery_interval_s(site_.slots);
  live.batch.prepare({.batch = row.id, .engine = engine_version(), .limits = limits_,
                      .deliver_every_s = interval_s}, batches_.find_open_jobs(row.seq));
}

void SlurmExecutor::take_results() {
  for (const auto& live : live_) take_results_of(*live);
}

void SlurmExecutor::take_results_of(Live& live) {
  bool any = false;
  for (const auto& file : live.batch.find_new_results()) {
    any = take_file(live, file) || any;
    live.batch.set_seen(file);
  }
  if (any) live.batch.set_wanted(batches_.find_open_indices(live.batch.row().seq));
}

bool SlurmExecutor::take_file(Live& live, const std::filesystem::path& file) {
  const std::string bytes = read_whole(file);  // where the folder cannot be read, it is read again later
  try {
    const ResultFile results = decode_results(bytes);
    if (results.batch != live.batch.row().id) throw FileError("it is of another batch, " + results.batch);
    std::vector<BatchRecord> records;
    for (const BatchResult& result : results.results) {
      records.push_back({.batch_index = result.batch_index, .record = &result.record,
                         .packed_trajectory = &result.packed_trajectory});
    }
    if (batches_.record(live.batch.row().seq, results.provenance, records) == 0) return false;
    changed_();  // now: what follows may fail
    return true;
  } catch (const FileError& error) {
    log_("results are left out, and are computed again: " + file.string() + ": " + error.what());
    return false;
  }
}

/// Jobs may have been cancelled or taken back.
void SlurmExecutor::refresh_wanted() {
  {
    const std::lock_guard lock(mutex_);
    if (wakes_ == seen_wakes_) return;
    seen_wakes_ = wakes_;
  }
  for (const auto& live : live_) {
    const bool had_some = !live->batch.wanted().empty();
    live->batch.set_wanted(batches_.find_open_indices(live->batch.row().seq));
    if (had_some && live->batch.wanted().empty()) next_look_ = {};
  }
}

void SlurmExecutor::look(Clock::time_point now) {
  next_look_ = now + site_.queue_poll;
  std::vector<std::string> names;
  for (const auto& live : live_) std::ranges::copy(live->batch.array_names(), std::back_inserter(names));
  std::optional<Reports> reports(std::in_place);
  std::string problem;
  if (!names.empty()) reports = slurm_.observe(names, problem);
  tell_problem("squeue", problem);
  if (!reports) return;
  status_.set_reports(*reports);
  std::erase_if(live_, [&](const auto& live) {
    const auto own = live->batch.reports_of(*reports);
    act(*live, live->batch.decide(own, now), own, now);
    return retire(*live, own);
  });
}

void SlurmExecutor::act(Live& live, const Decision& decision, const std::map<TaskName, TaskReport>& reports,
                        Clock::time_point now) {
  std::vector<BatchIndex> begun, waiting;
  live.batch.take_running(decision.running, begun, waiting);
  if (!begun.empty() || !waiting.empty()) {
    batches_.set_running(live.batch.row().seq, begun, waiting);
    changed_();
  }
  if (live.batch.wanted().empty()) std::ofstream(live.batch.folder().cancel()).flush();
  cancel(live, decision.cancel, reports);
  fail(live, decision.fail);
  live.batch.clear_refused(reports);
  if (decision.refused && now < live.batch.not_before) return;  // it will be decided again
  std::vector<TaskPlan> tasks = decision.submit;
  std::ranges::copy(plan_unassigned(live, bounds()), std::back_inserter(tasks));
  submit(live, std::move(tasks), now);
}

std::vector<TaskPlan> SlurmExecutor::plan_unassigned(const Live& live, const TaskBounds& bound) {
  const auto indices = live.batch.unassigned();
  if (indices.empty()) return {};
  std::vector<double> costs_s;
  for (const BatchIndex batch_index : indices) costs_s.push_back(live.costs_s.at(batch_index));
  return plan_tasks(indices, costs_s, bound);
}

void SlurmExecutor::cancel(Live& live, const std::vector<TaskName>& tasks,
                           const std::map<TaskName, TaskReport>& reports) {
  std::map<std::string, std::vector<int>> by_array;
  for (const TaskName& name : tasks) by_array[reports.at(name).array_job].push_back(name.index);
  if (tasks.size() > 1 && live.batch.wanted().empty()) {
    for (const std::string& name : live.batch.array_names()) slurm_.cancel_array(name);
    return;
  }
  for (const auto& [array_job, indices] : by_array) slurm_.cancel_tasks(array_job, indices);
}

void SlurmExecutor::fail(Live& live, const std::vector<LostJob>& jobs) {
  if (jobs.empty()) return;
  std::vector<RunRecord> records(jobs.size());
  std::vector<BatchRecord> placed;
  const std::string no_trajectory;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const TaskName& task = jobs[i].task;
    records[i] = make_failed_record(jobs[i], live.batch.folder().log(task.generation, task.index));
    placed.push_back({.batch_index = jobs[i].batch_index, .record = &records[i],
                      .packed_trajectory = &no_trajectory});
  }
  batches_.record(live.batch.row().seq, own_provenance(), placed);
  changed_();
  live.batch.set_wanted(batches_.find_open_indices(live.batch.row().seq));
}

void SlurmExecutor::submit(Live& live, std::vector<TaskPlan> tasks, Clock::time_point now) {
  const auto most = static_cast<std::size_t>(std::max(1, std::min(max_array_size_, site_.most_tasks())));
  for (std::size_t first = 0; first < tasks.size(); first += most) {
    const auto end = std::min(first + most, tasks.size());
    submit_generation(live,
                      {tasks.begin() + static_cast<std::ptrdiff_t>(first),
                       tasks.begin() + static_cast<std::ptrdiff_t>(end)},
                      now);
  }
}

/// The list is in the folder before Slurm is asked. If Slurm does not say that it has the array, it may have
/// it all the same: only a look at its queue tells, after some time.
void SlurmExecutor::submit_generation(Live& live, const std::vector<TaskPlan>& tasks, Clock::time_point now) {
  prepare(live);
  // Sites remove files of a shared folder that nobody has used for weeks.
  if (!std::filesystem::exists(program_)) program_ = share_program(site_);
  const int generation = live.batch.generations();
  const std::string arguments = "run-task " + shell_quoted(live.batch.folder().path.string()) + " " +
                                std::to_string(generation);
  live.batch.add_generation(tasks, make_script(site_, program_, arguments));
  const Submission answer = slurm_.submit(order_of(live, generation, tasks));
  tell_problem("sbatch", answer.problem);
  if (answer.array_job) live.batch.refusals = 0;
  else pause_after_refusal(live, generation, now);
}

ArrayOrder SlurmExecutor::order_of(const Live& live, int generation,
                                   const std::vector<TaskPlan>& tasks) const {
  const BatchFolder& folder = live.batch.folder();
  const auto largest = std::ranges::max_element(tasks, {}, &TaskPlan::memory_factor);
  return {.name = live.batch.array_name(generation),
          .tasks = static_cast<int>(tasks.size()),
          .time_s = time_limit_s(live, tasks),
          .memory_factor = largest->memory_factor,
          .folder = folder.path,
          .script = folder.script(generation),
          .log = (folder.path / "log" / ("g" + std::to_string(generation) + "-%a.log")).string()};
}

/// Each refusal in a row makes the pause before the next try twice as long.
void SlurmExecutor::pause_after_refusal(Live& live, int generation, Clock::time_point now) {
  live.batch.set_refused(generation);
  const int doublings = std::min(live.batch.refusals++, kMostDoublings);
  live.batch.not_before = now + kFirstRefusalPause * (1 << doublings);
}

double SlurmExecutor::time_limit_s(const Live& live, const std::vector<TaskPlan>& tasks) const {
  double longest_s = 0.0;
  for (const TaskPlan& task : tasks) {
    double cost_s = 0.0;
    for (const BatchIndex batch_index : task.indices) cost_s += live.costs_s.at(batch_index);
    longest_s = std::max(longest_s, task.time_factor * (2.0 * cost_s / site_.threads + kSpareTime_s));
  }
  return longest_s;
}

void SlurmExecutor::take_jobs(Clock::time_point now) {
  // Some tasks are left for a sweep that comes later: it need not wait for the tasks of a large one to end.
  const int most = site_.most_tasks();
  for (int free_tasks = most - open_tasks(); free_tasks > 0 && 4 * free_tasks >= most;
       free_tasks = most - open_tasks()) {
    const bool refused =
        std::ranges::any_of(live_, [](const auto& live) { return live->batch.has_refused(); });
    if (refused || !take_batch(std::max(1, free_tasks / 2), now)) return;
  }
}

bool SlurmExecutor::take_batch(int free_tasks, Clock::time_point now) {
  const bool are_costs_known = !batches_.find_cost_rates().empty();
  // While nothing is known of what jobs cost, the first ones are to tell.
  if (!are_costs_known && !live_.empty()) return false;
  TaskBounds bound = bounds();
  bound.most_tasks = free_tasks;
  const auto batch = batches_.claim(filter_, choose_job_count(bound, are_costs_known));
  if (!batch) return false;
  Live& live = add_batch(*batch);
  double total_s = 0.0;
  for (const auto& [batch_index, cost_s] : live.costs_s) total_s += cost_s;
  job_cost_s_ = std::max(1e-6, total_s / static_cast<double>(live.costs_s.size()));
  submit(live, plan_unassigned(live, bound), now);
  return true;
}

std::size_t SlurmExecutor::choose_job_count(const TaskBounds& bound, bool are_costs_known) const {
  if (!job_cost_s_ || !are_costs_known) return static_cast<std::size_t>(probe_size(bound));
  const double wished =
      bound.most_tasks * std::max(site_.task_s, site_.least_task_s) * site_.threads / *job_cost_s_;
  return static_cast<std::size_t>(std::clamp(wished, 1.0, kMostJobs));
}

/// Forgets a batch of which nothing is left, here and in Slurm. @returns whether nothing was left
bool SlurmExecutor::retire(const Live& live, const std::map<TaskName, TaskReport>& reports) {
  const bool alive =
      std::ranges::any_of(reports, [](const auto& report) { return is_alive(report.second.phase); });
  if (alive || !live.batch.wanted().empty()) return false;
  batches_.end(live.batch.row().seq);
  std::error_code ignored;  // files that cannot be removed are found at the next start
  std::filesystem::remove_all(live.batch.folder().path, ignored);
  return true;
}

int SlurmExecutor::open_tasks() const {
  return std::accumulate(live_.begin(), live_.end(), 0,
                         [](int sum, const auto& live) { return sum + live->batch.open_tasks(); });
}

TaskBounds SlurmExecutor::bounds() const {
  return {.threads = site_.threads, .slots = site_.slots, .most_tasks = site_.most_tasks(),
          .task_s = site_.task_s,
          .least_task_s = site_.least_task_s};
}

void SlurmExecutor::tell_problem(const std::string& topic, const std::string& text) {
  if (status_.set_problem(topic, text) && !text.empty()) log_(text);
}

}  // namespace jobs::cluster
