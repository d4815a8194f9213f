#include "engine/model/drive_law.h"

#include <cmath>

#include <gtest/gtest.h>

namespace engine {
namespace {

// The drives' features as the paper's Fig. 4 shows them.
TEST(RunUpLaw, ReachesItsVelocityWhenItSays) {
  const RunUp law{10.0, 2.0};
  EXPECT_DOUBLE_EQ(calc_driven_motion(law, 0.0).qd, 0.0);
  EXPECT_DOUBLE_EQ(calc_driven_motion(law, 1.0).qd, 5.0);
  EXPECT_DOUBLE_EQ(calc_driven_motion(law, 2.0).qd, 10.0);
  EXPECT_DOUBLE_EQ(calc_driven_motion(law, 3.0).q, 10.0 + 10.0);  // half the angle of full speed in the run-up
}

TEST(RunUpLaw, WithoutRunUpRunsAtOnce) {
  EXPECT_DOUBLE_EQ(calc_driven_motion(RunUp{10.0, 0.0}, 0.0).qd, 10.0);
  EXPECT_DOUBLE_EQ(calc_driven_motion(RunUp{10.0, 0.0}, 0.5).q, 5.0);
}

TEST(RiseReturnPauseLaw, RisesReturnsAndWaits) {
  const RiseReturnPause law{0.05, 0.5, 0.5};
  EXPECT_NEAR(calc_driven_motion(law, 0.25).q, 0.025, 1e-17);
  EXPECT_NEAR(calc_driven_motion(law, 0.5).q, 0.05, 1e-17);
  EXPECT_NEAR(calc_driven_motion(law, 0.75).q, 0.025, 1e-17);
  EXPECT_DOUBLE_EQ(calc_driven_motion(law, 1.2).q, 0.0);
  EXPECT_DOUBLE_EQ(calc_driven_motion(law, 1.2).qdd, 0.0);
  EXPECT_NEAR(calc_driven_motion(law, 1.75).q, 0.025, 1e-15);  // the second cycle
}

template <typename Law>
void expect_consistent_derivatives(const Law& law, double t) {
  constexpr double h = 1e-5;
  const DrivenMotion before = calc_driven_motion(law, t - h);
  const DrivenMotion at = calc_driven_motion(law, t);
  const DrivenMotion after = calc_driven_motion(law, t + h);
  // Central differences: h^2 / 6 times a third derivative of at most 2e2 in these laws, and rounding.
  EXPECT_NEAR((after.q - before.q) / (2.0 * h), at.qd, 1e-8) << t;
  EXPECT_NEAR((after.qd - before.qd) / (2.0 * h), at.qdd, 1e-8 + 1e-7 * std::abs(at.qdd)) << t;
}

TEST(DriveLaws, VelocityAndAccelerationAreTheDerivatives) {
  for (double t = 0.013; t < 4.0; t += 0.0371) {
    expect_consistent_derivatives(RunUp{12.0, 2.0}, t);
    expect_consistent_derivatives(RiseReturnPause{0.05, 0.5, 0.5}, t);
  }
}

}  // namespace
}  // namespace engine
