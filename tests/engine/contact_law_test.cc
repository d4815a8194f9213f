// The normal law, its latch and LuGre friction, each against a closed form.

#include <cmath>

#include <gtest/gtest.h>

#include "engine/clearance/clearance_parameters.h"
#include "engine/clearance/friction.h"
#include "engine/clearance/normal_force.h"

namespace engine {
namespace {

struct ReboundCase {
  const char* name;
  double k_r;
  double exponent;
  double rebound;  ///< published for Lankarani and Nikravesh's factor
};
void PrintTo(const ReboundCase& c, std::ostream* out) { *out << c.name; }

/// A mass of 1 kg meets the law at v0; classical RK4 in small steps, the latch moved on after each.
double simulate_rebound(const ReboundCase& c, double v0) {
  const double chi = calc_damping_factor(c.k_r);
  OnsetLatch latch;
  double x = -1e-9;
  double v = v0;
  const double dt = 2e-7;
  const auto acceleration = [&](double delta, double rate) {
    if (delta <= 0.0) return 0.0;
    return -calc_normal_force(1e9 * std::pow(delta, c.exponent), rate, latch.onset_rate(rate, 1e-3), chi).total;
  };
  for (int step = 0; step < 10'000'000; ++step) {
    const Penetration start{x, v};
    const double a1 = acceleration(x, v);
    const double a2 = acceleration(x + 0.5 * dt * v, v + 0.5 * dt * a1);
    const double a3 = acceleration(x + 0.5 * dt * v + 0.25 * dt * dt * a1, v + 0.5 * dt * a2);
    const double a4 = acceleration(x + dt * v + 0.5 * dt * dt * a2, v + dt * a3);
    x += dt * v + dt * dt / 6.0 * (a1 + a2 + a3);
    v += dt / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    const bool changed = latch.advance(start, {x, v}, dt, 1e-3);
    if (changed && !latch.in_contact()) break;
  }
  return -v / v0;
}

class Rebound : public testing::TestWithParam<ReboundCase> {};

// A mass that meets f = f_e (1 + c rate / v0) leaves at e v0 with  c (1 + e) = ln((1 + c) / (1 - c e)), whatever f_e.
TEST_P(Rebound, ObeysTheClosedForm) {
  const ReboundCase& c = GetParam();
  const double factor = 0.75 * (1.0 - c.k_r * c.k_r);
  const double e = simulate_rebound(c, 0.3);
  // RK4 with some thousand steps a contact; the parting step overshoots by less than 1e-6 of the velocity.
  EXPECT_NEAR(factor * (1.0 + e), std::log((1.0 + factor) / (1.0 - factor * e)), 1e-6);
  EXPECT_NEAR(e, c.rebound, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Laws, Rebound,
                         testing::Values(ReboundCase{"k_09_hertz", 0.9, 1.5, 0.9132}, ReboundCase{"k_05_hertz", 0.5, 1.5, 0.7252},
                                         ReboundCase{"k_03_linear", 0.3, 1.0, 0.6842}, ReboundCase{"k_09_linear", 0.9, 1.0, 0.9132}),
                         [](const auto& c) { return c.param.name; });

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

TEST(Hertz, StiffnessIsThePapersAtAQuarterMillimetre) {
  // MODEL: K = 4 / (3 pi 2 h) sqrt(r_b r_j / c_r) with h = (1 - nu^2) / (pi E): 4 E / (6 (1 - nu^2)) sqrt(...)
  const double expected = 4.0 * 2.1e11 / (6.0 * (1.0 - 0.3125 * 0.3125)) * std::sqrt(5e-3 * 4.75e-3 / 0.25e-3);
  EXPECT_NEAR(calc_hertz_stiffness(5e-3, 0.25e-3, 2.1e11, 0.3125), expected, 1e-12 * expected);
  EXPECT_NEAR(expected, 4.78e10, 0.01e10);
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
