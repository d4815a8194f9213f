// SPDX-License-Identifier: Apache-2.0
#include "validation/studies/compute.h"

#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>

namespace validation::studies {

namespace {

struct Task {
  const Part* part;
  Findings* result;
};

/// Hands out tasks, heavy ones first: a long one that comes last keeps the other threads waiting.
class TaskQueue {
 public:
  explicit TaskQueue(const std::vector<Task>& tasks) {
    for (const Cost cost : {Cost::kLight, Cost::kHeavy})
      for (const Task& task : tasks)
        if (task.part->cost == cost) waiting_.push_back(task);
  }

  void work(const PartDone& done) {
    while (true) {
      Task task{};
      {
        const std::lock_guard lock(mutex_);
        if (waiting_.empty()) return;
        task = waiting_.back();
        waiting_.pop_back();
      }
      compute(task, done);
    }
  }

  void throw_what_failed() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void compute(const Task& task, const PartDone& done) {
    try {
      *task.result = task.part->compute();
      const std::lock_guard lock(mutex_);
      if (!failure_) done(*task.part, *task.result);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
      waiting_.clear();
    }
  }

  std::mutex mutex_;  // guards all that follows, and serialises done()
  std::vector<Task> waiting_;
  std::exception_ptr failure_;
};

}  // namespace

std::size_t count_parts(const std::vector<Chapter>& chapters, Cost most_costly) {
  std::size_t count = 0;
  for (const Chapter& chapter : chapters)
    for (const Part& part : chapter.parts) count += part.cost <= most_costly ? 1 : 0;
  return count;
}

std::vector<ComputedChapter> compute_chapters(const std::vector<Chapter>& chapters, Cost most_costly,
                                              int threads, const PartDone& done) {
  std::vector<ComputedChapter> computed;
  for (const Chapter& chapter : chapters)
    computed.push_back({chapter, std::vector<Findings>(chapter.parts.size())});
  std::vector<Task> tasks;
  for (ComputedChapter& chapter : computed)
    for (std::size_t k = 0; k < chapter.chapter.parts.size(); ++k)
      if (chapter.chapter.parts[k].cost <= most_costly)
        tasks.push_back({&chapter.chapter.parts[k], &chapter.findings[k]});
  TaskQueue queue(tasks);
  {
    std::vector<std::jthread> pool;
    for (int k = 0; k < threads; ++k) pool.emplace_back([&] { queue.work(done); });
  }
  queue.throw_what_failed();
  return computed;
}

}  // namespace validation::studies
