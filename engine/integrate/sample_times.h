// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

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

 private:
  double rate_, duration_;
  long index_ = 0;
};

}  // namespace engine
