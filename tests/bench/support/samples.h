// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

namespace bench {

/// Measurements of one thing, repeated between those of others.
class Samples {
 public:
  void add(double value) { values_.insert(std::upper_bound(values_.begin(), values_.end(), value), value); }

  [[nodiscard]] double least() const { return values_.front(); }
  [[nodiscard]] double median() const {
    const std::size_t n = values_.size();
    return 0.5 * (values_[(n - 1) / 2] + values_[n / 2]);
  }

 private:
  std::vector<double> values_;  // in order
};

}  // namespace bench
