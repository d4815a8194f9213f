// SPDX-License-Identifier: Apache-2.0
#include "server/http/worker_pool.h"

#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

namespace server {

WorkerPool::WorkerPool(std::size_t threads, std::size_t most_queued, Serve serve)
    : serve_(std::move(serve)), queue_(most_queued) {
  try {
    for (std::size_t i = 0; i < threads; ++i)
      threads_.emplace_back([this](const std::stop_token& stop) { work(stop); });
  } catch (const std::system_error&) {
    throw std::runtime_error(
        "the system allows no more than " + std::to_string(threads_.size()) + " of the " +
        std::to_string(threads) +
        " threads that serve clients: raise its limit on memory (ulimit -v) or on processes (ulimit -u)");
  }
}

WorkerPool::~WorkerPool() { finish(); }

std::optional<PendingConnection> WorkerPool::add(PendingConnection& connection) {
  std::optional<PendingConnection> displaced;
  {
    const std::lock_guard lock(mutex_);
    displaced = queue_.add(connection);
  }
  changed_.notify_one();
  return displaced;
}

void WorkerPool::finish() {
  for (std::jthread& thread : threads_) thread.request_stop();
  threads_.clear();
}

void WorkerPool::work(const std::stop_token& stop) {
  for (;;) {
    std::optional<PendingConnection> next;
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [this] { return queue_.size() > 0; })) return;
      next = queue_.take();
    }
    serve_(std::move(*next));
  }
}

}  // namespace server
