// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace engine {

/// Proportional-integral step size control. Source: E. Hairer, G. Wanner, Solving Ordinary Differential
/// Equations II, section IV.2.
class StepControl {
 public:
  /// @param order  of the error estimate plus one: the exponent with which the error falls with dt
  explicit StepControl(double order) : proportional_(0.7 / order), integral_(0.4 / order) {}

  /// Factor for the step after one that was accepted with this error (in units of the tolerance).
  [[nodiscard]] double accept(double error) {
    const double e = std::max(error, 1e-10);
    const double factor = kSafety * std::pow(e, -proportional_) * std::pow(last_error_, integral_);
    last_error_ = std::max(e, 1e-4);
    const double limit = rejected_ ? 1.0 : kMaxFactor;
    rejected_ = false;
    return std::clamp(factor, kMinFactor, limit);
  }

  /// Factor for the next try after a rejected one.
  [[nodiscard]] double reject(double error) {
    rejected_ = true;
    return std::clamp(kSafety * std::pow(error, -(proportional_ + integral_)), kMinFactor, kSafety);
  }

 private:
  static constexpr double kSafety = 0.9;
  static constexpr double kMinFactor = 0.2;
  static constexpr double kMaxFactor = 5.0;

  double proportional_, integral_;
  double last_error_ = 1e-4;
  bool rejected_ = false;
};

}  // namespace engine
