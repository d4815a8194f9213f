// SPDX-License-Identifier: Apache-2.0
#include "engine/integrate/pace_check.h"

#include <gtest/gtest.h>

namespace engine {
namespace {

/// Steps after which a run of 1 s is found to be hopeless; 0: it ends.
/// @param pace   in the first half of the run, [steps/s]
/// @param later  in the second half, [steps/s]
long find_end(long pace, long later) {
  PaceCheck check(1.0, 100'000, 1000);
  long steps = 0;
  for (double t = 0.0; t < 1.0; t += 1.0 / static_cast<double>(t < 0.5 ? pace : later))
    if (check.is_hopeless(++steps, t)) return steps;
  return 0;
}

TEST(PaceCheck, FindsRunsThatCrawl) {
  EXPECT_EQ(find_end(1'000'000, 1'000'000), 3000);
  EXPECT_EQ(find_end(105'000, 105'000), 3000);
}

TEST(PaceCheck, LetsRunsEndThatCan) {
  EXPECT_EQ(find_end(95'000, 95'000), 0);
  EXPECT_EQ(find_end(1000, 190'000), 0) << "half a run, at nearly twice the pace of a whole one";
}

TEST(PaceCheck, ForgivesASlowStretch) {
  PaceCheck check(1.0, 100'000, 1000);
  double t = 0.0;
  for (long steps = 1; steps <= 20'000; ++steps) {
    t += steps / 1000 % 3 == 2 ? 1e-7 : 2e-5;  // two slow stretches, then one that is not
    ASSERT_FALSE(check.is_hopeless(steps, t)) << steps;
  }
}

}  // namespace
}  // namespace engine
