// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <string>

#include "server/messages/message.h"

namespace server {

/// Turns what a route threw into the answer for the user; what the user must not see goes to the log, under
/// the id of the request.
///
///     HttpError its own, BadJson 400, InvalidRequest 422 with every fault, QueueFull 429, WrongState 409,
///     Stopped 503, StorageError 507 when the disk is full and 503 otherwise, std::bad_alloc 503, anything
///     else 500 without its text
[[nodiscard]] Response make_error_answer(const std::exception_ptr& error, const std::string& request_id);

/// A problem that a later try may not meet: with Retry-After.
[[nodiscard]] Response make_retry_later(int status, const std::string& detail);

}  // namespace server
