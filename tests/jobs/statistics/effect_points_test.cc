// SPDX-License-Identifier: Apache-2.0
#include "jobs/statistics/effect_points.h"

#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace jobs_tests {
namespace {

using jobs::UnitPoints;

constexpr double kA = 7.0, kB = 0.1;

/// Ishigami and Homma (1990), over (-pi, pi) in each input.
double ishigami(const std::vector<double>& unit) {
  std::array<double, 3> x{};
  for (std::size_t d = 0; d < 3; ++d) x[d] = std::numbers::pi * (2.0 * unit[d] - 1.0);
  return std::sin(x[0]) + kA * std::pow(std::sin(x[1]), 2) + kB * std::pow(x[2], 4) * std::sin(x[0]);
}

std::vector<double> values_at(const UnitPoints& points, double (*f)(const std::vector<double>&)) {
  std::vector<double> values;
  for (const auto& point : points) values.push_back(f(point));
  return values;
}

TEST(SobolIndices, AreThoseOfIshigamisFunction) {
  const double pi4 = std::pow(std::numbers::pi, 4);
  const double variance = kA * kA / 8.0 + kB * pi4 / 5.0 + kB * kB * pi4 * pi4 / 18.0 + 0.5;
  const double alone = 0.5 * std::pow(1.0 + kB * pi4 / 5.0, 2);
  const double together = kB * kB * pi4 * pi4 * (1.0 / 18.0 - 1.0 / 50.0);
  const std::array<double, 3> first{alone / variance, kA * kA / 8.0 / variance, 0.0};
  const std::array<double, 3> total{(alone + together) / variance, kA * kA / 8.0 / variance,
                                    together / variance};
  const auto indices = jobs::calc_sobol_indices(values_at(jobs::saltelli_points(4096, 3, 1), ishigami), 3);
  ASSERT_EQ(indices.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    // Monte Carlo would have errors of 0.01 to 0.03 from 4096 blocks (the widths of the intervals); Sobol's
    // sequence has a fraction of that.
    EXPECT_NEAR(indices[i].first_order.value, first[i], 0.01) << i;
    EXPECT_NEAR(indices[i].total.value, total[i], 0.01) << i;
    EXPECT_LE(indices[i].first_order.low, first[i]);
    EXPECT_GE(indices[i].first_order.high, first[i]);
    EXPECT_LE(indices[i].total.low, total[i]);
    EXPECT_GE(indices[i].total.high, total[i]);
    EXPECT_LT(indices[i].first_order.high - indices[i].first_order.low, 0.15);
  }
}

TEST(SobolIndices, HaveIntervalsThatNarrowAsTheRootOfTheBlocks) {
  const auto width = [](std::size_t blocks) {
    const auto total =
        jobs::calc_sobol_indices(values_at(jobs::saltelli_points(blocks, 3, 1), ishigami), 3)[0].total;
    return total.high - total.low;
  };
  EXPECT_NEAR(width(256) / width(4096), 4.0, 1.0);
}

TEST(SobolIndices, AreZeroOfWhatDoesNotVary) {
  for (const auto& index : jobs::calc_sobol_indices(std::vector<double>(8, 3.5), 2)) {
    EXPECT_EQ(index.first_order.value, 0.0);
    EXPECT_EQ(index.total.high, 0.0);
  }
}

// 2 x - 3 y everywhere: each effect is the slope. x y: its effect on x is y, so the sizes are those of the
// grid's levels.
TEST(ElementaryEffects, AreTheSlopesOfAPlane) {
  const UnitPoints points = jobs::morris_points(10, 3, 4, 1);
  const auto effects = jobs::calc_elementary_effects(
      points, values_at(points, [](const std::vector<double>& p) { return 2.0 * p[0] - 3.0 * p[1]; }));
  ASSERT_EQ(effects.size(), 3U);
  for (const auto& [input, slope] : {std::pair{0, 2.0}, {1, -3.0}, {2, 0.0}}) {
    const auto& effect = effects[static_cast<std::size_t>(input)].value();
    EXPECT_NEAR(effect.mean, slope, 1e-12);
    EXPECT_NEAR(effect.mean_size.value, std::abs(slope), 1e-12);
    EXPECT_NEAR(effect.mean_size.high - effect.mean_size.low, 0.0, 1e-12);
    EXPECT_NEAR(effect.deviation, 0.0, 1e-12);
  }
}

// The effect of x on x y is y, uniform on four levels: mean 1/2, standard deviation sqrt(5)/6 = 0.373.
TEST(ElementaryEffects, ScatterWhereInputsWorkTogether) {
  const UnitPoints points = jobs::morris_points(2000, 2, 4, 1);
  for (const auto& effect : jobs::calc_elementary_effects(
           points, values_at(points, [](const std::vector<double>& p) { return p[0] * p[1]; }))) {
    const double error = std::sqrt(5.0) / 6.0 / std::sqrt(2000.0);
    EXPECT_NEAR(effect->mean, 0.5, 4.0 * error);
    EXPECT_NEAR(effect->deviation, std::sqrt(5.0) / 6.0, 4.0 * error);
    EXPECT_NEAR(effect->mean_size.high - effect->mean_size.low, 2.0 * 1.96 * error, 0.1 * error);
  }
}

TEST(MorrisPoints, ChangeEachCoordinateOnceOnTheGrid) {
  constexpr std::size_t kDimensions = 4;
  const UnitPoints points = jobs::morris_points(30, kDimensions, 6, 7);
  ASSERT_EQ(points.size(), 30 * (kDimensions + 1));
  std::set<double> levels;
  for (std::size_t t = 0; t < 30; ++t) {
    std::set<std::size_t> changed;
    for (std::size_t s = 1; s <= kDimensions; ++s) {
      const auto& from = points[t * (kDimensions + 1) + s - 1];
      const auto& to = points[t * (kDimensions + 1) + s];
      for (std::size_t d = 0; d < kDimensions; ++d) {
        levels.insert(std::round(5.0 * to[d]));
        if (from[d] == to[d]) continue;
        changed.insert(d);
        EXPECT_NEAR(std::abs(to[d] - from[d]), 0.6, 1e-12);
      }
      EXPECT_EQ(changed.size(), s);
    }
  }
  EXPECT_EQ(levels.size(), 6U);
  EXPECT_EQ(jobs::morris_points(3, 2, 4, 5), jobs::morris_points(3, 2, 4, 5));
  EXPECT_NE(jobs::morris_points(3, 2, 4, 5), jobs::morris_points(3, 2, 4, 6));
}

}  // namespace
}  // namespace jobs_tests
