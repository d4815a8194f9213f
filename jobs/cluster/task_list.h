// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace jobs::cluster {

/// Index of a job in its batch, from 0.
using BatchIndex = std::uint32_t;

/// Jobs of one task, and the failures of earlier tasks with them.
struct TaskPlan {
  std::vector<BatchIndex> indices;  ///< ascending
  int tries = 0;                    ///< losses of these jobs so far
  int strikes = 0;                  ///< losses by a failure of the task itself
  int memory_factor = 1;            ///< of what the site gives a task
  int time_factor = 1;              ///< of the time that it is expected to take
  bool operator==(const TaskPlan&) const = default;
};

/// The list of a generation as a text, a task a line: "0-4,7 tries 1 strikes 0 memory 1 time 1".
[[nodiscard]] std::string write_task_list(const std::vector<TaskPlan>& tasks);

/// @throws FileError if it is no such list
[[nodiscard]] std::vector<TaskPlan> read_task_list(std::string_view text);

}  // namespace jobs::cluster
