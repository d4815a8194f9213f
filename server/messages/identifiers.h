// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "server/messages/message.h"

namespace server {

/// True for a text that may be an id: 1 to 64 letters, digits, '-' or '_'.
[[nodiscard]] bool is_id(const std::string& text);

/// Idempotency-Key of a request, without the quotes that it may have; empty if there is none.
/// @throws HttpError 400 if it is empty or longer than 255 bytes, or has other than visible ASCII characters
[[nodiscard]] std::string find_idempotency_key(const Request& request);

}  // namespace server
