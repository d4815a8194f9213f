// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace jobs {

[[nodiscard]] std::int64_t now_unix_ms();

/// RFC 3339 in UTC with milliseconds: "2026-01-31T12:00:00.250Z".
[[nodiscard]] std::string time_text(std::int64_t unix_ms);

}  // namespace jobs
