// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "validation/engine_names.h"

namespace validation {

/// First derivative at zero by central differences of order 8; their error is h^8 f^(9) / 630.
/// @param f  a function of one number; its values can be added and multiplied by numbers
template <typename Function>
[[nodiscard]] auto first_derivative(const Function& f, double h) {
  constexpr std::array<double, 4> weights{4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0};
  auto sum = f(h);
  sum = weights[0] / h * (f(h) - f(-h));
  for (std::size_t k = 1; k < weights.size(); ++k) {
    const double step = static_cast<double>(k + 1) * h;
    sum += weights[k] / h * (f(step) - f(-step));
  }
  return sum;
}

}  // namespace validation
