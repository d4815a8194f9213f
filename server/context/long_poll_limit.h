// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>

#include "server/context/work_limit.h"
#include "server/messages/message.h"

namespace server {

/// Limits the requests that wait at a time for the end of a job, a sweep or a study (`Prefer: wait=N`). Each
/// holds a thread of the server.
class LongPollLimit {
 public:
  /// @param places  has a permit for each request that waits, here or at other limits
  explicit LongPollLimit(WorkLimit& places) : places_(places) {}

  /// Calls wait_for() with the time for which the request prefers to wait, and says in the response that it
  /// did.
  /// @returns false, at once, if the request does not prefer to wait or if too many wait
  bool wait(const Request& request, Response& response,
            const std::function<void(std::chrono::seconds)>& wait_for);

 private:
  WorkLimit limit_{8, 0};
  WorkLimit& places_;
};

}  // namespace server
