// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "jobs/cluster/task_list.h"
#include "jobs/cluster/task_report.h"

namespace jobs::cluster {

using Clock = std::chrono::steady_clock;

/// A task of a batch as the lists say it, and what is known of its generation.
struct TaskState {
  TaskPlan plan;                ///< as it was written
  /// Of its indices those that have no result yet, and that no later task has taken over
  std::vector<BatchIndex> wanted;
  bool refused = false;         ///< sbatch said that it did not take this generation
};

using TaskStates = std::map<TaskName, TaskState>;

/// A job that no task could compute.
struct LostJob {
  BatchIndex batch_index = 0;
  std::string reason;  ///< "task_failed": its own task failed again and again; "task_lost": Slurm lost its
                       ///< tasks again and again
  std::string detail;
  TaskName task;       ///< the last one, whose log may say more
};

/// Actions for a batch.
struct Decision {
  std::vector<TaskPlan> submit;   ///< as the next generation
  std::vector<TaskName> cancel;   ///< known to Slurm, but not wanted
  std::vector<LostJob> fail;
  std::set<BatchIndex> running;        ///< jobs whose tasks run; others wait
  bool refused = false;                ///< the tasks to submit have been refused before: not at once
};

/// Decides what becomes of the tasks of one batch. The shared folder has the results and the lists; Slurm's
/// word says no more than whether a task may still deliver. A task that has ended, or that Slurm does not
/// know, gets some time for files that show late; then its jobs are lost and are given to new tasks:
///
///   it was cancelled, preempted, its node failed, or is not there   the same again
///   it failed without a log, since its node is broken               the same again
///   it failed, or completed without all results                     the same again; the second time each job
///                                                                   alone; then that job has failed
///   it took too long                                                halves; a job alone gets twice the time
///   it took too much memory                                         once with twice as much; then as failed
///   sbatch refused it                                               the same again; five times, if it is of
///                                                                   more memory or time: then it has failed
///
/// Five losses in a row without a new result, but for those by time, and its jobs have failed.
class Reconciler {
 public:
  explicit Reconciler(Clock::duration grace) : grace_(grace) {}

  /// @param reports  of this batch, by generation and index; they are younger than the tasks
  [[nodiscard]] Decision decide(const TaskStates& tasks, const std::map<TaskName, TaskReport>& reports,
                                Clock::time_point now);

 private:
  [[nodiscard]] bool has_lasted(const TaskName& name, Clock::time_point now);
  [[nodiscard]] bool is_given_up(const TaskName& name, const TaskReport* report, Clock::time_point now);
  [[nodiscard]] bool is_to_be_cancelled(const TaskName& name, const TaskReport* report,
                                        Clock::time_point now);

  const Clock::duration grace_;
  /// Time at which a task was first seen to have ended, or to run although nobody wants it
  std::map<TaskName, Clock::time_point> since_;
};

inline constexpr int kMostTries = 5;
inline constexpr std::size_t kMostParts = 100;  ///< into which a task is split

}  // namespace jobs::cluster
