// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

#include <Eigen/Core>

#include "validation/engine_names.h"

namespace validation {

/// Numbers from a fixed seed, the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}

  /// In [-scale, scale).
  [[nodiscard]] double symmetric(double scale) {
    return scale * (static_cast<double>(bits_() >> 11) * 0x1p-52 - 1.0);
  }
  [[nodiscard]] Eigen::VectorXd symmetric_vector(Eigen::Index size, double scale) {
    Eigen::VectorXd v(size);
    for (double& x : v) x = symmetric(scale);
    return v;
  }

 private:
  std::mt19937_64 bits_;
};

}  // namespace validation
