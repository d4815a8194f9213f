// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "jobs/runs/run_record.h"

namespace jobs::cluster {

/// A task of a batch, as a node is told it.
struct TaskOrder {
  std::filesystem::path folder;  ///< of the batch
  int generation = 0;
  int index = 0;
  int threads = 1;               ///< jobs computed at a time
  Runner runner;
};

/// Computes the jobs of a task that have no result from it yet, and leaves their results in the folder: now
/// and then those that are ready, all at the end. Ends early, with what is ready, once it is told to or the
/// batch is cancelled.
/// @param stop_requested  asked ten times a second
/// @param log  told what a human may want to read in the task's log
/// @returns whether every job has a result
/// @throws FileError if the task cannot be read
bool run_task(const TaskOrder& order, const std::function<bool()>& stop_requested,
              const std::function<void(const std::string&)>& log);

}  // namespace jobs::cluster
