// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <spdlog/spdlog.h>

namespace server {

/// Writes an error to the log where an exception would end the process. Without memory nothing is written.
template <typename... Arguments>
void log_error(spdlog::format_string_t<Arguments...> format, Arguments&&... arguments) noexcept {
  try {
    spdlog::error(format, std::forward<Arguments>(arguments)...);
  } catch (...) {  // NOLINT: there is nobody to tell
  }
}

}  // namespace server
