// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "server/messages/message.h"

namespace server {

/// @returns whether a byte is a letter or a digit of ASCII, or one of the signs
[[nodiscard]] bool is_alphanumeric_or(unsigned char c, std::string_view signs);

/// True for a text that may be an id: 1 to 64 letters, digits, '-' or '_'.
[[nodiscard]] bool is_id(const std::string& text);

/// Idempotency-Key of a request, without the quotes that it may have; empty if there is none.
/// @throws HttpError 400 if it is empty or longer than 255 bytes, or has other than visible ASCII characters
[[nodiscard]] std::string find_idempotency_key(const Request& request);

}  // namespace server
