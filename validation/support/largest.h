// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

#include "validation/engine_names.h"

namespace validation {

/// The largest magnitude of the numbers taken. A NaN among them stays, and nothing taken is NaN too, so that
/// a limit on it cannot pass.
class Largest {
 public:
  void take(double number) {
    const double magnitude = std::abs(number);
    if (empty_ || magnitude > value_ || std::isnan(magnitude)) value_ = magnitude;
    empty_ = false;
  }
  /// NaN until a number was taken.
  [[nodiscard]] double value() const { return value_; }

 private:
  bool empty_ = true;
  double value_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace validation
