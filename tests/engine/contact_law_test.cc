// The normal law's limits, its latch and LuGre friction. Rebounds, depths and times of whole impacts: engine/validation/contact.

#include <cmath>

#include <gtest/gtest.h>

#include "engine/clearance/friction.h"
#include "engine/clearance/normal_force.h"

namespace engine {
namespace {

TEST(NormalForce, IsNeverNegative) {
  EXPECT_DOUBLE_EQ(calc_normal_force(100.0, -10.0, 0.1, 0.2).total, 0.0);
  EXPECT_DOUBLE_EQ(calc_normal_force(100.0, -10.0, 0.1, 0.2).calc_loss_power(-10.0), 1000.0);  // what the spring gives is lost
}

TEST(OnsetLatch, ReadsTheRateWhereThePenetrationCrossesZero) {
  // delta(t) = -1 + 3 t - t^2 on [0, 1]: it is zero at t = (3 - sqrt 5) / 2, with the rate sqrt 5.
  OnsetLatch latch;
  EXPECT_TRUE(latch.advance({-1.0, 3.0}, {1.0, 1.0}, 1.0, 1e-3));
  EXPECT_NEAR(latch.onset_rate(99.0, 1e-3), std::sqrt(5.0), 1e-14);
}

TEST(OnsetLatch, KeepsItsRateUntilTheContactEnds) {
  OnsetLatch latch;
  EXPECT_DOUBLE_EQ(latch.onset_rate(0.5, 1e-3), 0.5);   // inside the step in which a contact begins
  EXPECT_DOUBLE_EQ(latch.onset_rate(-0.5, 1e-3), 1e-3);
  EXPECT_TRUE(latch.advance({-1e-6, 0.2}, {1e-6, 0.2}, 1e-5, 1e-3));
  EXPECT_FALSE(latch.advance({1e-6, 0.2}, {2e-6, -0.7}, 1e-5, 1e-3));
  EXPECT_NEAR(latch.onset_rate(-0.7, 1e-3), 0.2, 1e-12);
  EXPECT_TRUE(latch.advance({2e-6, -0.7}, {0.0, -0.7}, 1e-5, 1e-3));  // delta = 0 is no contact
  EXPECT_FALSE(latch.in_contact());
}

TEST(OnsetLatch, HasAFloor) {
  OnsetLatch latch;
  EXPECT_TRUE(latch.advance({-1e-12, 1e-6}, {1e-12, 1e-6}, 2e-6, 1e-3));
  EXPECT_DOUBLE_EQ(latch.onset_rate(0.0, 1e-3), 1e-3);
}

TEST(LuGre, SlidesWithStribecksCoefficient) {
  const LuGreParameters p{.mu_s = 0.1, .mu_k = 0.2, .sigma_0 = 100.0, .sigma_1 = 5.0, .sigma_2 = 0.3, .v_s = 1e-3};
  for (const double speed : {1e-4, 1e-3, 2e-3, 0.5}) {
    const Eigen::Vector2d v(0.6 * speed, -0.8 * speed);
    const double g = 0.2 - 0.1 * std::exp(-speed * speed / 1e-6);
    const BristleForce steady = calc_bristle_force(p, v, g / 100.0 * v / speed);
    EXPECT_LT(steady.bristle_rate.norm(), 1e-15 + 1e-14 * speed);
    EXPECT_NEAR(steady.force_ratio.norm(), g + 0.3 * speed, 1e-12);
    EXPECT_GT(steady.force_ratio.dot(v), 0.0);
  }
}

TEST(LuGre, ABristleAtRestIsASpring) {
  const LuGreParameters p{};
  const BristleForce f = calc_bristle_force(p, {0.0, 0.0}, {1e-4, -2e-4});
  EXPECT_NEAR(f.force_ratio.x(), 0.01, 1e-16);
  EXPECT_NEAR(f.force_ratio.y(), -0.02, 1e-16);
  EXPECT_EQ(f.bristle_rate.norm(), 0.0);
}

TEST(LuGre, LimitsTheBristleToTheStribeckForce) {
  const LuGreParameters p{};
  Eigen::Vector2d z(0.0, 0.0);
  const Eigen::Vector2d v(0.02, 0.0);
  for (int step = 0; step < 200'000; ++step) z += 1e-5 * calc_bristle_force(p, v, z).bristle_rate;
  // zd = v (1 - z sigma_0 / g): after 2 s, 20 time constants of g / (sigma_0 v) = 0.1 s, the bristle is at g / sigma_0.
  EXPECT_NEAR(z.x(), 0.2 / 100.0, 1e-9);
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
