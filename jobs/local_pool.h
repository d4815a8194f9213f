#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "jobs/executor.h"
#include "jobs/run_record.h"
#include "jobs/store.h"

namespace jobs {

/// Where an executor gets its jobs and leaves what became of them. Members may be called from any thread and throw StorageError.
struct JobSource {
  std::function<std::optional<ClaimedJob>()> claim;
  std::function<void(const ClaimedJob&, const RunRecord&)> record;
  std::function<void(const ClaimedJob&)> give_back;
};

/// Computes jobs on threads of this process, as many at a time as it has threads. Threads sleep while there is nothing to do.
class LocalPool : public Executor {
 public:
  /// @param log     told what needs a human's eye; must not throw
  /// @param limits  of each job
  LocalPool(JobSource source, Runner runner, int threads, std::function<void(const std::string&)> log, const JobLimits& limits = {});
  ~LocalPool() override;  ///< stop()

  void wake() override;
  void stop_job(const std::string& id) override;
  /// Stops all running jobs and gives them back to the source, too.
  void stop() override;
  [[nodiscard]] int slots() const override { return slots_; }
  [[nodiscard]] nlohmann::json status() const override;

 private:
  void work(const std::stop_token& stop);
  std::optional<ClaimedJob> claim_next(const std::stop_token& stop, std::stop_source& job_stop);
  void compute(const ClaimedJob& job, const std::stop_token& stop, const std::stop_token& job_stop);
  /// Empty if there was no memory even to say so.
  [[nodiscard]] std::optional<RunRecord> run(const ClaimedJob& job, const std::stop_token& stop, const std::stop_token& job_stop) const;
  /// @param record  empty: the job goes back to the queue
  void deliver(const ClaimedJob& job, const std::optional<RunRecord>& record, const std::stop_token& stop);
  void tell(const char* what, const std::string& id, const std::exception& error) const noexcept;
  void pause(std::chrono::milliseconds time, const std::stop_token& stop);

  const JobSource source_;
  const Runner runner_;
  const JobLimits limits_;
  const int slots_;
  const std::function<void(const std::string&)> log_;

  std::mutex claim_mutex_;  // guards running_; held while claiming, so that a job is in the store as running and here at once
  /// By id and attempt: a job that was cancelled and queued again may begin before its former attempt has stopped.
  std::map<std::pair<std::string, std::int64_t>, std::stop_source> running_;

  std::mutex wake_mutex_;  // guards wakes_
  std::condition_variable_any wake_;
  std::uint64_t wakes_ = 0;

  std::mutex stop_mutex_;  // guards threads_, which stop() may join but once
  std::vector<std::jthread> threads_;
};

}  // namespace jobs
