// SPDX-License-Identifier: Apache-2.0
// Forces and moments on bodies, and the ground's acceleration, against closed forms.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/engine/linkage_cases.h"
#include "tests/engine/linkage_run.h"

namespace engine {
namespace {

constexpr double kBarLoadMass = 1.5, kBarLoadInertia = 0.02, kLoadArm = 0.4;  // about the pivot: kBarLoadInertia

/// A bar on a pivot about z, its centre of mass in the pivot.
Linkage make_bar() {
  Linkage linkage;
  linkage.bodies = {make_body("bar", kBarLoadMass, {0.0, 0.0, 0.0}, {kBarLoadInertia, kBarLoadInertia, kBarLoadInertia})};
  linkage.joints = {{.name = "pivot", .from = kGroundName, .to = "bar", .placement = {}, .freedoms = {{.name = "q", .start = 0.3}}}};
  return linkage;
}

Linkage make_sliding_block(double stiffness) {
  Linkage linkage;
  linkage.bodies = {make_body("block", kBarLoadMass, {0.1, 0.2, 0.0}, {0.1, 0.1, 0.1})};
  linkage.joints = {{.name = "slide", .kind = JointKind::kPrismatic, .from = kGroundName, .to = "block", .placement = {}, .axes = {Axis::kX, Axis::kY},
                     .freedoms = {{.name = "q", .start = 0.0, .stiffness = stiffness}}}};
  return linkage;
}

TEST(BodyLoads, AForceThatTurnsWithTheBodySpeedsItUpEvenly) {
  Linkage linkage = make_bar();
  linkage.loads = {{.name = "thrust", .body = "bar", .at = {kLoadArm, 0.0, 0.0}, .force = {0.0, 1.0, 0.0}, .follows_body = true, .law = Constant{0.5}}};
  for (const Integrator integrator : {Integrator::kDopri5, Integrator::kRadau5}) {
    RunOptions options = accurate(2.0);
    options.integrator = integrator;
    const LinkageRun run(linkage, options);
    EXPECT_NEAR(run.last("q_rad"), 0.3 + 0.5 * 0.5 * kLoadArm / kBarLoadInertia * 4.0, 1e-7);
    EXPECT_NEAR(run.last("drive_work_j"), run.last("kinetic_energy_j"), 1e-7);
    EXPECT_EQ(run.last("thrust_n"), 0.5);
  }
}

// The same force held in the ground's directions makes the bar a pendulum: its energy is that of the height of the point against the force.
TEST(BodyLoads, AForceThatDoesNotTurnMakesAPendulum) {
  Linkage linkage = make_bar();
  linkage.loads = {{.name = "pull", .body = "bar", .at = {kLoadArm, 0.0, 0.0}, .force = {1.0, 0.0, 0.0}, .law = Constant{2.0}}};
  const LinkageRun run(linkage, accurate(2.0));
  const double w = run.last("q_rad_s"), q = run.last("q_rad");
  EXPECT_GT(std::abs(run.metric("peak_q_acceleration_rad_s2")), 1.0);
  EXPECT_NEAR(0.5 * kBarLoadInertia * w * w, 2.0 * kLoadArm * (std::cos(q) - std::cos(0.3)), 1e-8);
  EXPECT_LT(run.metric("energy_residual"), 1e-8);
}

TEST(BodyLoads, AMomentActsAboutItsAxisAlone) {
  Linkage linkage = make_bar();
  linkage.loads = {{.name = "twist", .body = "bar", .moment = {0.6, 0.0, 0.8}, .law = Harmonic{.mean = 1.0, .amplitude = 0.5, .omega = 3.0}}};
  const LinkageRun run(linkage, accurate(2.0));
  EXPECT_NEAR(run.last("q_rad_s"), 0.8 / kBarLoadInertia * (2.0 + 0.5 / 3.0 * (1.0 - std::cos(6.0))), 1e-7);
  EXPECT_NEAR(run.last("pivot_moment_x_n_m"), -0.6 * (1.0 + 0.5 * std::sin(6.0)), 1e-8);  // the pivot bears the rest
}

TEST(BodyLoads, AJointBearsTheLoadAcrossItsSlide) {
  Linkage linkage = make_sliding_block(0.0);
  linkage.loads = {{.name = "press", .body = "block", .at = {0.1, 0.2, 0.0}, .force = {0.6, -0.8, 0.0},
                    .law = TableCurve({0.0, 1.0}, {0.0, 30.0}, TableInterpolation::kLinear)}};
  const LinkageRun run(linkage, accurate(1.0));
  EXPECT_NEAR(run.last("q_m_s"), 0.6 * 15.0 / kBarLoadMass, 1e-8);
  EXPECT_NEAR(run.last("slide_force_y_n"), 0.8 * 30.0, 1e-8);
}

// A shaken oscillator: x'' + w0^2 x = -a sin(w t), seen from the shaker.
TEST(BodyLoads, TheGroundShakesAnOscillator) {
  const double w0 = 9.0, w = 5.0, a = 4.0;
  Linkage linkage = make_sliding_block(kBarLoadMass * w0 * w0);
  linkage.ground_acceleration[0] = Harmonic{.mean = 0.0, .amplitude = a, .omega = w};
  linkage.ground_acceleration[1] = Constant{2.0};
  const LinkageRun run(linkage, accurate(2.0));
  const double expected = -a / (w0 * w0 - w * w) * (std::sin(2.0 * w) - w / w0 * std::sin(2.0 * w0));
  EXPECT_NEAR(run.last("q_m"), expected, 1e-8);
  EXPECT_NEAR(run.last("slide_force_y_n"), kBarLoadMass * 2.0, 1e-8);
  EXPECT_LT(run.metric("energy_residual"), 1e-8);
}

// A steady acceleration of the ground is a gravity that leans back, in a spatial loop too.
TEST(BodyLoads, ASteadyAccelerationOfTheGroundIsAGravity) {
  Linkage leaning = make_spatial_slider_crank(JointKind::kSpherical);
  Linkage pushed = leaning;
  leaning.gravity_W -= Eigen::Vector3d(3.0, -2.0, 1.0);
  pushed.ground_acceleration = {Constant{3.0}, Constant{-2.0}, Constant{1.0}};
  const LinkageRun expected(leaning, accurate(1.0)), run(pushed, accurate(1.0));
  for (const char* const key : {"theta_rad", "theta_rad_s", "x_m", "slide_force_y_n"}) EXPECT_NEAR(run.last(key), expected.last(key), 1e-6) << key;
}

// Next to no work is done: the energy in motion is the scale.
TEST(EnergyResidual, IsMeasuredAgainstTheEnergyInMotionWhereItIsTheLarger) {
  Linkage linkage = make_bar();
  linkage.joints[0].freedoms[0].start_rate = 5.0;
  for (const double damping : {0.0, 1e-12, 1e-9}) {
    linkage.joints[0].freedoms[0].damping = damping;
    EXPECT_LT(LinkageRun(linkage, {.duration = 1.0}).metric("energy_residual"), 1e-6) << damping;
  }
}

}  // namespace
}  // namespace engine
