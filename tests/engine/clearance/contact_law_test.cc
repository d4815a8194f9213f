// SPDX-License-Identifier: Apache-2.0
// The normal law's limits and its latch. Rebounds, depths and times of whole impacts: validation/contact; friction: validation/friction.

#include <cmath>

#include <gtest/gtest.h>

#include "engine/clearance/contact_law.h"
#include "engine/clearance/normal_force.h"

namespace engine {
namespace {

TEST(NormalForce, IsNeverNegative) {
  EXPECT_DOUBLE_EQ(calc_normal_force(100.0, -10.0, 0.1, 0.2, 0.0).total, 0.0);
  EXPECT_DOUBLE_EQ(calc_normal_force(100.0, -10.0, 0.1, 0.2, 0.0).loss_power, 1000.0);  // what the spring gives is lost
}

TEST(OnsetLatch, ReadsTheRateWhereThePenetrationCrossesZero) {
  // delta(t) = -1 + 3 t - t^2 on [0, 1]: it is zero at t = (3 - sqrt 5) / 2, with the rate sqrt 5.
  OnsetLatch latch;
  EXPECT_TRUE(latch.advance({-1.0, 3.0}, {1.0, 1.0}, 1.0, 1e-3));
  EXPECT_NEAR(choose_onset_rate(latch.rate(), 99.0, 1e-3), std::sqrt(5.0), 1e-14);
}

TEST(OnsetLatch, KeepsItsRateUntilTheContactEnds) {
  OnsetLatch latch;
  EXPECT_DOUBLE_EQ(choose_onset_rate(latch.rate(), 0.5, 1e-3), 0.5);   // inside the step in which a contact begins
  EXPECT_DOUBLE_EQ(choose_onset_rate(latch.rate(), -0.5, 1e-3), 1e-3);
  EXPECT_TRUE(latch.advance({-1e-6, 0.2}, {1e-6, 0.2}, 1e-5, 1e-3));
  EXPECT_FALSE(latch.advance({1e-6, 0.2}, {2e-6, -0.7}, 1e-5, 1e-3));
  EXPECT_NEAR(choose_onset_rate(latch.rate(), -0.7, 1e-3), 0.2, 1e-12);
  EXPECT_TRUE(latch.advance({2e-6, -0.7}, {0.0, -0.7}, 1e-5, 1e-3));  // delta = 0 is no contact
  EXPECT_FALSE(latch.in_contact());
}

TEST(OnsetLatch, HasAFloor) {
  OnsetLatch latch;
  EXPECT_TRUE(latch.advance({-1e-12, 1e-6}, {1e-12, 1e-6}, 2e-6, 1e-3));
  EXPECT_DOUBLE_EQ(choose_onset_rate(latch.rate(), 0.0, 1e-3), 1e-3);
}

TEST(PenetrationCubic, FindsRootAndTurn) {
  // delta(t) = (t - 0.25)(0.75 - t) over one second: in at 0.25, out at 0.75, turn at 0.5
  const PenetrationCubic cubic({-0.1875, 1.0}, {-0.1875, -1.0}, 1.0);
  EXPECT_NEAR(cubic.find_extreme(), 0.5, 1e-14);
  EXPECT_NEAR(cubic.find_root(0.0, 0.5), 0.25, 1e-14);
  EXPECT_NEAR(cubic.find_root(0.5, 1.0), 0.75, 1e-14);
}

}  // namespace
}  // namespace engine
