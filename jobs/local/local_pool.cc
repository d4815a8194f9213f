// SPDX-License-Identifier: Apache-2.0
#include "jobs/local/local_pool.h"

#include <algorithm>
#include <chrono>
#include <new>

#include <malloc.h>
#include <nlohmann/json.hpp>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include "jobs/base/machine.h"
#include "jobs/requests/parameters.h"
#include "jobs/runs/job_limits.h"

namespace jobs {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kFirstRetryPause{500};
constexpr milliseconds kLongestRetryPause{30'000};

/// Solvers give way to the threads that answer users. If the system does not allow it they just do not.
void lower_priority() {
  constexpr int kNice = 10;
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kNice);
  ::pthread_setname_np(::pthread_self(), "rpsup-solver");
}

/// Keeps freed memory for the next job: the allocator would give it back in between, page by page. For the
/// whole process, since the allocator knows no other way.
/// @param threads  that compute jobs
void keep_freed_memory(int threads) {
  constexpr int kKeep = 16 << 20;     // bytes an arena; a job of default output takes some 5 MB
  constexpr int kLargest = 4 << 20;   // larger blocks come from the system, and go back at once
  ::mallopt(M_ARENA_MAX, threads + 2);  // else each thread that answers users would keep as much
  ::mallopt(M_TRIM_THRESHOLD, kKeep);
  ::mallopt(M_MMAP_THRESHOLD, kLargest);
}

}  // namespace

LocalPool::LocalPool(JobSource source, Runner runner, int threads,
                     std::function<void(const std::string&)> log, const JobLimits& limits)
    : source_(std::move(source)),
      runner_(std::move(runner)),
      limits_(limits),
      slots_(threads),
      log_(std::move(log)) {
  keep_freed_memory(threads);
  for (int i = 0; i < threads; ++i) {
    threads_.emplace_back([this](const std::stop_token& stop) { work(stop); });
  }
}

LocalPool::~LocalPool() { stop(); }

void LocalPool::wake() {
  {
    const std::lock_guard lock(wake_mutex_);
    ++wakes_;
  }
  wake_.notify_all();
}

void LocalPool::stop_job(const std::string& id, std::int64_t attempt) {
  const std::lock_guard lock(running_mutex_);
  const auto found = running_.find({id, attempt});
  if (found != running_.end()) found->second.stop.request_stop();
}

std::optional<double> LocalPool::find_part_done(const std::string& id) const {
  const std::lock_guard lock(running_mutex_);
  for (const auto& [attempt, task] : running_) {
    if (attempt.first == id) return task.part_done->load();
  }
  return std::nullopt;
}

nlohmann::json LocalPool::status() const {
  return {{"name", kLocalExecutor}, {"slots", slots_}, {"tasks", nullptr}, {"nodes", {host_name()}},
          {"waiting", nlohmann::json::array()},
          {"problems", nlohmann::json::array()}};
}

void LocalPool::stop() {
  const std::lock_guard lock(stop_mutex_);
  for (std::jthread& thread : threads_) thread.request_stop();
  for (std::jthread& thread : threads_) thread.join();
  threads_.clear();
}

void LocalPool::work(const std::stop_token& stop) {
  lower_priority();
  milliseconds next_pause = kFirstRetryPause;
  std::optional<Task> task;
  while (task || !stop.stop_requested()) {
    try {
      advance(task, stop);
      next_pause = kFirstRetryPause;
    } catch (const std::exception& error) {  // the store's errors, or no memory
      tell("no job could be taken", "", error);
      pause(next_pause, stop);
      next_pause = std::min(2 * next_pause, kLongestRetryPause);
    }
  }
}

void LocalPool::advance(std::optional<Task>& task, const std::stop_token& stop) {
  const std::uint64_t seen = count_wakes();
  if (!task) task = claim_next();
  if (task) {
    task = compute(*task, stop);
    return;
  }
  std::unique_lock lock(wake_mutex_);
  wake_.wait(lock, stop, [&] { return wakes_ != seen; });
}

std::uint64_t LocalPool::count_wakes() {
  const std::lock_guard lock(wake_mutex_);
  return wakes_;
}

template <typename HandOver>
std::optional<LocalPool::Task> LocalPool::take(const HandOver& hand_over) {
  std::optional<Task> task;
  try {
    hand_over([&](const ClaimedJob& job) {
      auto part_done = std::make_shared<std::atomic<double>>(0.0);
      task.emplace(Task{.job = job, .stop = {}, .part_done = std::move(part_done)});
      const std::lock_guard lock(running_mutex_);
      running_.insert_or_assign({job.id, job.attempt}, *task);
    });
  } catch (...) {
    if (task) forget(task->job);
    throw;
  }
  return task;
}

/// Takes no memory: what has been claimed meanwhile would be lost with the exception.
void LocalPool::forget(const ClaimedJob& job) noexcept {
  const std::lock_guard lock(running_mutex_);
  std::erase_if(running_, [&](const auto& running) {
    return running.first.first == job.id && running.first.second == job.attempt;
  });
}

std::optional<LocalPool::Task> LocalPool::claim_next() { return take(source_.claim); }

std::optional<LocalPool::Task> LocalPool::compute(const Task& task, const std::stop_token& stop) {
  const std::optional<RunRecord> record = run(task, stop);
  std::optional<Task> next = deliver(task.job, record, stop);
  // If another job has waited for this one, this thread takes it now: nobody need be woken.
  forget(task.job);
  return next;
}

std::optional<RunRecord> LocalPool::run(const Task& task, const std::stop_token& stop) const {
  const ClaimedJob& job = task.job;
  // Parameters that cannot be read are those of a damaged store or an older program; run_and_record tells the
  // user of the job. It sees the specification that is read here, whose linkage says which metrics there are.
  JobSpec spec;
  const auto read_and_run = [&](const JobSpec&, const engine::StopQuery& query) {
    spec = within_limits(to_job_spec(nlohmann::json::parse(job.parameters)), limits_);
    return runner_(spec, query);
  };
  const auto stopped = [&](double t) {
    task.part_done->store(t / spec.options.duration);
    return stop.stop_requested() || task.stop.stop_requested();
  };
  try {
    RunRecord record = run_and_record(spec, read_and_run, stopped, limits_.wall_time_s);
    if (source_.ran) source_.ran(spec, record);
    return record;
  } catch (const std::bad_alloc& error) {
    tell("the end of a job could not be noted, so it is to be computed again", job.id, error);
    return std::nullopt;
  }
}

/// Nothing computed is thrown away because the disk is full for a while: the record is kept and offered
/// again. If the program ends before that, the job is still marked as running and will be queued again at the
/// next start.
std::optional<LocalPool::Task> LocalPool::deliver(const ClaimedJob& job,
                                                  const std::optional<RunRecord>& record,
                                                  const std::stop_token& stop) {
  bool with_next = true;  // at the first try: what is wrong with the next job must not keep this one's result
  for (milliseconds next_pause = kFirstRetryPause;;
       next_pause = std::min(2 * next_pause, kLongestRetryPause)) {
    with_next = with_next && !stop.stop_requested();
    try {
      if (!record || (record->end == RunRecord::End::kStopped && stop.stop_requested())) {
        source_.requeue(job);
        return std::nullopt;
      }
      return take(
          [&](const OnClaim& on_claim) { source_.record(job, *record, with_next ? on_claim : OnClaim{}); });
    } catch (const std::exception& error) {  // the store's errors, or no memory
      tell("the result could not be stored yet", job.id, error);
    }
    if (stop.stop_requested()) return std::nullopt;
    pause(next_pause, stop);
    with_next = false;
  }
}

void LocalPool::tell(const char* what, const std::string& id, const std::exception& error) const noexcept {
  try {
    log_(std::string(what) + (id.empty() ? "" : " (" + id + ")") + ": " + error.what());
  } catch (
      const std::bad_alloc&) {  // there is no memory to tell it with, and an exception would end the process
  }
}

void LocalPool::pause(milliseconds time, const std::stop_token& stop) {
  std::unique_lock lock(wake_mutex_);
  wake_.wait_for(lock, stop, time, [] { return false; });
}

}  // namespace jobs
