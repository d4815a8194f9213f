// SPDX-License-Identifier: Apache-2.0
#include "server/http/worker_pool.h"

#include <chrono>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

namespace server {

WorkerPool::WorkerPool(std::size_t threads) {
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

void WorkerPool::add(Task task) {
  for (;;) {
    try {
      const std::lock_guard lock(mutex_);
      tasks_.push_back(std::move(task));  // left as it is if there is no memory
      break;
    } catch (const std::bad_alloc&) {  // what is being answered gives some back
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  changed_.notify_one();
}

void WorkerPool::finish() {
  for (std::jthread& thread : threads_) thread.request_stop();
  threads_.clear();
}

void WorkerPool::work(const std::stop_token& stop) {
  for (;;) {
    Task task;
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [this] { return !tasks_.empty(); })) return;
      task = std::move(tasks_.front());
      tasks_.pop_front();
    }
    task();
  }
}

}  // namespace server
