// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <string_view>

#include "server/messages/message.h"

namespace server {

/// The N of `Prefer: wait=N` (RFC 7240), at most a minute. Empty if it is not there or is no number of seconds: a preference that is not
/// understood is not followed.
[[nodiscard]] std::optional<std::chrono::seconds> find_wait(std::string_view prefer);

/// How many clients may wait for the end of something at a time. Each of them holds a thread of the server.
class WaitingRoom {
 public:
  /// Calls wait_for() with the time for which the request prefers to wait, and says in the response that it did.
  /// @returns false, at once, if the request does not or if there is no room
  bool wait(const Request& request, Response& response, const std::function<void(std::chrono::seconds)>& wait_for);

 private:
  static constexpr int kPlaces = 8;
  std::atomic<int> waiting_ = 0;
};

}  // namespace server
