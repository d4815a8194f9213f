// SPDX-License-Identifier: Apache-2.0
#include "engine/math/sine_cosine.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace engine {
namespace {

constexpr std::size_t kCount = 7;  // not a whole number of blocks

struct Numbers {
  std::array<double, in_sine_blocks(kCount)> x{}, sine{}, cosine{};

  void calc() { calc_sines_and_cosines(x.data(), kCount, sine.data(), cosine.data()); }
};

/// The larger of: units in the last place, and what rounding of pi / 2 leaves near a zero.
double allowed(long double exact) {
  const double size = std::abs(static_cast<double>(exact));
  return std::max(std::nextafter(size, 2.0) - size, 1e-22);
}

TEST(SinesAndCosines, AreWithinAUnitInTheLastPlace) {
  std::mt19937_64 random(1);
  Numbers numbers;
  for (const double range : {1e-9, 0.5, 7.0, 300.0, 9.9e5}) {
    std::uniform_real_distribution<double> uniform(-range, range);
    for (int round = 0; round < 3000; ++round) {
      for (double& x : numbers.x) x = uniform(random);
      numbers.calc();
      for (std::size_t i = 0; i < kCount; ++i) {
        const long double exact_sine = sinl(numbers.x[i]), exact_cosine = cosl(numbers.x[i]);
        ASSERT_NEAR(static_cast<double>(numbers.sine[i] - exact_sine), 0.0, allowed(exact_sine)) << numbers.x[i];
        ASSERT_NEAR(static_cast<double>(numbers.cosine[i] - exact_cosine), 0.0, allowed(exact_cosine)) << numbers.x[i];
      }
    }
  }
}

TEST(SinesAndCosines, AreExactWhereTheyCanBe) {
  Numbers numbers;
  numbers.x = {0.0, -0.0, std::numbers::pi / 2.0, std::numbers::pi, -std::numbers::pi / 2.0, 1e-200, 4e-324};
  numbers.calc();
  EXPECT_EQ(numbers.sine[0], 0.0);
  EXPECT_EQ(numbers.cosine[0], 1.0);
  EXPECT_EQ(numbers.cosine[1], 1.0);
  EXPECT_EQ(numbers.sine[2], 1.0);
  EXPECT_NEAR(numbers.cosine[2], std::cos(std::numbers::pi / 2.0), 1e-26);
  EXPECT_EQ(numbers.cosine[3], -1.0);
  EXPECT_EQ(numbers.sine[4], -1.0);
  EXPECT_EQ(numbers.sine[5], 1e-200);
  EXPECT_EQ(numbers.sine[6], 4e-324);
}

TEST(SinesAndCosines, DoNotDependOnTheNumbersBeside) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(-0.8, 0.8);
  for (int round = 0; round < 3000; ++round) {
    Numbers small;  // which takes a shorter way, unless one is beyond pi / 4
    for (double& x : small.x) x = uniform(random);
    small.calc();
    for (const double large : {5.0, 2e6}) {
      Numbers mixed = small;
      for (std::size_t i = static_cast<std::size_t>(round % 2); i < kCount; i += 2) mixed.x[i] = large;
      mixed.calc();
      for (std::size_t i = static_cast<std::size_t>(1 - round % 2); i < kCount; i += 2) {
        ASSERT_EQ(mixed.sine[i], small.sine[i]) << small.x[i];
        ASSERT_EQ(mixed.cosine[i], small.cosine[i]) << small.x[i];
      }
    }
  }
}

TEST(SinesAndCosines, OfLargeNumbersAndOfNoNumbersAreTheLibrarys) {
  Numbers numbers;
  numbers.x = {1e6, -3e15, 1e300, 0.5, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN(), 2.0};
  numbers.calc();
  for (const std::size_t i : {0, 1, 2}) {
    EXPECT_EQ(numbers.sine[i], std::sin(numbers.x[i])) << numbers.x[i];
    EXPECT_EQ(numbers.cosine[i], std::cos(numbers.x[i])) << numbers.x[i];
  }
  EXPECT_TRUE(std::isnan(numbers.sine[4]));
  EXPECT_TRUE(std::isnan(numbers.cosine[5]));
}

}  // namespace
}  // namespace engine
