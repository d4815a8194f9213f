// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/time_left.h"

#include <cmath>
#include <memory>
#include <vector>

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

// Ten jobs of 0.2 s cost 4 s, 2 s a simulated second, most of it for their beginning. Two jobs of 60 s have
// simulated a third of that in 20 s each: (4 + 40) / (2 + 40) s a simulated second, for 40 s of each.
TEST(TimeLeft, FollowsWhatRunningJobsHaveSimulated) {
  jobs::SweepRow row;
  row.counts = {0, 2, 10, 0, 0};
  const jobs::RunningCost running{.simulated_s = 60.0, .elapsed_s = 20.0, .id = "", .part_done = 1.0 / 3.0};
  row.costs["rigid"] = {.running = {running, running}, .computed = 10, .computed_s = 2.0, .wall_time_s = 4.0,
                        .rates = 20.0, .rate_squares = 40.0};
  EXPECT_NEAR(jobs::estimate_time_left(row, 2)->expected_s, 40.0 * 44.0 / 42.0, 1e-9);
}

TEST(TimeLeft, IsNotLessThanWhatARunningJobIsLate) {
  jobs::SweepRow row;
  row.counts = {0, 1, 4, 0, 0};
  row.costs["rigid"] = {.running = {{.elapsed_s = 35.0}}, .computed = 4, .computed_s = 4.0, .wall_time_s = 20.0, .rates = 20.0, .rate_squares = 100.0};
  EXPECT_DOUBLE_EQ(jobs::estimate_time_left(row, 2)->expected_s, 30.0) << "5 s were expected, 35 s have passed";
}

std::vector<std::shared_ptr<const jobs::RivalSweep>> shared(const std::vector<jobs::RivalSweep>& rivals) {
  std::vector<std::shared_ptr<const jobs::RivalSweep>> pointers;
  for (const jobs::RivalSweep& rival : rivals) pointers.push_back(std::make_shared<jobs::RivalSweep>(rival));
  return pointers;
}

/// Jobs that wait, of which five others have cost so much each.
jobs::Costs waiting(std::int64_t count, double each_s) {
  const auto n = static_cast<double>(count);
  return {{"rigid", {.queued = count, .queued_s = n, .queued_squares_s2 = n, .longest_queued_s = 1.0,
                     .computed = 5, .computed_s = 5.0, .wall_time_s = 5.0 * each_s, .rates = 5.0 * each_s,
                     .rate_squares = 5.0 * each_s * each_s}}};
}

// One thread, 10 jobs of 3 s. Before the last of them come 5 of 10 s of a higher priority, 10 of 40 jobs of
// 2 s with which they take turns, all 4 of a shorter sweep, and what a running job of a lower priority needs:
// 2 of 6 s.
TEST(TimeLeft, CountsTheSweepsThatComeBefore) {
  jobs::SweepRow row;
  row.priority = 1;
  row.counts = {10, 0, 5, 0, 0};
  row.costs = waiting(10, 3.0);
  EXPECT_DOUBLE_EQ(jobs::estimate_time_left(row, 1)->expected_s, 30.0);
  std::vector<jobs::RivalSweep> rivals{{.priority = 2, .costs = waiting(5, 10.0)},
                                       {.priority = 1, .costs = waiting(40, 2.0)},
                                       {.priority = 1, .costs = waiting(4, 2.0)},
                                       {.priority = 0, .costs = waiting(100, 6.0)}};
  rivals[3].costs["rigid"].running = {{.elapsed_s = 4.0}};
  row.rivals = shared(rivals);
  EXPECT_DOUBLE_EQ(jobs::estimate_time_left(row, 1)->expected_s, 30.0 + 50.0 + 20.0 + 8.0 + 2.0);
  EXPECT_DOUBLE_EQ(jobs::estimate_time_left(row, 4)->expected_s, 110.0 / 4.0);
  rivals[0].executor = "slurm";
  rivals[1].executor = "local";
  row.rivals = shared(rivals);
  EXPECT_DOUBLE_EQ(jobs::estimate_time_left(row, 1, "local")->expected_s, 60.0)
      << "a cluster takes no thread";
  auto& own = row.costs["rigid"];
  own.running = {{.elapsed_s = 1.0}};
  own.queued = 0;
  own.queued_s = own.queued_squares_s2 = own.longest_queued_s = 0.0;
  EXPECT_DOUBLE_EQ(jobs::estimate_time_left(row, 1, "local")->expected_s, 2.0) << "its last job has begun";
}

TEST(TimeLeft, CountsARivalThatStandsForOthersAsAllOfThem) {
  jobs::SweepRow row;
  row.counts = {10, 0, 5, 0, 0};
  row.costs = waiting(10, 3.0);
  row.rivals = shared({30, {.costs = waiting(4, 2.0)}});
  const auto each = jobs::estimate_time_left(row, 2).value();
  row.rivals = shared({3, {.costs = waiting(4, 2.0), .weight = 10.0}});
  const auto sample = jobs::estimate_time_left(row, 2).value();
  EXPECT_DOUBLE_EQ(sample.expected_s, each.expected_s);
  EXPECT_DOUBLE_EQ(sample.high_s, each.high_s);
}

// A sweep of which nothing has been computed, behind one of another simulated time.
TEST(TimeLeft, TakesTheUsualCostOfAKindBeforeItIsKnown) {
  jobs::SweepRow row;
  row.counts = {2, 0, 0, 0, 0};
  row.costs["rigid"] = {.queued = 2, .queued_s = 2.0, .queued_squares_s2 = 2.0, .longest_queued_s = 1.0};
  row.unit_s = 4.0;
  EXPECT_FALSE(jobs::estimate_time_left(row, 1).has_value());
  row.cost_rates["rigid"] = 0.5;
  EXPECT_DOUBLE_EQ(jobs::estimate_time_left(row, 1)->expected_s, 2.0 * 4.0 * 0.5);
  EXPECT_EQ(jobs::estimate_time_left(row, 1)->low_s, 0.0) << "it is hardly known";
  row.rivals = shared({{.unit_s = 10.0, .costs = row.costs}});
  EXPECT_DOUBLE_EQ(jobs::estimate_time_left(row, 1)->expected_s, 4.0 + 10.0);
}

}  // namespace
}  // namespace jobs_tests
