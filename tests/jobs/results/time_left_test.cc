// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/time_left.h"

#include <cmath>

#include <gtest/gtest.h>

namespace jobs_tests {
namespace {

TEST(TimeLeft, IsThatOfTheJobsThatAreLeftByKind) {
  jobs::SweepRow row;
  row.counts = {8, 1, 5, 0, 0};
  row.costs["rigid"] = {.queued = 4, .queued_s = 4.0, .queued_squares_s2 = 4.0, .longest_queued_s = 1.0, .running = {{.elapsed_s = 1.5}},
                        .computed = 2, .computed_s = 2.0, .wall_time_s = 6.0, .rates = 6.0, .rate_squares = 18.0};
  row.costs["flexible"] = {.queued = 4, .queued_s = 4.0, .queued_squares_s2 = 4.0, .longest_queued_s = 1.0,
                           .computed = 3, .computed_s = 3.0, .wall_time_s = 30.0, .rates = 30.0, .rate_squares = 300.0};
  // 4 * 3 s, 1.5 s of the running one, and 4 * 10 s; all jobs of a kind took the same time, so there is no spread.
  const auto left = jobs::estimate_time_left(row, 1).value();
  EXPECT_DOUBLE_EQ(left.expected_s, 53.5);
  EXPECT_DOUBLE_EQ(left.low_s, 53.5);
  EXPECT_DOUBLE_EQ(left.high_s, 53.5);
  EXPECT_DOUBLE_EQ(jobs::estimate_time_left(row, 2)->expected_s, 53.5 / 2.0);
  EXPECT_DOUBLE_EQ(jobs::estimate_time_left(row, 100)->expected_s, 10.0);  // a flexible one takes its time on whatever thread
  row.costs["flexible"].computed = 0;
  EXPECT_FALSE(jobs::estimate_time_left(row, 1).has_value());
  row.counts = {0, 0, 14, 0, 0};
  EXPECT_EQ(jobs::estimate_time_left(row, 1)->expected_s, 0.0);
}

TEST(TimeLeft, HasTheSpreadOfWhatHasBeenMeasured) {
  jobs::SweepRow row;
  row.counts = {100, 0, 2, 0, 0};
  // 9 s and 11 s: mean 10 s, variance 2 s^2; 100 more have 2 * 100 * (1 + 100 / 2) = 10200 s^2.
  row.costs["rigid"] = {.queued = 100, .queued_s = 100.0, .queued_squares_s2 = 100.0, .longest_queued_s = 1.0, .computed = 2, .computed_s = 2.0,
                        .wall_time_s = 20.0, .rates = 20.0, .rate_squares = 81.0 + 121.0};
  const auto left = jobs::estimate_time_left(row, 1).value();
  EXPECT_DOUBLE_EQ(left.expected_s, 1000.0);
  EXPECT_DOUBLE_EQ(left.low_s, 1000.0 - 2.0 * std::sqrt(10200.0));
  EXPECT_DOUBLE_EQ(left.high_s, 1000.0 + 2.0 * std::sqrt(10200.0));
  EXPECT_DOUBLE_EQ(jobs::estimate_time_left(row, 2)->high_s, 500.0 + std::sqrt(10200.0));
}

TEST(TimeLeft, IsHardlyKnownAfterOneJob) {
  jobs::SweepRow row;
  row.counts = {1, 0, 1, 0, 0};
  row.costs["rigid"] = {.queued = 1, .queued_s = 1.0, .queued_squares_s2 = 1.0, .longest_queued_s = 1.0, .computed = 1, .computed_s = 1.0,
                        .wall_time_s = 4.0, .rates = 4.0, .rate_squares = 16.0};
  const auto left = jobs::estimate_time_left(row, 1).value();
  EXPECT_EQ(left.low_s, 0.0);
  EXPECT_DOUBLE_EQ(left.high_s, 4.0 + 2.0 * std::sqrt(2.0 * 16.0));
}

// Ten jobs of 0.2 s cost 0.4 s each, 2 s a simulated second; one of 60 s runs for 20 s, one of 61 s waits.
TEST(TimeLeft, GrowsWithTheTimeThatIsSimulated) {
  jobs::SweepRow row;
  row.counts = {1, 1, 10, 0, 0};
  row.costs["rigid"] = {.queued = 1, .queued_s = 61.0, .queued_squares_s2 = 61.0 * 61.0, .longest_queued_s = 61.0, .running = {{.simulated_s = 60.0, .elapsed_s = 20.0}},
                        .computed = 10, .computed_s = 2.0, .wall_time_s = 4.0, .rates = 20.0, .rate_squares = 40.0};
  EXPECT_DOUBLE_EQ(jobs::estimate_time_left(row, 1)->expected_s, 122.0 + 100.0);
  EXPECT_DOUBLE_EQ(jobs::estimate_time_left(row, 2)->expected_s, 122.0) << "the longest takes its time";
  EXPECT_NEAR(jobs::estimate_time_left(row, 2)->high_s, 122.0, 1e-6) << "every simulated second has cost the same";
}

TEST(TimeLeft, IsNotLessThanWhatARunningJobIsLate) {
  jobs::SweepRow row;
  row.counts = {0, 1, 4, 0, 0};
  row.costs["rigid"] = {.running = {{.elapsed_s = 35.0}}, .computed = 4, .computed_s = 4.0, .wall_time_s = 20.0, .rates = 20.0, .rate_squares = 100.0};
  EXPECT_DOUBLE_EQ(jobs::estimate_time_left(row, 2)->expected_s, 30.0) << "5 s were expected, 35 s have passed";
}

}  // namespace
}  // namespace jobs_tests
