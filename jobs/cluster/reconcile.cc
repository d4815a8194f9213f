// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/reconcile.h"

#include <algorithm>

namespace jobs::cluster {
namespace {

/// Cause of the loss of a task's jobs.
enum class Loss { kRefused, kInterrupted, kOwnFault, kTooSlow, kTooLarge };

Loss loss_of(const TaskState& task, const TaskReport* report) {
  if (report == nullptr) return task.refused ? Loss::kRefused : Loss::kInterrupted;
  switch (report->phase) {
    case Phase::kCompleted:
      return Loss::kOwnFault;
    // A node that cannot write into the folder fails any task.
    case Phase::kFailed:
      return report->has_log ? Loss::kOwnFault : Loss::kInterrupted;
    case Phase::kTimeout: return Loss::kTooSlow;
    case Phase::kOutOfMemory: return Loss::kTooLarge;
    default: return Loss::kInterrupted;
  }
}

std::string how_it_ended(const TaskReport* report) {
  if (report == nullptr) return "Slurm does not know its last task any more";
  const std::string reason =
      report->reason.empty() || report->reason == "None" ? "" : " (" + report->reason + ")";
  return "its last task ended as " + report->word + reason +
         (report->node.empty() ? "" : " on " + report->node);
}

void fail_all(const TaskPlan& plan, const TaskName& name, const char* reason, const std::string& detail,
              Decision& decision) {
  for (const BatchIndex batch_index : plan.indices)
    decision.fail.push_back({.batch_index = batch_index, .reason = reason, .detail = detail, .task = name});
}

/// The jobs of a task in so many parts of nearly equal size, each as a task of its own.
void submit_in_parts(const TaskPlan& plan, std::size_t parts, Decision& decision) {
  const std::size_t n = plan.indices.size();
  for (std::size_t k = 0; k < parts; ++k) {
    TaskPlan part = plan;
    const auto at = [&](std::size_t part_index) {
      return plan.indices.begin() + static_cast<std::ptrdiff_t>(n * part_index / parts);
    };
    part.indices.assign(at(k), at(k + 1));
    decision.submit.push_back(std::move(part));
  }
}

void replace_failed(TaskPlan plan, const TaskName& name, const TaskReport* report, Decision& decision) {
  ++plan.strikes;
  if (plan.strikes < 2) return decision.submit.push_back(std::move(plan));
  if (plan.indices.size() > 1)
    return submit_in_parts(plan, std::min(plan.indices.size(), kMostParts), decision);
  fail_all(plan, name, "task_failed", "no task could compute this job: " + how_it_ended(report), decision);
}

void replace_slow(TaskPlan plan, Decision& decision) {
  if (plan.indices.size() > 1) return submit_in_parts(plan, 2, decision);
  plan.time_factor *= 2;
  decision.submit.push_back(std::move(plan));
}

void replace_large(TaskPlan plan, const TaskName& name, const TaskReport* report, Decision& decision) {
  if (plan.memory_factor > 1) return replace_failed(std::move(plan), name, report, decision);
  plan.memory_factor = 2;
  decision.submit.push_back(std::move(plan));
}

/// Refusals may pass, as that of too many tasks. One of more memory or time than the site gives does not.
void replace_refused(TaskPlan plan, const TaskName& name, Decision& decision) {
  const bool wants_more = plan.memory_factor > 1 || plan.time_factor > 1;
  if (wants_more && ++plan.tries >= kMostTries) {
    return fail_all(plan, name, "task_failed",
                    "no task could compute this job: sbatch refuses one with " +
                        std::to_string(plan.memory_factor) + " times the memory and " +
                        std::to_string(plan.time_factor) + " times the time",
                    decision);
  }
  decision.refused = true;
  decision.submit.push_back(std::move(plan));
}

/// Gives the jobs of a lost task to new ones.
void replace(const TaskName& name, const TaskState& task, const TaskReport* report, Decision& decision) {
  TaskPlan plan = task.plan;
  plan.indices = task.wanted;
  const Loss loss = loss_of(task, report);
  if (loss == Loss::kRefused) return replace_refused(std::move(plan), name, decision);
  const bool got_on = task.wanted.size() < task.plan.indices.size();
  // The limit of a job ends one that never gets done: time is doubled as often as needed until then.
  plan.tries = got_on || loss == Loss::kTooSlow ? 1 : plan.tries + 1;
  if (plan.tries >= kMostTries && loss != Loss::kOwnFault) {
    return fail_all(plan, name, "task_lost",
                    "its tasks were lost " + std::to_string(plan.tries) + " times; " + how_it_ended(report),
                    decision);
  }
  switch (loss) {
    case Loss::kOwnFault: return replace_failed(std::move(plan), name, report, decision);
    case Loss::kTooSlow: return replace_slow(std::move(plan), decision);
    case Loss::kTooLarge: return replace_large(std::move(plan), name, report, decision);
    default: return decision.submit.push_back(std::move(plan));
  }
}

}  // namespace

bool Reconciler::has_lasted(const TaskName& name, Clock::time_point now) {
  return now - since_.try_emplace(name, now).first->second >= grace_;
}

bool Reconciler::is_given_up(const TaskName& name, const TaskReport* report, Clock::time_point now) {
  if (report != nullptr && report->is_held_by_failure()) return true;
  if (report != nullptr && is_alive(report->phase)) {
    since_.erase(name);
    return false;
  }
  return has_lasted(name, now);
}

bool Reconciler::is_to_be_cancelled(const TaskName& name, const TaskReport* report, Clock::time_point now) {
  if (report == nullptr || !is_alive(report->phase)) {
    since_.erase(name);
    return false;
  }
  // One that runs may be about to end by itself: it has just left its last result, or sees that the batch is
  // cancelled.
  return report->phase == Phase::kPending || has_lasted(name, now);
}

Decision Reconciler::decide(const TaskStates& tasks, const std::map<TaskName, TaskReport>& reports,
                            Clock::time_point now) {
  Decision decision;
  for (const auto& [name, task] : tasks) {
    const auto found = reports.find(name);
    const TaskReport* const report = found == reports.end() ? nullptr : &found->second;
    if (task.wanted.empty()) {
      if (is_to_be_cancelled(name, report, now)) decision.cancel.push_back(name);
      continue;
    }
    const bool alive = report != nullptr && is_alive(report->phase);
    if (alive && report->phase == Phase::kRunning)
      decision.running.insert(task.wanted.begin(), task.wanted.end());
    if (!is_given_up(name, report, now)) continue;
    if (alive) decision.cancel.push_back(name);
    replace(name, task, report, decision);
    since_.erase(name);
  }
  return decision;
}

}  // namespace jobs::cluster
