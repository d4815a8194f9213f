// SPDX-License-Identifier: Apache-2.0
#include "engine/math/exponential.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace engine {
namespace {

TEST(Exponentials, AreWithinAUnitInTheLastPlace) {
  std::mt19937_64 random(1);
  for (const double range : {1e-12, 0.3, 1.0, 40.0, 700.0}) {
    std::uniform_real_distribution<double> uniform(-range, range);
    for (int round = 0; round < 5000; ++round) {
      Lanes x;
      for (int lane = 0; lane < Lanes::kCount; ++lane) x.set(lane, uniform(random));
      const Lanes e = calc_exponentials(x);
      for (int lane = 0; lane < Lanes::kCount; ++lane) {
        const long double exact = expl(x[lane]);
        const double size = static_cast<double>(exact);
        const double unit = std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
        ASSERT_NEAR(static_cast<double>(e[lane] - exact), 0.0, unit) << x[lane];
      }
    }
  }
}

TEST(Exponentials, AreExactAtZeroAndNoNumbersOfNoNumbers) {
  Lanes x{};
  x.set(1, -0.0);
  x.set(2, std::numeric_limits<double>::quiet_NaN());
  const Lanes e = calc_exponentials(x);
  EXPECT_EQ(e[0], 1.0);
  EXPECT_EQ(e[1], 1.0);
  EXPECT_TRUE(std::isnan(e[2]));
  EXPECT_EQ(e[3], 1.0);
}

}  // namespace
}  // namespace engine
