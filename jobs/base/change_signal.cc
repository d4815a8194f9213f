// SPDX-License-Identifier: Apache-2.0
#include "jobs/base/change_signal.h"

#include <algorithm>
#include <thread>

namespace jobs {

std::uint64_t ChangeSignal::count() const {
  const std::lock_guard lock(mutex_);
  return count_;
}

void ChangeSignal::add_change() {
  {
    const std::lock_guard lock(mutex_);
    ++count_;
  }
  changed_.notify_all();
}

void ChangeSignal::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

bool ChangeSignal::is_closed() const {
  const std::lock_guard lock(mutex_);
  return closed_;
}

void ChangeSignal::wait(std::uint64_t seen) const {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return closed_ || count_ != seen; });
}

void ChangeSignal::wait_until_closed(std::chrono::seconds at_most) const {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, at_most, [&] { return closed_; });
}

bool ChangeSignal::wait_for_change(std::uint64_t seen,
                                   std::chrono::steady_clock::time_point deadline) const {
  std::unique_lock lock(mutex_);
  const bool changed = changed_.wait_until(lock, deadline, [&] { return closed_ || count_ != seen; });
  return changed && !closed_;
}

bool ChangeSignal::wait_for(std::chrono::milliseconds at_most,
                            const std::function<std::optional<bool>()>& has_ended) const {
  constexpr std::chrono::milliseconds kBetweenQuestions{5};  // thousands of jobs may end in a second
  // The largest waits would overflow the clock.
  const auto now = std::chrono::steady_clock::now();
  const auto deadline = now + std::min<std::chrono::milliseconds>(at_most, std::chrono::years(10));
  for (;;) {
    const std::uint64_t seen = count();
    const auto asked = std::chrono::steady_clock::now();
    const std::optional<bool> ended = has_ended();
    if (!ended || *ended) return ended.value_or(false);
    if (!wait_for_change(seen, deadline)) return false;
    std::this_thread::sleep_until(asked + kBetweenQuestions);
  }
}

}  // namespace jobs
