// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "jobs/cluster/batch_files.h"
#include "jobs/cluster/reconcile.h"
#include "jobs/store/rows.h"

namespace jobs::cluster {

/// A batch that a cluster computes, as its folder and the store tell it. Its state can be made from them at
/// any time.
class Batch {
 public:
  /// @param folder  of all batches of the store
  Batch(BatchRow row, const std::filesystem::path& folder, Clock::duration grace)
      : row_(std::move(row)), folder_{folder / row_.id}, reconciler_(grace) {}

  [[nodiscard]] const BatchRow& row() const { return row_; }
  [[nodiscard]] const BatchFolder& folder() const { return folder_; }
  /// Name of a generation in Slurm.
  [[nodiscard]] std::string array_name(int generation) const {
    return "rpsup-" + row_.id + "-g" + std::to_string(generation);
  }
  [[nodiscard]] std::vector<std::string> array_names() const;
  [[nodiscard]] int generations() const { return generations_; }

  /// @returns whether the folder has what its tasks read
  [[nodiscard]] bool is_prepared() const { return std::filesystem::exists(folder_.jobs()); }
  void prepare(const BatchHeader& header, const std::vector<BatchJob>& jobs) const;
  /// Reads the lists that were written so far.
  void read_lists();
  /// Writes the list of a new generation and its script. Returns its number.
  int add_generation(const std::vector<TaskPlan>& tasks, const std::string& script);
  /// Marks the tasks of a generation as refused by sbatch.
  void set_refused(int generation);
  /// @returns whether jobs wait for tasks that sbatch refused
  [[nodiscard]] bool has_refused() const;
  /// Clears the mark of generations that Slurm knows, whatever sbatch said.
  void clear_refused(const std::map<TaskName, TaskReport>& reports);

  /// Takes over the indices that have no result yet.
  void set_wanted(const std::vector<BatchIndex>& wanted);
  [[nodiscard]] const std::set<BatchIndex>& wanted() const { return wanted_; }
  /// Wanted indices that no list has.
  [[nodiscard]] std::vector<BatchIndex> unassigned() const;

  /// Names of files in out/ that have not been looked at.
  [[nodiscard]] std::vector<std::filesystem::path> find_new_results() const;
  void set_seen(const std::filesystem::path& file) { seen_.insert(file.filename().string()); }

  /// This batch's part of what squeue said.
  [[nodiscard]] std::map<TaskName, TaskReport> reports_of(const Reports& all) const;
  [[nodiscard]] Decision decide(const std::map<TaskName, TaskReport>& reports, Clock::time_point now) {
    return reconciler_.decide(tasks_, reports, now);
  }
  /// Collects the indices that have begun to run since the last call, and those that wait again.
  void take_running(const std::set<BatchIndex>& running, std::vector<BatchIndex>& begun,
                    std::vector<BatchIndex>& waiting);

  /// Tasks that have indices left.
  [[nodiscard]] int open_tasks() const;

  Clock::time_point not_before{};  ///< earliest time to submit refused tasks again
  int refusals = 0;                ///< in a row

 private:
  void put(int generation, const std::vector<TaskPlan>& tasks);
  void share_out();

  const BatchRow row_;
  const BatchFolder folder_;
  Reconciler reconciler_;
  TaskStates tasks_;
  int generations_ = 0;
  std::set<BatchIndex> wanted_;
  std::map<BatchIndex, TaskName> owner_;  ///< the last task that has the job
  std::set<BatchIndex> running_;
  std::set<std::string> seen_;
};

}  // namespace jobs::cluster
