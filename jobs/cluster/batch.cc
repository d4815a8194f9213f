// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/batch.h"

#include <algorithm>
#include <iterator>

namespace jobs::cluster {

std::vector<std::string> Batch::array_names() const {
  std::vector<std::string> names;
  for (int generation = 0; generation < generations_; ++generation) names.push_back(array_name(generation));
  return names;
}

void Batch::prepare(const BatchHeader& header, const std::vector<BatchJob>& jobs) const {
  std::filesystem::create_directories(folder_.out());
  std::filesystem::create_directories(folder_.path / "log");
  BatchJobs texts;
  for (const BatchJob& job : jobs) texts.emplace(job.batch_index, job.parameters);
  write_durably(folder_.jobs(), encode_jobs(header, texts));
}

void Batch::read_lists() {
  while (std::filesystem::exists(folder_.list(generations_))) {
    const auto tasks = read_task_list(read_whole(folder_.list(generations_)));
    put(generations_++, tasks);
  }
  share_out();
}

int Batch::add_generation(const std::vector<TaskPlan>& tasks, const std::string& script) {
  const int generation = generations_;
  write_durably(folder_.script(generation), script);
  write_durably(folder_.list(generation), write_task_list(tasks));
  ++generations_;
  put(generation, tasks);
  share_out();
  return generation;
}

void Batch::put(int generation, const std::vector<TaskPlan>& tasks) {
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const TaskName name{.generation = generation, .index = static_cast<int>(i)};
    tasks_[name] = {.plan = tasks[i], .wanted = {}, .refused = false};
    for (const BatchIndex batch_index : tasks[i].indices) owner_[batch_index] = name;
  }
}

void Batch::set_refused(int generation) {
  for (auto& [name, task] : tasks_) {
    if (name.generation == generation) task.refused = true;
  }
}

bool Batch::has_refused() const {
  return std::ranges::any_of(
      tasks_, [](const auto& task) { return task.second.refused && !task.second.wanted.empty(); });
}

void Batch::clear_refused(const std::map<TaskName, TaskReport>& reports) {
  std::set<int> known;
  for (const auto& [name, report] : reports) known.insert(name.generation);
  for (auto& [name, task] : tasks_) {
    if (known.contains(name.generation)) task.refused = false;
  }
  if (known.contains(generations_ - 1)) refusals = 0;
}

void Batch::set_wanted(const std::vector<BatchIndex>& wanted) {
  wanted_ = {wanted.begin(), wanted.end()};
  share_out();
}

void Batch::share_out() {
  for (auto& [name, task] : tasks_) task.wanted.clear();
  for (const BatchIndex batch_index : wanted_) {
    if (const auto owner = owner_.find(batch_index); owner != owner_.end())
      tasks_.at(owner->second).wanted.push_back(batch_index);
  }
}

std::vector<BatchIndex> Batch::unassigned() const {
  std::vector<BatchIndex> indices;
  std::ranges::copy_if(wanted_, std::back_inserter(indices),
                       [&](BatchIndex batch_index) { return !owner_.contains(batch_index); });
  return indices;
}

std::vector<std::filesystem::path> Batch::find_new_results() const {
  std::vector<std::filesystem::path> files;
  if (!std::filesystem::exists(folder_.out())) return files;
  // Reading the folder, rather than asking for names, makes a network's file system look again.
  for (const auto& entry : std::filesystem::directory_iterator(folder_.out())) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(".results") && !name.starts_with('.') && !seen_.contains(name))
      files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

std::map<TaskName, TaskReport> Batch::reports_of(const Reports& all) const {
  std::map<TaskName, TaskReport> reports;
  for (int generation = 0; generation < generations_; ++generation) {
    const auto found = all.find(array_name(generation));
    if (found == all.end()) continue;
    for (const auto& [index, report] : found->second) {
      TaskReport& own = reports[{.generation = generation, .index = index}] = report;
      own.has_log = report.phase != Phase::kFailed || std::filesystem::exists(folder_.log(generation, index));
    }
  }
  return reports;
}

void Batch::take_running(const std::set<BatchIndex>& running, std::vector<BatchIndex>& begun,
                         std::vector<BatchIndex>& waiting) {
  std::ranges::set_difference(running, running_, std::back_inserter(begun));
  std::ranges::set_difference(running_, running, std::back_inserter(waiting));
  running_ = running;
}

int Batch::open_tasks() const {
  return static_cast<int>(
      std::ranges::count_if(tasks_, [](const auto& task) { return !task.second.wanted.empty(); }));
}

}  // namespace jobs::cluster
