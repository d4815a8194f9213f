// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "jobs/runs/executor.h"
#include "jobs/runs/job_limits.h"
#include "jobs/runs/run_record.h"
#include "jobs/store/rows.h"

namespace jobs {

/// Source of an executor's jobs, and receiver of their records. Members may be called from any thread and
/// throw StorageError.
struct JobSource {
  /// Hands over a job, if there is one, before anybody else can know that it is running. If taking it throws,
  /// or this does afterwards, it is not.
  std::function<void(const OnClaim&)> claim;
  /// May claim the next job at once, if there is somebody to take it, or do nothing at all; if it hands over
  /// none, claim() is asked.
  std::function<void(const ClaimedJob&, const RunRecord&, const OnClaim&)> record;
  std::function<void(const ClaimedJob&)> requeue;
  RunListener ran{};  ///< before the record is left; empty: nobody is told
};

/// Computes jobs on threads of this process, as many at a time as it has threads. Threads sleep while there
/// is nothing to do.
class LocalPool : public Executor {
 public:
  /// @param log     told what needs a human's eye; must not throw
  /// @param limits  of each job
  LocalPool(JobSource source, Runner runner, int threads, std::function<void(const std::string&)> log,
            const JobLimits& limits = {});
  ~LocalPool() override;  ///< stop()

  void wake() override;
  void stop_job(const std::string& id, std::int64_t attempt) override;
  [[nodiscard]] std::optional<double> find_part_done(const std::string& id) const override;
  /// Stops all running jobs and gives them back to the source, too.
  void stop() override;
  [[nodiscard]] nlohmann::json status() const override;

 private:
  /// A job of one of the threads.
  struct Task {
    ClaimedJob job;
    std::stop_source stop;
    std::shared_ptr<std::atomic<double>> part_done;
  };

  void work(const std::stop_token& stop);
  /// Computes the task, or else a job that it claims, and leaves the one after it in the task. Sleeps until
  /// wake() if there is none.
  void advance(std::optional<Task>& task, const std::stop_token& stop);
  [[nodiscard]] std::uint64_t count_wakes();
  [[nodiscard]] std::optional<Task> claim_next();
  /// Does what is to be done for the job. @returns the next one, if that has been claimed on the way
  [[nodiscard]] std::optional<Task> compute(const Task& task, const std::stop_token& stop);
  /// Empty if there was no memory even to say so.
  [[nodiscard]] std::optional<RunRecord> run(const Task& task, const std::stop_token& stop) const;
  /// @param record  empty: the job goes back to the queue
  [[nodiscard]] std::optional<Task> deliver(const ClaimedJob& job, const std::optional<RunRecord>& record,
                                            const std::stop_token& stop);
  /// Calls hand_over(on_claim) and makes a task of the job that is handed over: one that can be stopped as
  /// soon as others know that it runs.
  template <typename HandOver>
  [[nodiscard]] std::optional<Task> take(const HandOver& hand_over);
  void forget(const ClaimedJob& job) noexcept;
  void tell(const char* what, const std::string& id, const std::exception& error) const noexcept;
  void pause(std::chrono::milliseconds time, const std::stop_token& stop);

  const JobSource source_;
  const Runner runner_;
  const JobLimits limits_;
  const int slots_;
  const std::function<void(const std::string&)> log_;

  // Guards running_; taken while the source is locked, so nothing may be asked of that under it
  mutable std::mutex running_mutex_;
  /// By id and attempt: a job that was cancelled and queued again may begin before its former attempt has
  /// stopped.
  std::map<std::pair<std::string, std::int64_t>, Task> running_;

  std::mutex wake_mutex_;  // guards wakes_
  std::condition_variable_any wake_;
  std::uint64_t wakes_ = 0;

  std::mutex stop_mutex_;  // guards threads_, which stop() may join but once
  std::vector<std::jthread> threads_;
};

}  // namespace jobs
