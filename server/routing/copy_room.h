// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>

namespace server {

/// Room for one copy of the store: each takes as much of the disk as the store, until it has been sent.
class CopyRoom {
 public:
  /// The room is free again once what this gives is gone. @returns null while there is a copy
  [[nodiscard]] std::shared_ptr<const void> enter() {
    const std::lock_guard lock(mutex_);
    if (!taken_.expired()) return nullptr;
    const auto permit = std::make_shared<const char>();
    taken_ = permit;
    return permit;
  }

 private:
  std::mutex mutex_;  // guards taken_
  std::weak_ptr<const void> taken_;
};

}  // namespace server
