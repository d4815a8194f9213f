// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>

namespace server {

/// Limits copies of the store to one at a time: each takes as much of the disk as the store, until it has
/// been sent.
class StoreCopyLimit {
 public:
  /// @returns a permit, which is released by its destruction; null while there is another one
  [[nodiscard]] std::shared_ptr<const void> acquire() {
    const std::lock_guard lock(mutex_);
    if (!permit_.expired()) return nullptr;
    const auto permit = std::make_shared<const char>();
    permit_ = permit;
    return permit;
  }

 private:
  std::mutex mutex_;  // guards permit_
  std::weak_ptr<const void> permit_;
};

}  // namespace server
