// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/cluster/task_report.h"

namespace jobs::cluster {

/// Status of our tasks in Slurm at the last query, for humans. May be used from any thread.
class ClusterStatus {
 public:
  /// Takes over what squeue said.
  void set_reports(const Reports& reports);
  /// @param topic  "sbatch", "squeue", ...: one problem each
  /// @param text   empty: it is over
  /// @returns whether this is news
  bool set_problem(const std::string& topic, const std::string& text);

  /// {"tasks": {"pending", "running"}, "nodes": [...], "waiting": [{"reason", "tasks"}], "problems": [...]}
  [[nodiscard]] nlohmann::json json() const;

 private:
  /// mutex_ is held.
  void count(const TaskReport& report);

  mutable std::mutex mutex_;  // guards the rest
  int pending_ = 0, running_ = 0;
  std::set<std::string> nodes_;
  std::map<std::string, int> waiting_;      ///< tasks by Slurm's reason
  std::map<std::string, int> need_human_;   ///< the same of those that wait for a human
  std::map<std::string, std::string> problems_;
};

}  // namespace jobs::cluster
