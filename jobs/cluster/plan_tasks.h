// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "jobs/cluster/task_list.h"

namespace jobs::cluster {

/// Bounds on the tasks into which jobs are put.
struct TaskBounds {
  int threads = 1;            ///< of a task
  int slots = 1;              ///< tasks that run at a time
  int most_tasks = 1;
  double task_s = 600.0;      ///< that a task is to take
  double least_task_s = 60.0; ///< that a task is to take at least
};

/// Puts jobs into tasks, each a run of jobs that follow one another: about three tasks a slot, so that the
/// last ones end together, but none shorter than is worth its start or longer than task_s, if that many tasks
/// are allowed.
/// @param costs_s  of the jobs by index, on one thread
[[nodiscard]] std::vector<TaskPlan> plan_tasks(const std::vector<BatchIndex>& indices,
                                               const std::vector<double>& costs_s, const TaskBounds& bounds);

/// Number of jobs of a first batch, whose cost is unknown: some for every slot, but not more than are needed
/// to know it.
[[nodiscard]] inline int probe_size(const TaskBounds& bounds) {
  return std::min(2 * bounds.slots * bounds.threads, 100);
}

}  // namespace jobs::cluster
