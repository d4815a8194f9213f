// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/task_list.h"

#include <charconv>
#include <sstream>

#include "jobs/cluster/durable_file.h"

namespace jobs::cluster {
namespace {

std::string ranges_text(const std::vector<Place>& places) {
  std::string text;
  for (std::size_t first = 0; first < places.size();) {
    std::size_t last = first;
    while (last + 1 < places.size() && places[last + 1] == places[last] + 1) ++last;
    text += (text.empty() ? "" : ",") + std::to_string(places[first]);
    if (last > first) text += "-" + std::to_string(places[last]);
    first = last + 1;
  }
  return text;
}

Place read_place(std::string_view text) {
  Place place = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), place);
  if (error != std::errc() || end != text.data() + text.size()) throw FileError("a list of tasks has no number where one should be");
  return place;
}

std::vector<Place> read_ranges(std::string_view text) {
  std::vector<Place> places;
  while (!text.empty()) {
    const std::string_view range = text.substr(0, text.find(','));
    text.remove_prefix(std::min(range.size() + 1, text.size()));
    const auto dash = range.find('-');
    const Place first = read_place(range.substr(0, dash));
    const Place last = dash == std::string_view::npos ? first : read_place(range.substr(dash + 1));
    for (Place place = first; place <= last; ++place) places.push_back(place);
  }
  return places;
}

}  // namespace

std::string write_task_list(const std::vector<TaskPlan>& tasks) {
  std::ostringstream text;
  for (const TaskPlan& task : tasks) {
    text << ranges_text(task.places) << " tries " << task.tries << " strikes " << task.strikes << " memory " << task.memory_factor << " time "
         << task.time_factor << '\n';
  }
  return text.str();
}

std::vector<TaskPlan> read_task_list(std::string_view text) {
  std::istringstream lines{std::string(text)};
  std::vector<TaskPlan> tasks;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string places, tries, strikes, memory, time;
    TaskPlan task;
    words >> places >> tries >> task.tries >> strikes >> task.strikes >> memory >> task.memory_factor >> time >> task.time_factor;
    const bool named = tries == "tries" && strikes == "strikes" && memory == "memory" && time == "time";
    if (!words || !named) throw FileError("a line is no task: " + line.substr(0, 80));
    task.places = read_ranges(places);
    tasks.push_back(std::move(task));
  }
  return tasks;
}

}  // namespace jobs::cluster
