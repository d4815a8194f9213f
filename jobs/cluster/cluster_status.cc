// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/cluster_status.h"

namespace jobs::cluster {

void ClusterStatus::set_reports(const Reports& reports) {
  const std::lock_guard lock(mutex_);
  pending_ = running_ = 0;
  nodes_.clear();
  waiting_.clear();
  need_human_.clear();
  for (const auto& [name, tasks] : reports)
    for (const auto& [index, report] : tasks)
      if (is_alive(report.phase)) count(report);
}

void ClusterStatus::count(const TaskReport& report) {
  if (report.needs_human()) ++need_human_[report.word + ", " + report.reason];
  if (report.phase == Phase::kRunning) {
    ++running_;
    nodes_.insert(report.node);
  } else {
    ++pending_;
    ++waiting_[report.reason];
  }
}

bool ClusterStatus::set_problem(const std::string& topic, const std::string& text) {
  const std::lock_guard lock(mutex_);
  if (text.empty()) return problems_.erase(topic) > 0;
  std::string& known = problems_[topic];
  if (known == text) return false;
  known = text;
  return true;
}

nlohmann::json ClusterStatus::json() const {
  const std::lock_guard lock(mutex_);
  nlohmann::json waiting = nlohmann::json::array();
  for (const auto& [reason, tasks] : waiting_) waiting.push_back({{"reason", reason}, {"tasks", tasks}});
  nlohmann::json problems = nlohmann::json::array();
  for (const auto& [topic, text] : problems_) problems.push_back(text);
  for (const auto& [reason, tasks] : need_human_) {
    problems.push_back(std::to_string(tasks) + (tasks == 1 ? " task waits" : " tasks wait") +
                       " for somebody to act: Slurm says " + reason);
  }
  return {{"tasks", {{"pending", pending_}, {"running", running_}}}, {"nodes", nodes_},
          {"waiting", std::move(waiting)},
          {"problems", std::move(problems)}};
}

}  // namespace jobs::cluster
