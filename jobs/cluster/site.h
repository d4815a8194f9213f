// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace jobs::cluster {

/// Settings of the cluster, chosen by whoever runs the service.
struct Site {
  /// Folder that the service and all nodes see under this name; empty: there is no cluster
  std::filesystem::path folder;
  std::filesystem::path program;     ///< that nodes run, copied into the folder; empty: this one
  std::vector<std::string> prefix;   ///< words before each of Slurm's commands: {"ssh", "login", "--"}
  std::string partition, account, qos, constraint;  ///< as sbatch takes them; empty: the site's default
  std::vector<std::string> options;  ///< more of sbatch's options, as it takes them
  std::string prologue;              ///< a line of shell before the program: "module load gcc"
  int threads = 1;                   ///< processors of a task, and jobs that it computes at a time
  int slots = 64;                    ///< tasks that may run at a time
  int tasks = 0;                     ///< tasks that may wait or run at a time; 0: twice the slots
  long memory_mb = 0;                ///< for each processor; 0: the site's default
  double task_s = 600.0;             ///< that a task is to take
  /// Time that a task is to take at least, since Slurm takes a second or so to start it
  double least_task_s = 60.0;
  std::chrono::milliseconds queue_poll{15'000};   ///< between two looks into Slurm's queue
  std::chrono::milliseconds folder_poll{2'000};   ///< between two looks into the folder
  /// For files of a task that has ended, which a network may show late
  std::chrono::milliseconds grace{60'000};
  std::chrono::milliseconds submit_deadline{60'000};
  std::chrono::milliseconds query_deadline{30'000};

  [[nodiscard]] int most_tasks() const { return tasks > 0 ? tasks : 2 * slots; }
};

}  // namespace jobs::cluster
