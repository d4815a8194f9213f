// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

namespace server {

/// Bounds how much work of a kind goes on at a time, since each takes much memory, and how many wait for it,
/// since each holds a thread.
class WorkLimit {
 public:
  /// @param at_a_time    permits
  /// @param most_waiting  callers that may wait for one
  /// @param on_idle      called when the last permit is given back; must not throw
  /// @param places       has a permit for each that waits, here or at other limits; null: needs none
  WorkLimit(std::size_t at_a_time, std::size_t most_waiting, std::function<void()> on_idle = {},
            WorkLimit* places = nullptr)
      : free_(at_a_time),
        at_a_time_(at_a_time),
        most_waiting_(most_waiting),
        on_idle_(std::move(on_idle)),
        places_(places) {}

  /// Waits for a permit. Not to outlive this.
  /// @returns a permit, which is given back by its destruction; null if too many wait, or one waits for too
  ///     long
  [[nodiscard]] std::shared_ptr<const void> acquire();

 private:
  void give_back() {
    bool idle = false;
    {
      const std::lock_guard lock(mutex_);
      idle = ++free_ == at_a_time_;
    }
    given_back_.notify_one();
    if (idle && on_idle_) on_idle_();
  }

  std::mutex mutex_;  // guards free_ and waiting_
  std::condition_variable given_back_;
  std::size_t free_;
  std::size_t waiting_ = 0;
  const std::size_t at_a_time_;
  const std::size_t most_waiting_;
  const std::function<void()> on_idle_;
  WorkLimit* const places_;
};

/// Permit of one request, which it gives back while it waits for something else.
class WorkPermit {
 public:
  static constexpr const char* kRefusal = "as many large requests wait as may; try again";

  /// @param limit  null: the request needs no permit
  explicit WorkPermit(WorkLimit* limit) : limit_(limit) {}

  /// Waits for the permit, unless it is there. False as WorkLimit::acquire() is null.
  [[nodiscard]] bool acquire() {
    if (limit_ != nullptr && !permit_) permit_ = limit_->acquire();
    return limit_ == nullptr || permit_ != nullptr;
  }
  void give_back() { permit_.reset(); }

 private:
  WorkLimit* limit_;
  std::shared_ptr<const void> permit_;
};

inline std::shared_ptr<const void> WorkLimit::acquire() {
  constexpr std::chrono::seconds kPatience{20};
  std::unique_lock lock(mutex_);
  if (free_ == 0) {
    WorkPermit place(places_);
    if (waiting_ >= most_waiting_ || !place.acquire()) return nullptr;
    ++waiting_;
    const bool is_free = given_back_.wait_for(lock, kPatience, [this] { return free_ > 0; });
    --waiting_;
    if (!is_free) return nullptr;
  }
  --free_;
  lock.unlock();
  return {this, [this](const WorkLimit*) { give_back(); }};
}

}  // namespace server
