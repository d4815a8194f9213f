// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdio>
#include <string>

#include "validation/engine_names.h"

namespace validation {

/// A number with so many significant digits, for a table's cell or a check's text.
[[nodiscard]] inline std::string number(double value, int digits = 3) {
  std::array<char, 40> text{};
  (void)std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

}  // namespace validation
