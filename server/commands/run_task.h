// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace server::commands {

struct RunTaskOptions {
  std::string folder;   ///< of the batch
  int generation = 0;
  int index = -1;       ///< of the task in its array; below 0: what Slurm says in SLURM_ARRAY_TASK_ID
  int threads = 0;      ///< 0: what Slurm says in SLURM_CPUS_PER_TASK, or one
};

/// Computes the jobs of one task, on a node of a cluster, and leaves their results in the shared folder.
/// @returns an exit code; kDone only if every job has a result
int run_task(const RunTaskOptions& options);

}  // namespace server::commands
