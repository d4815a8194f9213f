// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>

namespace jobs {

/// Count of changes that threads wait for, until it is closed.
class ChangeSignal {
 public:
  [[nodiscard]] std::uint64_t count() const;
  void add_change();
  /// Ends all waiting, also later.
  void close();
  [[nodiscard]] bool is_closed() const;

  /// Blocks until count() differs from `seen`, or until the signal is closed.
  void wait(std::uint64_t seen) const;
  /// Blocks until the signal is closed, or for at most that long.
  void wait_until_closed(std::chrono::seconds at_most) const;
  /// Blocks until has_ended() is true, which is asked after changes, or for at most that long, or until the
  /// signal is closed. @returns whether has_ended() was true; false at once if it is empty: there is nothing
  /// to wait for
  bool wait_for(std::chrono::milliseconds at_most,
                const std::function<std::optional<bool>()>& has_ended) const;

 private:
  /// Blocks until count() differs from `seen`. @returns false at the deadline, or if the signal is closed
  bool wait_for_change(std::uint64_t seen, std::chrono::steady_clock::time_point deadline) const;

  mutable std::mutex mutex_;  // guards the rest
  mutable std::condition_variable changed_;
  std::uint64_t count_ = 0;
  bool closed_ = false;
};

}  // namespace jobs
