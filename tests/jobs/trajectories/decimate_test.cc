// SPDX-License-Identifier: Apache-2.0
#include "jobs/trajectories/decimate.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace jobs_tests {
namespace {

engine::Trajectory noise(std::size_t samples, std::size_t channels) {
  std::mt19937 generator(7);
  std::normal_distribution<double> value;
  engine::Trajectory trajectory;
  for (std::size_t c = 0; c <= channels; ++c) {
    trajectory.channels.push_back({.key = c == 0 ? "t_s" : "c" + std::to_string(c), .help = ""});
    std::vector<double> column;
    for (std::size_t k = 0; k < samples; ++k)
      column.push_back(c == 0 ? static_cast<double>(k) / 1000.0 : value(generator));
    trajectory.columns.push_back(std::move(column));
  }
  return trajectory;
}

TEST(Decimate, KeepsTheExtremesOfEveryStretch) {
  for (const std::size_t channels : {1U, 3U}) {
    const auto all = noise(5001, channels);
    auto some = all;
    constexpr std::size_t kMostPoints = 302;
    jobs::decimate(kMostPoints, some);
    const auto& t = some.columns.front();
    ASSERT_LE(t.size(), kMostPoints);
    ASSERT_GT(t.size(), kMostPoints / 2);
    EXPECT_EQ(t.front(), all.columns.front().front());
    EXPECT_EQ(t.back(), all.columns.front().back());
    // Each tenth of the time has whole stretches in it, and so the extremes of what it had, next to its
    // borders excepted.
    for (std::size_t c = 1; c <= channels; ++c) {
      EXPECT_EQ(std::ranges::max(some.columns[c]), std::ranges::max(all.columns[c]));
      EXPECT_EQ(std::ranges::min(some.columns[c]), std::ranges::min(all.columns[c]));
      const std::size_t stretches = (kMostPoints - 2) / (2 * channels);
      for (std::size_t s = 0; s < stretches; ++s) {
        const auto begin = all.columns[c].begin() + static_cast<std::ptrdiff_t>(5001 * s / stretches);
        const auto end = all.columns[c].begin() + static_cast<std::ptrdiff_t>(5001 * (s + 1) / stretches);
        EXPECT_NE(std::ranges::find(some.columns[c], *std::max_element(begin, end)), some.columns[c].end());
        EXPECT_NE(std::ranges::find(some.columns[c], *std::min_element(begin, end)), some.columns[c].end());
      }
    }
  }
}

TEST(Decimate, MakesNoSampleUp) {
  const auto all = noise(997, 2);
  auto some = all;
  jobs::decimate(50, some);
  for (std::size_t k = 0; k < some.columns[0].size(); ++k) {
    const auto place = static_cast<std::size_t>(std::ranges::find(all.columns[0], some.columns[0][k]) -
                                                all.columns[0].begin());
    ASSERT_LT(place, all.columns[0].size());
    for (std::size_t c = 1; c <= 2; ++c) EXPECT_EQ(some.columns[c][k], all.columns[c][place]);
  }
  EXPECT_TRUE(std::ranges::is_sorted(some.columns[0]));
}

TEST(Decimate, LeavesWhatIsSmallEnough) {
  auto few = noise(20, 1);
  jobs::decimate(20, few);
  EXPECT_EQ(few.columns[0].size(), 20U);
}

TEST(Decimate, PassesOverWhatIsNoNumber) {
  auto trajectory = noise(100, 1);
  std::ranges::fill(trajectory.columns[1], std::nan(""));
  trajectory.columns[1][57] = 1.0;
  jobs::decimate(4, trajectory);
  EXPECT_EQ(trajectory.columns[0], (std::vector<double>{0.0, 0.057, 0.099}));
}

TEST(Decimate, ThinsTheTimeAloneOutEvenly) {
  auto trajectory = noise(1001, 0);
  jobs::decimate(12, trajectory);
  ASSERT_EQ(trajectory.columns[0].size(), 11U);  // the first stretch begins with the first sample
  EXPECT_NEAR(trajectory.columns[0][5], 0.5, 0.001);
}

}  // namespace
}  // namespace jobs_tests
