// SPDX-License-Identifier: Apache-2.0
#include "server/context/long_poll_limit.h"

#include <string>

#include "server/messages/preference.h"

namespace server {

bool LongPollLimit::wait(const Request& request, Response& response,
                         const std::function<void(std::chrono::seconds)>& wait_for) {
  const auto time = find_wait(request.prefer);
  if (!time) return false;
  const auto permit = limit_.acquire();
  const auto place = permit ? places_.acquire() : nullptr;
  if (!place) return false;
  wait_for(*time);
  response.headers.emplace_back("Preference-Applied", "wait=" + std::to_string(time->count()));
  return true;
}

}  // namespace server
