// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace server {

/// Threads that run tasks in the order of add(). Without memory for a task, add() waits; the process does not
/// end.
class WorkerPool {
 public:
  using Task = std::function<void()>;

  /// @throws std::runtime_error if the system does not allow so many threads
  explicit WorkerPool(std::size_t threads);
  ~WorkerPool();  ///< finish()
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Returns when the task is queued: at once, unless there is no memory for it.
  /// @param task  must not throw
  void add(Task task);

  /// Runs the queued tasks and ends the threads.
  void finish();

 private:
  void work(const std::stop_token& stop);

  std::mutex mutex_;  // guards tasks_
  std::condition_variable_any changed_;
  std::deque<Task> tasks_;
  std::vector<std::jthread> threads_;  // last: they use the rest
};

}  // namespace server
