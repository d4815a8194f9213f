// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <random>

#include <Eigen/Core>

namespace engine {

/// Random numbers, the same on every machine.
class Draw {
 public:
  explicit Draw(unsigned seed) : generator_(seed) {}

  double within(double least, double most) { return least + (most - least) * static_cast<double>(generator_()) / 4294967296.0; }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(within(0.0, static_cast<double>(count))); }
  bool happens(double probability) { return within(0.0, 1.0) < probability; }
  Eigen::Vector3d point(double reach) { return {within(-reach, reach), within(-reach, reach), within(-reach, reach)}; }

 private:
  std::mt19937 generator_;
};

}  // namespace engine
