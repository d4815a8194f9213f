// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/time_left.h"

#include <cmath>

#include <gtest/gtest.h>

namespace jobs_tests {
namespace {

TEST(TimeLeft, IsThatOfTheJobsThatAreLeftByKind) {
  jobs::SweepRow row;
  row.counts = {8, 1, 5, 0, 0};
  row.costs["rigid"] = {
      .queued = 4, .running = 1, .computed = 2, .wall_time_s = 6.0, .wall_time_squares_s2 = 18.0};
  row.costs["flexible"] = {
      .queued = 4, .running = 0, .computed = 3, .wall_time_s = 30.0, .wall_time_squares_s2 = 300.0};
  // (4 + 1/2) * 3 s + 4 * 10 s; all jobs of a kind took the same time, so there is no spread.
  const auto left = jobs::estimate_time_left(row, 1).value();
  EXPECT_DOUBLE_EQ(left.expected_s, 53.5);
  EXPECT_DOUBLE_EQ(left.low_s, 53.5);
  EXPECT_DOUBLE_EQ(left.high_s, 53.5);
  EXPECT_DOUBLE_EQ(jobs::estimate_time_left(row, 2)->expected_s, 53.5 / 2.0);
  // a flexible one takes its time on whatever thread
  EXPECT_DOUBLE_EQ(jobs::estimate_time_left(row, 100)->expected_s, 10.0);
  row.costs["flexible"].computed = 0;
  EXPECT_FALSE(jobs::estimate_time_left(row, 1).has_value());
  row.counts = {0, 0, 14, 0, 0};
  EXPECT_EQ(jobs::estimate_time_left(row, 1)->expected_s, 0.0);
}

TEST(TimeLeft, HasTheSpreadOfWhatHasBeenMeasured) {
  jobs::SweepRow row;
  row.counts = {100, 0, 2, 0, 0};
  // 9 s and 11 s: mean 10 s, variance 2 s^2; 100 more have 2 * 100 * (1 + 100 / 2) = 10200 s^2.
  row.costs["rigid"] = {
      .queued = 100, .running = 0, .computed = 2, .wall_time_s = 20.0, .wall_time_squares_s2 = 81.0 + 121.0};
  const auto left = jobs::estimate_time_left(row, 1).value();
  EXPECT_DOUBLE_EQ(left.expected_s, 1000.0);
  EXPECT_DOUBLE_EQ(left.low_s, 1000.0 - 2.0 * std::sqrt(10200.0));
  EXPECT_DOUBLE_EQ(left.high_s, 1000.0 + 2.0 * std::sqrt(10200.0));
  EXPECT_DOUBLE_EQ(jobs::estimate_time_left(row, 2)->high_s, 500.0 + std::sqrt(10200.0));
}

TEST(TimeLeft, IsHardlyKnownAfterOneJob) {
  jobs::SweepRow row;
  row.counts = {1, 0, 1, 0, 0};
  row.costs["rigid"] = {
      .queued = 1, .running = 0, .computed = 1, .wall_time_s = 4.0, .wall_time_squares_s2 = 16.0};
  const auto left = jobs::estimate_time_left(row, 1).value();
  EXPECT_EQ(left.low_s, 0.0);
  EXPECT_DOUBLE_EQ(left.high_s, 4.0 + 2.0 * std::sqrt(2.0 * 16.0));
}

}  // namespace
}  // namespace jobs_tests
