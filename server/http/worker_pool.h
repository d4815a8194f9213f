// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <vector>

#include "server/http/fair_queue.h"

namespace server {

/// Threads that serve connections, in the order of a FairQueue.
class WorkerPool {
 public:
  using Serve = std::function<void(PendingConnection)>;

  /// @param most_queued  connections that may wait for a thread
  /// @param serve        must not throw
  /// @throws std::runtime_error if the system does not allow so many threads
  WorkerPool(std::size_t threads, std::size_t most_queued, Serve serve);
  ~WorkerPool();  ///< finish()
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Queues a connection. @returns see FairQueue::add()
  [[nodiscard]] std::optional<PendingConnection> add(PendingConnection& connection);

  /// Serves the queued connections and ends the threads.
  void finish();

 private:
  void work(const std::stop_token& stop);

  const Serve serve_;
  std::mutex mutex_;  // guards queue_
  std::condition_variable_any changed_;
  FairQueue queue_;
  std::vector<std::jthread> threads_;  // last: they use the rest
};

}  // namespace server
