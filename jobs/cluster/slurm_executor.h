// SPDX-License-Identifier: Apache-2.0
#pragma once

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
#include <vector>

#include "jobs/cluster/batch.h"
#include "jobs/cluster/cluster_status.h"
#include "jobs/cluster/plan_tasks.h"
#include "jobs/cluster/site.h"
#include "jobs/cluster/slurm.h"
#include "jobs/runs/executor.h"
#include "jobs/runs/job_limits.h"
#include "jobs/store/cluster_batches.h"
#include "jobs/store/store_lock.h"

namespace jobs::cluster {

/// Has jobs computed by a Slurm cluster. One thread does the same again and again, after a start as at any
/// time: it takes the results that have come into the shared folder, asks Slurm which tasks may still deliver
/// some, gives what is lost to new tasks, and takes jobs from the store while more tasks may be submitted.
/// Tasks go on when the service ends; the next one with the same store takes their results.
class SlurmExecutor : public Executor {
 public:
  /// @param changed  told when jobs have begun, ended or gone back to waiting; from the executor's thread,
  ///     also before the constructor has returned
  /// @param log      told what needs a human's eye; both must not throw
  SlurmExecutor(Site site, ClusterBatches& batches, ExecutorFilter filter, const JobLimits& limits,
                std::function<void()> changed, std::function<void(const std::string&)> log);
  ~SlurmExecutor() override;  ///< stop()

  void wake() override;
  void stop_job(const std::string&, std::int64_t) override { wake(); }
  void stop() override;
  [[nodiscard]] nlohmann::json status() const override;

 private:
  /// A batch, and what its jobs are expected to cost on one thread, [s].
  struct Live {
    Batch batch;
    std::map<BatchIndex, double> costs_s;
  };

  void work();
  [[nodiscard]] std::uint64_t count_wakes();
  void do_round(Clock::time_point now);
  void begin();
  void take_over_batches();
  void take_results();
  void take_results_of(Live& live);
  /// @returns whether jobs have ended
  bool take_file(Live& live, const std::filesystem::path& file);
  void refresh_wanted();
  void look(Clock::time_point now);
  void act(Live& live, const Decision& decision, const std::map<TaskName, TaskReport>& reports,
           Clock::time_point now);
  void cancel(Live& live, const std::vector<TaskName>& tasks, const std::map<TaskName, TaskReport>& reports);
  void fail(Live& live, const std::vector<LostJob>& jobs);
  void submit(Live& live, std::vector<TaskPlan> tasks, Clock::time_point now);
  void submit_generation(Live& live, const std::vector<TaskPlan>& tasks, Clock::time_point now);
  [[nodiscard]] ArrayOrder order_of(const Live& live, int generation,
                                    const std::vector<TaskPlan>& tasks) const;
  static void pause_after_refusal(Live& live, int generation, Clock::time_point now);
  [[nodiscard]] double time_limit_s(const Live& live, const std::vector<TaskPlan>& tasks) const;
  void take_jobs(Clock::time_point now);
  bool take_batch(int free_tasks, Clock::time_point now);
  /// Jobs that fill so many tasks. @param are_costs_known  whether jobs have been computed before
  [[nodiscard]] std::size_t choose_job_count(const TaskBounds& bound, bool are_costs_known) const;
  Live& add_batch(const BatchRow& row);
  void prepare(const Live& live) const;
  [[nodiscard]] static std::vector<TaskPlan> plan_unassigned(const Live& live, const TaskBounds& bound);
  [[nodiscard]] bool retire(const Live& live, const std::map<TaskName, TaskReport>& reports);
  [[nodiscard]] int open_tasks() const;
  [[nodiscard]] TaskBounds bounds() const;
  void tell_problem(const std::string& topic, const std::string& text);

  const Site site_;
  ClusterBatches& batches_;
  const ExecutorFilter filter_;
  const JobLimits limits_;
  const std::function<void()> changed_;
  const std::function<void(const std::string&)> log_;
  std::stop_source stop_;
  const Slurm slurm_;
  ClusterStatus status_;

  // Used by the thread alone.
  std::optional<StoreLock> lock_;        ///< on the folder: two services must not manage the same batches
  std::filesystem::path folder_;         ///< of this store's batches
  std::filesystem::path program_;        ///< as nodes see it
  int max_array_size_ = 0;
  std::vector<std::unique_ptr<Live>> live_;
  std::optional<double> job_cost_s_;     ///< of the jobs of the last batch, on the average
  Clock::time_point next_look_{};

  std::mutex mutex_;  // guards wakes_
  std::condition_variable_any woken_;
  std::uint64_t wakes_ = 1;
  std::uint64_t seen_wakes_ = 0;  ///< by refresh_wanted(), of the thread alone

  std::mutex stop_mutex_;  // guards thread_, which stop() may join but once
  std::jthread thread_;
};

}  // namespace jobs::cluster
