// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/base/errors.h"
#include "server/messages/message.h"

namespace server {

/// Ends a request with a status and a sentence for the user.
class HttpError : public std::runtime_error {
 public:
  HttpError(int http_status, const std::string& detail) : std::runtime_error(detail), status(http_status) {}

  int status;
};

/// The phrase that goes with a status, "Not Found" for 404.
[[nodiscard]] std::string_view status_phrase(int status);

/// An answer of type application/problem+json (RFC 9457).
/// @param faults  every fault of the request; left out when empty. Of more than a hundred the first are
/// shown, and the detail says how many more there are
[[nodiscard]] Response make_problem(int status, const std::string& detail,
                                    const std::vector<jobs::Fault>& faults = {});

}  // namespace server
