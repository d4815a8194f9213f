// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/task_list.h"

#include <charconv>
#include <sstream>

#include "jobs/cluster/durable_file.h"

namespace jobs::cluster {
namespace {

std::string ranges_text(const std::vector<BatchIndex>& indices) {
  std::string text;
  for (std::size_t first = 0; first < indices.size();) {
    std::size_t last = first;
    while (last + 1 < indices.size() && indices[last + 1] == indices[last] + 1) ++last;
    text += (text.empty() ? "" : ",") + std::to_string(indices[first]);
    if (last > first) text += "-" + std::to_string(indices[last]);
    first = last + 1;
  }
  return text;
}

BatchIndex read_index(std::string_view text) {
  BatchIndex batch_index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), batch_index);
  if (error != std::errc() || end != text.data() + text.size())
    throw FileError("a list of tasks has no number where one should be");
  return batch_index;
}

std::vector<BatchIndex> read_ranges(std::string_view text) {
  std::vector<BatchIndex> indices;
  while (!text.empty()) {
    const std::string_view range = text.substr(0, text.find(','));
    text.remove_prefix(std::min(range.size() + 1, text.size()));
    const auto dash = range.find('-');
    const BatchIndex first = read_index(range.substr(0, dash));
    const BatchIndex last = dash == std::string_view::npos ? first : read_index(range.substr(dash + 1));
    for (BatchIndex batch_index = first; batch_index <= last; ++batch_index) indices.push_back(batch_index);
  }
  return indices;
}

}  // namespace

std::string write_task_list(const std::vector<TaskPlan>& tasks) {
  std::ostringstream text;
  for (const TaskPlan& task : tasks) {
    text << ranges_text(task.indices) << " tries " << task.tries << " strikes " << task.strikes << " memory "
         << task.memory_factor << " time " << task.time_factor << '\n';
  }
  return text.str();
}

std::vector<TaskPlan> read_task_list(std::string_view text) {
  std::istringstream lines{std::string(text)};
  std::vector<TaskPlan> tasks;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string indices, tries, strikes, memory, time;
    TaskPlan task;
    words >> indices >> tries >> task.tries >> strikes >> task.strikes >> memory >> task.memory_factor >>
        time >> task.time_factor;
    const bool named = tries == "tries" && strikes == "strikes" && memory == "memory" && time == "time";
    if (!words || !named) throw FileError("a line is no task: " + line.substr(0, 80));
    task.indices = read_ranges(indices);
    tasks.push_back(std::move(task));
  }
  return tasks;
}

}  // namespace jobs::cluster
