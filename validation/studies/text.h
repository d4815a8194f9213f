// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>

namespace validation::studies {

/// A number in printf's pattern.
[[nodiscard]] inline std::string to_text(const char* pattern, double value) {
  char text[192];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

}  // namespace validation::studies
