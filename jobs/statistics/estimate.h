// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace jobs {

/// With 95 % confidence between low and high.
struct Estimate {
  double value = 0.0, low = 0.0, high = 0.0;
};

/// The mean of samples of a normal distribution, with Student's interval.
/// @param values  two or more
[[nodiscard]] Estimate estimate_mean(std::span<const double> values);

}  // namespace jobs
