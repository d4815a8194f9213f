// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string_view>

namespace server {

/// The N of `Prefer: wait=N` (RFC 7240), at most a minute. Empty if the preference is missing or N is no
/// number of seconds: a server ignores preferences that it does not understand.
[[nodiscard]] std::optional<std::chrono::seconds> find_wait(std::string_view prefer);

}  // namespace server
