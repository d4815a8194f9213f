// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "jobs/statistics/unit_points.h"

namespace jobs_tests {
namespace {

/// In how many of `count` equal intervals of a dimension there is a point.
std::size_t filled_intervals(const jobs::UnitPoints& points, std::size_t dimension, std::size_t count) {
  std::set<double> filled;
  for (const auto& point : points) filled.insert(std::floor(point[dimension] * static_cast<double>(count)));
  return filled.size();
}

RC_GTEST_PROP(LatinHypercube, HasOnePointInEachIntervalOfEachDimension, (std::uint64_t seed)) {
  const auto count = *rc::gen::inRange<std::size_t>(1, 300);
  const auto points = jobs::latin_hypercube(count, 5, seed);
  RC_ASSERT(points.size() == count);
  for (std::size_t d = 0; d < 5; ++d) RC_ASSERT(filled_intervals(points, d, count) == count);
  for (const auto& point : points) {
    for (const double u : point) RC_ASSERT(u >= 0.0 && u < 1.0);
  }
}

// Points on a diagonal are a Latin hypercube, too, and a useless one: of independent permutations the
// coordinates are uncorrelated. The correlation of n independent pairs has a standard deviation of 1/sqrt(n -
// 1) = 0.032.
TEST(LatinHypercube, PermutesDimensionsIndependently) {
  const auto points = jobs::latin_hypercube(1000, 4, 1);
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      double sum = 0.0;
      for (const auto& point : points) sum += (point[a] - 0.5) * (point[b] - 0.5);
      EXPECT_LT(std::abs(sum / 1000.0 * 12.0), 0.13) << a << " and " << b;
    }
  }
}

TEST(LatinHypercube, IsThatOfItsSeed) {
  EXPECT_EQ(jobs::latin_hypercube(16, 3, 7), jobs::latin_hypercube(16, 3, 7));
  EXPECT_NE(jobs::latin_hypercube(16, 3, 7), jobs::latin_hypercube(16, 3, 8));
}

// The points 0 to 9 that the authors of the direction numbers print for three dimensions.
TEST(SobolPoints, AreThosePublishedByJoeAndKuo) {
  const jobs::UnitPoints published{{0, 0, 0},
                                   {0.5, 0.5, 0.5},
                                   {0.75, 0.25, 0.25},
                                   {0.25, 0.75, 0.75},
                                   {0.375, 0.375, 0.625},
                                   {0.875, 0.875, 0.125},
                                   {0.625, 0.125, 0.875},
                                   {0.125, 0.625, 0.375},
                                   {0.1875, 0.3125, 0.9375},
                                   {0.6875, 0.8125, 0.4375}};
  EXPECT_EQ(jobs::sobol_points(10, 3, {}), published);
}

RC_GTEST_PROP(SobolPoints, FillEveryIntervalOfAPowerOfTwoShiftedOrNot, (std::uint64_t seed)) {
  for (const auto& points : {jobs::sobol_points(64, 12, {}), jobs::sobol_points(64, 12, seed)}) {
    for (std::size_t d = 0; d < 12; ++d) RC_ASSERT(filled_intervals(points, d, 64) == 64U);
  }
  RC_ASSERT(jobs::sobol_points(64, 12, seed) == jobs::sobol_points(64, 12, seed));
}

// The first two dimensions are a (0, m, 2)-net: every elementary interval of area 2^-m has one point.
TEST(SobolPoints, FillTheElementaryIntervalsOfTheFirstTwoDimensions) {
  for (const auto& points : {jobs::sobol_points(64, 2, {}), jobs::sobol_points(64, 2, 3)}) {
    for (int m = 0; m <= 6; ++m) {
      std::set<std::pair<double, double>> filled;
      for (const auto& point : points)
        filled.emplace(std::floor(std::ldexp(point[0], m)), std::floor(std::ldexp(point[1], 6 - m)));
      EXPECT_EQ(filled.size(), 64U) << m;
    }
  }
}

}  // namespace
}  // namespace jobs_tests
