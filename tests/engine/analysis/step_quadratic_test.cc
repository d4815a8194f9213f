// SPDX-License-Identifier: Apache-2.0
#include "engine/analysis/step_quadratic.h"

#include <gtest/gtest.h>

namespace engine {
namespace {

// a(t) = 3 + 8 t - 20 t^2 over 0.5 s: dv = 1.5 + 1 - 20/24, turn at t = 0.2 with 3.8.
constexpr double kDt = 0.5;
StepQuadratic example() { return {3.0, 2.0, 1.5 + 1.0 - 20.0 / 24.0, kDt}; }

TEST(StepQuadratic, FindsThePeakBetweenTheEnds) {
  Peak peak;
  peak.take(example(), 0.0, 1.0, 7.0, kDt);
  EXPECT_NEAR(peak.magnitude, 3.8, 1e-14);
  EXPECT_NEAR(peak.t, 7.2, 1e-14);
}

TEST(StepQuadratic, LooksOnlyAtThePartAskedFor) {
  Peak peak;
  peak.take(example(), 0.5, 1.0, 7.0, kDt);  // from t = 0.25 on
  EXPECT_NEAR(peak.magnitude, 3.0 + 8.0 * 0.25 - 20.0 * 0.0625, 1e-14);
  EXPECT_NEAR(peak.t, 7.25, 1e-14);
}

TEST(StepQuadratic, IntegratesTheSquare) {
  // 9 t + 24 t^2 + (64 - 120) t^3 / 3 - 80 t^4 + 80 t^5 at t = 0.5
  EXPECT_NEAR(example().integrate_square(0.0, 1.0) * kDt, 4.5 + 6.0 - 56.0 / 24.0 - 5.0 + 2.5, 1e-13);
}

TEST(StepQuadratic, AStraightLineHasItsPeakAtAnEnd) {
  Peak peak;
  peak.take(StepQuadratic(1.0, -2.0, -0.25, kDt), 0.0, 1.0, 0.0, kDt);
  EXPECT_DOUBLE_EQ(peak.magnitude, 2.0);
  EXPECT_DOUBLE_EQ(peak.t, kDt);
}

}  // namespace
}  // namespace engine
