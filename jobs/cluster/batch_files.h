// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "jobs/base/provenance.h"
#include "jobs/cluster/durable_file.h"
#include "jobs/cluster/task_list.h"
#include "jobs/runs/job_limits.h"
#include "jobs/runs/run_record.h"

namespace jobs::cluster {

/// Files of a batch:
///
///     jobs         the parameters of all jobs, which never changes
///     g<k>.list    generation k: line i is the task with array index i
///     g<k>.sh      what Slurm runs
///     out/         results, each file under a name of its own
///     log/         what tasks print
///     CANCEL       once the batch is not wanted any more
struct BatchFolder {
  std::filesystem::path path;

  [[nodiscard]] std::filesystem::path jobs() const { return path / "jobs"; }
  [[nodiscard]] std::filesystem::path list(int generation) const {
    return path / ("g" + std::to_string(generation) + ".list");
  }
  [[nodiscard]] std::filesystem::path script(int generation) const {
    return path / ("g" + std::to_string(generation) + ".sh");
  }
  [[nodiscard]] std::filesystem::path out() const { return path / "out"; }
  [[nodiscard]] std::filesystem::path log(int generation, int index) const {
    return path / "log" / ("g" + std::to_string(generation) + "-" + std::to_string(index) + ".log");
  }
  [[nodiscard]] std::filesystem::path cancel() const { return path / "CANCEL"; }
};

/// Data that all tasks of a batch need.
struct BatchHeader {
  std::string batch;   ///< id
  std::string engine;  ///< that must compute it
  JobLimits limits;    ///< of each job
  double deliver_every_s = 60.0;  ///< interval at which a task leaves its results so far
};

/// The parameters of jobs, by index.
using BatchJobs = std::map<BatchIndex, std::string>;

[[nodiscard]] std::string encode_jobs(const BatchHeader& header, const BatchJobs& jobs);
/// Reads the header and those jobs that are wanted, not the others.
/// @throws FileError if a wanted one is not there or damaged
[[nodiscard]] BatchJobs read_jobs(const std::filesystem::path& file, const std::vector<BatchIndex>& wanted,
                                  BatchHeader& header);

/// A job's result as a task leaves it.
struct BatchResult {
  BatchIndex batch_index = 0;
  RunRecord record;              ///< without its trajectory
  std::string packed_trajectory; ///< by encode_trajectory; empty: none
};

struct ResultFile {
  std::string batch;
  Provenance provenance;
  std::vector<BatchResult> results;
};

[[nodiscard]] std::string encode_results(const ResultFile& file);
/// @throws FileError if it is damaged
[[nodiscard]] ResultFile decode_results(std::string_view bytes);

}  // namespace jobs::cluster
