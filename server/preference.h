#pragma once

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "jobs/service.h"
#include "server/message.h"

namespace server {

/// The N of `Prefer: wait=N` (RFC 7240), at most a minute. Empty if it is not there or is no number of seconds: a preference that is not
/// understood is not followed.
[[nodiscard]] std::optional<std::chrono::seconds> find_wait(std::string_view prefer);

/// How many clients may wait for a sweep at a time. Each of them holds a thread of the server.
class WaitingRoom {
 public:
  /// Waits for the end of a sweep as the request prefers. False, at once, if it does not or if there is no room.
  bool wait(const jobs::Service& service, const std::string& sweep_id, const Request& request);

 private:
  static constexpr int kPlaces = 8;
  std::atomic<int> waiting_ = 0;
};

}  // namespace server
