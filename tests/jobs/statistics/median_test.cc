// SPDX-License-Identifier: Apache-2.0
#include "jobs/statistics/median.h"

#include <gtest/gtest.h>

namespace jobs_tests {
namespace {

TEST(CalcMedian, IsTheMiddleValueOrTheMeanOfTheMiddleTwo) {
  EXPECT_EQ(jobs::calc_median({7.0}), 7.0);
  EXPECT_EQ(jobs::calc_median({5.0, 2.0}), 3.5);
  EXPECT_EQ(jobs::calc_median({1e9, -3.0, 4.0}), 4.0);
  EXPECT_EQ(jobs::calc_median({4.0, 1.0, 1e9, 2.0}), 3.0);
  EXPECT_EQ(jobs::calc_median({2.0, 2.0, 2.0, 1.0, 9.0}), 2.0);
}

}  // namespace
}  // namespace jobs_tests
