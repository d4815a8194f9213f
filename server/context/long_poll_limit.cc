// SPDX-License-Identifier: Apache-2.0
#include "server/context/long_poll_limit.h"

#include <string>

#include "server/messages/preference.h"

namespace server {

namespace {

/// Counts a request as waiting for as long as this object lives.
struct WaitingRequest {
  explicit WaitingRequest(std::atomic<int>& waiting) : number(++waiting), waiting_(waiting) {}
  ~WaitingRequest() { --waiting_; }
  WaitingRequest(const WaitingRequest&) = delete;
  WaitingRequest& operator=(const WaitingRequest&) = delete;

  const int number;

 private:
  std::atomic<int>& waiting_;
};

}  // namespace

bool LongPollLimit::wait(const Request& request, Response& response,
                         const std::function<void(std::chrono::seconds)>& wait_for) {
  const auto time = find_wait(request.prefer);
  if (!time) return false;
  const WaitingRequest waiting(waiting_);
  if (waiting.number > kMaxWaiting) return false;
  wait_for(*time);
  response.headers.emplace_back("Preference-Applied", "wait=" + std::to_string(time->count()));
  return true;
}

}  // namespace server
