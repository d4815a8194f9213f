// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "jobs/cluster/process.h"
#include "jobs/cluster/site.h"
#include "jobs/cluster/task_report.h"

namespace jobs::cluster {

/// An array that Slurm is to run.
struct ArrayOrder {
  std::string name;              ///< ours; what the array is known by from now on
  int tasks = 1;
  double time_s = 0.0;           ///< most that a task may take
  int memory_factor = 1;         ///< of what the site gives a task
  std::filesystem::path folder;  ///< in which it runs
  std::filesystem::path script;
  std::string log;               ///< file for what task %a prints
};

/// Answer of sbatch. If it named no number, the array may exist all the same ("socket timed out"): only
/// squeue can tell.
struct Submission {
  std::optional<std::string> array_job;
  std::string problem;  ///< empty if there is a number
};

/// Slurm's limits, as far as they concern us.
struct SlurmLimits {
  std::string version;    ///< "22.05.8"
  int max_array_size = 0; ///< indices are smaller
};

/// Slurm by its commands sbatch, squeue, scancel and scontrol, whose text has been the same for ten years.
class Slurm {
 public:
  /// @param stop  ends what is being asked; what became of it is then not known
  explicit Slurm(const Site& site, std::stop_token stop = {}) : site_(site), stop_(std::move(stop)) {}

  [[nodiscard]] Submission submit(const ArrayOrder& order) const;
  /// The arguments of sbatch.
  [[nodiscard]] std::vector<std::string> submit_arguments(const ArrayOrder& order) const;

  /// @param names  of arrays
  /// @param problem  set if nothing is returned
  /// @returns empty if Slurm could not be asked: then nothing is known of any task
  [[nodiscard]] std::optional<Reports> observe(const std::vector<std::string>& names,
                                               std::string& problem) const;

  /// Cancels an array. Slurm does not say whether there was anything to cancel.
  void cancel_array(const std::string& name) const;
  /// @param array_job  Slurm's own number of the array
  void cancel_tasks(const std::string& array_job, const std::vector<int>& indices) const;

  /// @param problem  set if nothing is returned
  [[nodiscard]] std::optional<SlurmLimits> find_limits(std::string& problem) const;

  /// Runs one of Slurm's commands as this site wants it.
  [[nodiscard]] ProcessOutcome run(std::vector<std::string> command,
                                   std::chrono::milliseconds deadline) const;

 private:
  const Site site_;
  const std::stop_token stop_;
};

}  // namespace jobs::cluster
