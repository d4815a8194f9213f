// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace engine {

/// Instants at which a run is sampled: multiples of an interval, and its end.
class SampleTimes {
 public:
  SampleTimes(double rate, double duration) : rate_(rate), duration_(duration) {}

  [[nodiscard]] double next() const { return std::min(static_cast<double>(index_) / rate_, duration_); }
  [[nodiscard]] bool all_taken() const {
    return index_ > 0 && static_cast<double>(index_ - 1) / rate_ >= duration_;
  }
  void take() { ++index_; }
  /// Number of instants in all, up to a rounding.
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(std::ceil(duration_ * rate_)) + 1;
  }

 private:
  double rate_, duration_;
  long index_ = 0;
};

}  // namespace engine
