// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <set>
#include <string>
#include <utility>

#include "jobs/base/errors.h"

namespace jobs {

/// Idempotency keys of requests that are being answered: a second request under the same key is refused.
class InFlightKeys {
 public:
  /// Holds a key for as long as it lives.
  class Use {
   public:
    /// @throws WrongState if the key is held
    Use(InFlightKeys& keys, std::string key) : keys_(keys), key_(std::move(key)) {
      const std::lock_guard lock(keys_.mutex_);
      if (!keys_.held_.insert(key_).second)
        throw WrongState(
            "a request with this Idempotency-Key is being answered; send it again for its answer");
    }
    ~Use() {
      const std::lock_guard lock(keys_.mutex_);
      keys_.held_.erase(key_);
    }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    InFlightKeys& keys_;
    std::string key_;
  };

 private:
  std::mutex mutex_;  // guards held_
  std::set<std::string> held_;
};

}  // namespace jobs
