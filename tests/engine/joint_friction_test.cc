// SPDX-License-Identifier: Apache-2.0
// Dry friction in joints without play, under a given normal force or by what they bear.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/dynamics/motion_system.h"
#include "tests/engine/linkage_cases.h"
#include "tests/engine/linkage_run.h"

namespace engine {
namespace {

constexpr double kInclineGravity = 9.81;

/// LuGre's law with the values of the article that introduced it, but for the viscous part.
FrictionParameters published_law() {
  return {.mu_s = 1.5, .mu_k = 1.0, .sigma_0 = 1e5, .sigma_1 = std::sqrt(1e5), .sigma_2 = 0.0, .v_s = 1e-3};
}

/// 2 kg on an incline, with the normal force that its weight gives.
Linkage make_incline(double angle, const FrictionParameters& law, double velocity) {
  constexpr double kInclineMass = 2.0;
  Linkage linkage;
  linkage.gravity_W = kInclineGravity * Eigen::Vector3d(std::sin(angle), -std::cos(angle), 0.0);  // x down the incline
  linkage.bodies = {make_body("block", kInclineMass, {0.0, 0.0, 0.0}, {1e-3, 1e-3, 1e-3})};
  linkage.joints = {{.name = "slide", .kind = JointKind::kPrismatic, .from = kGroundName, .to = "block", .placement = {}, .axes = {Axis::kX, Axis::kY},
                     .freedoms = {{.name = "q", .start = 0.0, .start_rate = velocity,
                                   .friction = JointFriction{law, kInclineMass * kInclineGravity * std::cos(angle)}}}}};
  return linkage;
}

TEST(JointFriction, LetsABlockSlideDownAsCoulombSays) {
  FrictionParameters coulomb{.mu_k = 0.3, .law = FrictionLaw::kCoulomb, .v_0 = 1e-6};
  FrictionParameters lugre = published_law();
  lugre.mu_s = 0.4;
  lugre.mu_k = 0.3;
  lugre.sigma_1 = 0.0;  // a bristle that is not bent at 1 m/s would brake by its damping
  for (const FrictionParameters& law : {coulomb, lugre}) {
    const double angle = 0.6, acceleration = kInclineGravity * (std::sin(angle) - 0.3 * std::cos(angle));
    const LinkageRun run(make_incline(angle, law, 1.0), accurate(1.0));
    EXPECT_NEAR(run.last("q_m_s"), 1.0 + acceleration, 2e-5);  // LuGre: until the bristle is bent, 3e-6 m
    EXPECT_NEAR(run.last("q_friction_n"), -0.3 * 2.0 * kInclineGravity * std::cos(angle), 1e-4);  // a bristle of 3e-6 m, known to 1e-10 m
    EXPECT_NEAR(run.metric("friction_work_j"), 0.3 * 2.0 * kInclineGravity * std::cos(angle) * run.last("q_m"), 1e-3);
    EXPECT_LT(run.metric("energy_residual"), 1e-8);
  }
}

TEST(JointFriction, HoldsABlockBelowTheAngleOfFriction) {
  const double angle = 0.3;
  FrictionParameters lugre = published_law();
  lugre.mu_s = 0.5;
  lugre.mu_k = 0.4;
  const LinkageRun run(make_incline(angle, lugre, 0.0), accurate(2.0));
  EXPECT_NEAR(run.last("q_m_s"), 0.0, 1e-9);
  EXPECT_LT(run.last("q_m"), 1e-5);
  EXPECT_NEAR(run.last("q_friction_n"), -2.0 * kInclineGravity * std::sin(angle), 1e-6);
}

// 1 kg under 1 N, pulled by a spring of 2 N/m whose end moves at 0.1 m/s: where it is after 25 s, by a program of its own for this experiment
// (the law for one direction, 80-bit numbers, Fehlberg 7(8) at 1e-15).
TEST(JointFriction, SticksAndSlipsAsPublished) {
  FrictionParameters law = published_law();
  law.sigma_2 = 0.4;
  Linkage linkage;
  linkage.bodies = {make_body("block", 1.0, {0.0, 0.0, 0.0}, {1e-3, 1e-3, 1e-3}), make_body("carriage", 1.0, {0.0, 0.0, 0.0}, {1e-3, 1e-3, 1e-3})};
  const auto slide = [](const char* body, LinkageFreedom freedom) {
    return LinkageJoint{.name = body, .kind = JointKind::kPrismatic, .from = kGroundName, .to = body, .placement = {}, .axes = {Axis::kX, Axis::kY},
                        .freedoms = {std::move(freedom)}};
  };
  linkage.joints = {slide("block", {.name = "block", .friction = JointFriction{law, 1.0}}),
                    slide("carriage", {.name = "carriage", .drive = Polynomial{{10.0, 0.1}}})};
  linkage.springs = {{.name = "pull", .from = "block", .to = "carriage", .stiffness = 2.0, .free_length = 10.0}};
  RunOptions options = accurate(25.0);
  options.absolute_tolerance = 1e-13;
  options.step_limit = 1'000'000;
  const LinkageRun run(linkage, options);
  EXPECT_NEAR(run.last("block_m"), 1.9088391992, 1e-9);
  const std::vector<double>& v = run.column("block_m_s");
  EXPECT_GT(std::count_if(v.begin(), v.end(), [](double each) { return std::abs(each) < 1e-4; }), 1000);  // it sticks for most of the time
  options.integrator = Integrator::kRadau5;
  EXPECT_NEAR(LinkageRun(linkage, options).last("block_m"), 1.9088391992, 1e-6);
}

// 1 kg on a belt that moves at 0.1 m/s, held by a spring. Friction falls with the velocity, so that rest is unstable: the vibration grows until
// the block sticks for a part of each period. Its range of velocities is then somewhat more than twice that of the belt, at any stiffness.
TEST(JointFriction, ExcitesVibrationsHoweverFastTheyAre) {
  const FrictionParameters law{.mu_s = 0.4, .mu_k = 0.2, .sigma_0 = 1e5, .sigma_1 = 1.0, .sigma_2 = 0.0, .v_s = 0.1};
  for (const double hz : {100.0, 300.0, 600.0}) {
    const double stiffness = std::pow(2.0 * std::numbers::pi * hz, 2);
    Linkage linkage;
    linkage.bodies = {make_body("belt", 1.0, {0.0, 0.0, 0.0}, {1e-3, 1e-3, 1e-3}), make_body("block", 1.0, {0.0, 0.0, 0.0}, {1e-3, 1e-3, 1e-3})};
    linkage.joints = {{.name = "belt", .kind = JointKind::kPrismatic, .from = kGroundName, .to = "belt", .placement = {}, .axes = {Axis::kX, Axis::kY},
                       .freedoms = {{.name = "belt", .drive = Polynomial{{0.0, 0.1}}}}},
                      {.name = "block", .kind = JointKind::kPrismatic, .from = "belt", .to = "block", .placement = {}, .axes = {Axis::kX, Axis::kY},
                       .freedoms = {{.name = "block", .start = 0.0, .start_rate = -0.1, .friction = JointFriction{law, 10.0}}}}};
    linkage.springs = {{.name = "stay", .from = kGroundName, .to = "block", .at = {-1.0, 0.0, 0.0}, .stiffness = stiffness, .free_length = 1.0}};
    const LinkageRun run(linkage, {.duration = 3.0, .output_rate = 1e4});
    const std::vector<double>& v = run.column("block_m_s");
    const auto [least, most] = std::minmax_element(v.end() - 1000, v.end());
    EXPECT_NEAR(*most - *least, 0.215, 0.015) << hz;
  }
}

// A pin of radius r turns against r mu N: a flywheel runs out in a time that the torque tells.
TEST(JointFriction, OfAPinStopsAFlywheel) {
  Linkage linkage;
  linkage.bodies = {make_body("wheel", 3.0, {0.0, 0.0, 0.0}, {0.05, 0.05, 0.05})};
  const FrictionParameters law{.mu_k = 0.2, .law = FrictionLaw::kCoulomb, .v_0 = 1e-6};
  linkage.joints = {{.name = "pin", .from = kGroundName, .to = "wheel", .placement = {},
                     .freedoms = {{.name = "q", .start = 0.0, .start_rate = 10.0, .friction = JointFriction{law, 100.0, 0.01}}}}};
  const LinkageRun run(linkage, accurate(1.0));
  EXPECT_NEAR(run.last("q_rad_s"), 10.0 - 0.2 * 100.0 * 0.01 / 0.05, 1e-7);
  EXPECT_NEAR(run.last("q_friction_n_m"), -0.2, 1e-9);
}

// A pin with a preload under the weight of a wheel across it.
TEST(ReactionFriction, AddsTheReactionToThePreload) {
  Linkage linkage;
  linkage.gravity_W = {0.0, -10.0, 0.0};
  linkage.bodies = {make_body("wheel", 3.0, {0.0, 0.0, 0.0}, {0.05, 0.05, 0.05})};
  const FrictionParameters law{.mu_k = 0.2, .law = FrictionLaw::kCoulomb, .v_0 = 1e-6};
  linkage.joints = {{.name = "pin", .from = kGroundName, .to = "wheel", .placement = {},
                     .freedoms = {{.name = "q", .start = 0.0, .start_rate = 10.0,
                                   .friction = JointFriction{.law = law, .normal_force = 70.0, .radius = 0.01, .by_reaction = true}}}}};
  for (const Integrator integrator : {Integrator::kDopri5, Integrator::kRadau5, Integrator::kRodas5, Integrator::kRk4}) {
    RunOptions options = accurate(1.0);
    options.integrator = integrator;
    const LinkageRun run(linkage, options);
    EXPECT_NEAR(run.last("q_normal_force_n"), 100.0, 1e-9);
    EXPECT_NEAR(run.last("q_rad_s"), 10.0 - 0.2 * 100.0 * 0.01 / 0.05, 1e-7);
  }
}

// A piston bears nothing along its slide: a push there presses no surface.
TEST(ReactionFriction, TakesNoPushAlongAnotherFreedomOfItsJoint) {
  Linkage linkage;
  linkage.gravity_W = {0.0, -10.0, 0.0};
  linkage.bodies = {make_body("piston", 2.0, {0.0, 0.0, 0.0}, {0.05, 0.05, 0.05})};
  const FrictionParameters law{.mu_k = 0.2, .law = FrictionLaw::kCoulomb, .v_0 = 1e-6};
  linkage.joints = {{.name = "bore", .kind = JointKind::kCylindrical, .from = kGroundName, .to = "piston", .placement = {},
                     .freedoms = {{.name = "slide", .start = 0.0, .load = ForceLaw{.law = Constant{100.0}}},
                                  {.name = "turn", .start = 0.0, .start_rate = 10.0,
                                   .friction = JointFriction{.law = law, .radius = 0.01, .by_reaction = true}}}}};
  EXPECT_NEAR(LinkageRun(linkage, accurate(0.2)).last("turn_normal_force_n"), 20.0, 1e-9);
}

// A pin bears what its slider is driven by, also if the slider has no mass.
TEST(ReactionFriction, TellsAJointFromTheOneBeforeAMasslessBody) {
  const auto find_normal_forces = [](double mass) {
    Linkage linkage;
    linkage.bodies = {make_body("slider", mass, {0.0, 0.0, 0.0}, mass * Eigen::Vector3d::Ones()),
                      make_body("bob", 1.0, {0.0, 0.0, 0.0}, {1e-2, 1e-2, 1e-2})};
    const FrictionParameters law{.mu_k = 0.2, .law = FrictionLaw::kCoulomb, .v_0 = 1e-6};
    linkage.joints = {{.name = "guide", .kind = JointKind::kPrismatic, .from = kGroundName, .to = "slider", .placement = {},
                       .axes = {Axis::kX, Axis::kY}, .freedoms = {{.name = "x", .drive = Harmonic{.amplitude = 0.1, .omega = 12.0}}}},
                      {.name = "pin", .from = "slider", .to = "bob", .placement = {},
                       .freedoms = {{.name = "turn", .start = 0.0, .start_rate = 10.0,
                                     .friction = JointFriction{.law = law, .radius = 0.01, .by_reaction = true}}}}};
    return LinkageRun(linkage, accurate(0.2)).column("turn_normal_force_n");
  };
  const std::vector<double> without = find_normal_forces(0.0), with_little = find_normal_forces(1e-6);
  EXPECT_GT(std::ranges::max(without), 14.0);
  ASSERT_EQ(without.size(), with_little.size());
  for (std::size_t k = 0; k < without.size(); ++k) EXPECT_NEAR(without[k], with_little[k], 1e-3);
}

// The plate lies a metre beside the origin; its bearing moves with it.
TEST(ReactionFriction, HasTheMiddleOfABearingOnTheSecondBody) {
  Linkage linkage;
  linkage.gravity_W = {0.0, 0.0, -10.0};
  linkage.bodies = {make_body("plate", 2.0, {0.0, 0.0, 0.0}, {0.05, 0.05, 0.05})};
  const FrictionParameters law{.mu_k = 0.2, .law = FrictionLaw::kCoulomb, .v_0 = 1e-6};
  linkage.joints = {{.name = "table", .kind = JointKind::kPlanar, .from = kGroundName, .to = "plate", .placement = {},
                     .freedoms = {{.name = "x", .start = 0.0, .start_rate = 1.0, .load = ForceLaw{.law = Constant{10.0}},
                                   .friction = JointFriction{.law = law, .by_reaction = true, .length = 0.1}},
                                  {.name = "y", .start = 1.0}, {.name = "turn", .start = 0.0}}}};
  const LinkageRun run(linkage, accurate(0.1));
  EXPECT_NEAR(run.last("x_normal_force_n"), 20.0, 1e-8);
  EXPECT_NEAR(run.last("x_m_s"), 1.0 + 0.1 * (10.0 - 0.2 * 20.0) / 2.0, 1e-8);
}

// Bristles of 1e5 1/m are bent by 2.5 um, less than the absolute tolerance of lengths.
TEST(JointFriction, OfStiffBristlesIsRightBetweenSteps) {
  Linkage linkage = make_incline(0.0, {.mu_s = 0.25, .mu_k = 0.25, .sigma_0 = 1e5, .sigma_1 = 5.0}, 0.0);
  linkage.joints[0].freedoms[0].load = ForceLaw{.law = Harmonic{.mean = 0.0, .amplitude = 20.0, .omega = 30.0}};
  const LinkageRun run(linkage, {.duration = 1.0, .output_rate = 5000.0});
  const double most = 0.25 * 2.0 * kInclineGravity;
  for (const double friction : run.column("q_friction_n")) ASSERT_LT(std::abs(friction), 1.02 * most);
}

/// A drawer of 2 kg in a guide of 0.2 m, its centre of mass 0.3 m beside it, pushed by 10 N.
Linkage make_drawer(double velocity) {
  Linkage linkage;
  linkage.bodies = {make_body("drawer", 2.0, {0.0, 0.3, 0.0}, {1e-2, 1e-2, 1e-2})};
  linkage.joints = {{.name = "guide", .kind = JointKind::kPrismatic, .from = kGroundName, .to = "drawer", .placement = {}, .axes = {Axis::kX, Axis::kY},
                     .freedoms = {{.name = "q", .start = 0.0, .start_rate = velocity,
                                   .load = ForceLaw{.law = Constant{10.0}},
                                   .friction = JointFriction{.law = {.mu_k = 0.5, .law = FrictionLaw::kCoulomb, .v_0 = 1e-6},
                                                             .by_reaction = true, .length = 0.2}}}}};
  return linkage;
}

RunResult push_drawer(double velocity) {
  return simulate_linkage(make_drawer(velocity), accurate(0.1), 0.0, {});
}

// N = 2 h / L |F - mu N sign(v)|: with mu h / L = 0.75 the drawer moves on under 12 N, and against the push nothing fits.
// Under 60 N it would be in balance, too, and stop; but more force would then press it even harder.
TEST(ReactionFriction, IsTheOneOfSeveralThatSettles) {
  const LinkageRun run(make_drawer(1.0), accurate(0.1));
  EXPECT_NEAR(run.column("q_normal_force_n")[0], 12.0, 1e-8);
  EXPECT_NEAR(run.last("q_m_s"), 1.0 + 0.1 * (10.0 - 0.5 * 12.0) / 2.0, 1e-8);
}

TEST(ReactionFriction, EndsTheRunOfADrawerThatWedges) {
  const RunResult wedged = push_drawer(-1.0);
  EXPECT_EQ(wedged.status, RunStatus::kLockUp);
  EXPECT_NE(wedged.detail.find("wedges"), std::string::npos);
}

// A step that is tried and rejected may end where the drawer wedges.
TEST(ReactionFriction, IsNotThatOfAStateThatWedges) {
  const BuiltLinkage built = build_linkage(make_drawer(1.0));
  MotionSystem system(built.mechanism);
  Evaluation at = system.make_evaluation();
  const auto evaluate = [&](double velocity) {
    const Eigen::VectorXd y = system.make_state(Eigen::VectorXd::Zero(1), Eigen::VectorXd::Constant(1, velocity));
    Eigen::VectorXd dydt = Eigen::VectorXd::Zero(y.size());
    return system.calc_derivative(0.0, y, dydt, at);
  };
  for (const double velocity : {-1.0, -1e-2, -3e-6}) {
    ASSERT_EQ(evaluate(1.0), EvaluationStatus::kOk);
    EXPECT_NEAR(at.friction_reaction.maxCoeff(), 12.0, 1e-8);
    EXPECT_EQ(evaluate(velocity), EvaluationStatus::kWedged);
    ASSERT_EQ(evaluate(1.0), EvaluationStatus::kOk);
    EXPECT_NEAR(at.friction_reaction.maxCoeff(), 12.0, 1e-8) << "after " << velocity << " m/s";
  }
}

}  // namespace
}  // namespace engine
