// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/plan_tasks.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace jobs::cluster {
namespace {

/// @param total_s  of all jobs, on all threads of a task
std::size_t count_tasks(double total_s, std::size_t jobs, const TaskBounds& bounds) {
  constexpr double kTasksPerSlot = 3.0;
  const double even_s = total_s / (kTasksPerSlot * bounds.slots);
  // The number of tasks is a limit, the times are wishes.
  const double longest_s = std::max(bounds.task_s, bounds.least_task_s);
  const double wished_s =
      std::max(std::clamp(even_s, bounds.least_task_s, longest_s), total_s / bounds.most_tasks);
  const auto wished = static_cast<std::size_t>(
      std::clamp(total_s / wished_s + 0.5, 1.0, static_cast<double>(bounds.most_tasks)));
  return std::min(wished, jobs);
}

/// A task begins with the job that crosses its share of the whole.
bool is_at_share(double done_s, double total_s, std::size_t tasks, std::size_t count) {
  const double share_s = total_s * static_cast<double>(tasks) / static_cast<double>(count);
  return done_s >= share_s * (1.0 - 1e-12);
}

}  // namespace

std::vector<TaskPlan> plan_tasks(const std::vector<BatchIndex>& indices, const std::vector<double>& costs_s,
                                 const TaskBounds& bounds) {
  const double total_s = std::accumulate(costs_s.begin(), costs_s.end(), 0.0) / bounds.threads;
  const std::size_t count = count_tasks(total_s, indices.size(), bounds);
  std::vector<TaskPlan> tasks;
  double done_s = 0.0;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    // At the end there is a job left for each task.
    const bool due = is_at_share(done_s / bounds.threads, total_s, tasks.size(), count) ||
                     indices.size() - i <= count - tasks.size();
    if (tasks.empty() || (due && tasks.size() < count)) tasks.emplace_back();
    tasks.back().indices.push_back(indices[i]);
    done_s += costs_s[i];
  }
  return tasks;
}

}  // namespace jobs::cluster
