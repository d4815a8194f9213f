// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/run_task.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "jobs/base/content_id.h"
#include "jobs/cluster/batch_files.h"
#include "jobs/local/local_pool.h"
#include "jobs/trajectories/trajectory_codec.h"

namespace jobs::cluster {
namespace {

using SteadyClock = std::chrono::steady_clock;
using std::chrono::milliseconds;

std::string file_prefix(const TaskOrder& order) {
  return "g" + std::to_string(order.generation) + "-" + std::to_string(order.index) + "-";
}

/// Results of an earlier run of the same task: Slurm starts a task again whose node has failed.
std::set<BatchIndex> find_done(const TaskOrder& order, const std::filesystem::path& out,
                               const std::function<void(const std::string&)>& log) {
  std::set<BatchIndex> done;
  for (const auto& entry : std::filesystem::directory_iterator(out)) {
    if (!entry.path().filename().string().starts_with(file_prefix(order))) continue;
    try {
      for (const BatchResult& result : decode_results(read_whole(entry.path())).results)
        done.insert(result.batch_index);
    } catch (const FileError& error) {
      log(entry.path().string() + ": " + error.what());
    }
  }
  return done;
}

TaskPlan read_plan(const TaskOrder& order, const BatchFolder& folder) {
  const auto tasks = read_task_list(read_whole(folder.list(order.generation)));
  if (order.index < 0 || static_cast<std::size_t>(order.index) >= tasks.size()) {
    throw FileError(folder.list(order.generation).string() + " has no task " + std::to_string(order.index));
  }
  return tasks[static_cast<std::size_t>(order.index)];
}

/// Jobs of a task that have no result from it yet.
std::vector<BatchIndex> find_remaining(const TaskOrder& order, const BatchFolder& folder,
                                       const std::function<void(const std::string&)>& log) {
  TaskPlan plan = read_plan(order, folder);
  const std::set<BatchIndex> done = find_done(order, folder.out(), log);
  std::erase_if(plan.indices, [&](BatchIndex batch_index) { return done.contains(batch_index); });
  return plan.indices;
}

/// @throws FileError, also if the batch is for another engine
BatchJobs read_own_jobs(const BatchFolder& folder, const std::vector<BatchIndex>& indices,
                        BatchHeader& header) {
  BatchJobs jobs = read_jobs(folder.jobs(), indices, header);
  if (header.engine != engine_version())
    throw FileError("this program's engine is " + engine_version() + ", the batch is for " + header.engine);
  return jobs;
}

/// The results that are ready, and the files they go to.
class Delivery {
 public:
  /// @param jobs  number of those whose results are to come
  Delivery(const TaskOrder& order, BatchFolder folder, std::string batch, std::size_t jobs)
      : order_(order), folder_(std::move(folder)), batch_(std::move(batch)), jobs_(jobs) {}

  void add(BatchIndex batch_index, RunRecord record) {
    BatchResult result{.batch_index = batch_index, .record = std::move(record), .packed_trajectory = {}};
    if (!result.record.trajectory.columns.empty())
      result.packed_trajectory = encode_trajectory(result.record.trajectory);
    result.record.trajectory = {};
    const std::lock_guard lock(mutex_);
    ready_bytes_ += result.packed_trajectory.size();
    ready_.push_back(std::move(result));
    ++total_;
    changed_.notify_all();
  }

  /// Waits until all results have come, or for some time. Returns whether they have.
  bool await_all(milliseconds time) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, time, [&] { return total_ >= jobs_; });
  }

  /// @returns whether so much is ready that it should not wait: one file is read at once at the other end
  bool is_large() {
    constexpr std::size_t kLarge = std::size_t{32} << 20U;
    const std::lock_guard lock(mutex_);
    return ready_bytes_ >= kLarge;
  }

  /// Writes what is ready. @throws FileError, and then it is still ready
  void deliver() {
    std::unique_lock lock(mutex_);
    if (ready_.empty()) return;
    ResultFile file{.batch = batch_, .provenance = own_provenance(), .results = std::move(ready_)};
    ready_.clear();
    ready_bytes_ = 0;
    lock.unlock();
    try {
      write(file);
    } catch (const FileError&) {
      lock.lock();
      std::ranges::move(ready_, std::back_inserter(file.results));
      ready_ = std::move(file.results);
      throw;
    }
  }

 private:
  void write(const ResultFile& file) const {
    // A name of its own: another process may have been given the same task, and has other jobs ready.
    constexpr std::size_t kDigits = 16;
    const std::string bytes = encode_results(file);
    write_durably(folder_.out() / (file_prefix(order_) + sha256_hex(bytes).substr(0, kDigits) + ".results"),
                  bytes);
  }

  const TaskOrder& order_;
  const BatchFolder folder_;
  const std::string batch_;
  const std::size_t jobs_;

  std::mutex mutex_;  // guards the rest
  std::condition_variable changed_;
  std::vector<BatchResult> ready_;
  std::size_t ready_bytes_ = 0;
  std::size_t total_ = 0;
};

/// Hands out jobs one by one.
class Remaining {
 public:
  explicit Remaining(BatchJobs jobs) : jobs_(std::move(jobs)) {}

  void claim(const OnClaim& on_claim) {
    const std::lock_guard lock(mutex_);
    if (jobs_.empty()) return;
    const auto& [batch_index, parameters] = *jobs_.begin();
    on_claim(ClaimedJob{.seq = batch_index, .id = std::to_string(batch_index), .attempt = 1,
                        .parameters = parameters});
    jobs_.erase(jobs_.begin());
  }

  /// Takes back a job that has no result, as there was no memory to note its end.
  void put_back(const ClaimedJob& job) {
    const std::lock_guard lock(mutex_);
    jobs_.emplace(static_cast<BatchIndex>(job.seq), job.parameters);
  }

 private:
  std::mutex mutex_;  // guards jobs_
  BatchJobs jobs_;
};

/// @param remaining, delivery  outlive the source
JobSource source_of(Remaining& remaining, Delivery& delivery) {
  return {.claim = [&remaining](const OnClaim& on_claim) { remaining.claim(on_claim); },
          .record = [&delivery](const ClaimedJob& job, const RunRecord& record,
                                const OnClaim&) { delivery.add(static_cast<BatchIndex>(job.seq), record); },
          .requeue = [&remaining](const ClaimedJob& job) { remaining.put_back(job); }};
}

/// Looks now and then for the file by which a batch is cancelled.
class CancelWatch {
 public:
  explicit CancelWatch(std::filesystem::path file) : file_(std::move(file)) {}

  bool sees_file() {
    const auto now = SteadyClock::now();
    if (now < next_look_) return false;
    next_look_ = now + std::chrono::seconds(2);
    return std::filesystem::exists(file_);
  }

 private:
  const std::filesystem::path file_;
  SteadyClock::time_point next_look_{};
};

void try_to_deliver(Delivery& delivery, const std::function<void(const std::string&)>& log) {
  try {
    delivery.deliver();
  } catch (const FileError& error) {
    log(error.what());
  }
}

/// Delivers what is ready now and then, until every job has a result or the task is to stop.
void deliver_meanwhile(Delivery& delivery, double interval_s,
                       const std::function<bool()>& stop_requested,
                       const std::function<void(const std::string&)>& log) {
  const auto interval =
      std::chrono::duration_cast<SteadyClock::duration>(std::chrono::duration<double>(interval_s));
  auto next = SteadyClock::now() + interval;
  while (!delivery.await_all(milliseconds(100)) && !stop_requested()) {
    const auto now = SteadyClock::now();
    if (now < next && !delivery.is_large()) continue;
    next = now + interval;
    try_to_deliver(delivery, log);
  }
}

/// The last results are worth waiting for: the folder may be full or away for a while.
void deliver_at_the_end(Delivery& delivery, const std::function<void(const std::string&)>& log) {
  constexpr milliseconds kPause{5'000};
  constexpr int kTries = 60;
  for (int tried = 1;; ++tried) {
    try {
      return delivery.deliver();
    } catch (const FileError& error) {
      log(error.what());
      if (tried == kTries) throw;
    }
    std::this_thread::sleep_for(kPause);
  }
}

}  // namespace

bool run_task(const TaskOrder& order, const std::function<bool()>& stop_requested,
              const std::function<void(const std::string&)>& log) {
  const BatchFolder folder{order.folder};
  const std::vector<BatchIndex> indices = find_remaining(order, folder, log);
  if (indices.empty()) return true;
  BatchHeader header;
  Remaining remaining(read_own_jobs(folder, indices, header));
  Delivery delivery(order, folder, header.batch, indices.size());
  LocalPool pool(source_of(remaining, delivery), order.runner, order.threads, log, header.limits);
  CancelWatch watch(folder.cancel());
  const auto is_to_stop = [&] { return stop_requested() || watch.sees_file(); };
  deliver_meanwhile(delivery, header.deliver_every_s, is_to_stop, log);
  pool.stop();
  deliver_at_the_end(delivery, log);
  return delivery.await_all(milliseconds(0));
}

}  // namespace jobs::cluster
