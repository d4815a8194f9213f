// SPDX-License-Identifier: Apache-2.0
// Springs and dampers between points of two bodies, against closed forms.

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "engine/errors.h"
#include "tests/engine/linkage_cases.h"
#include "tests/engine/linkage_run.h"

namespace engine {
namespace {

LinkageJoint slide(const std::string& from, const std::string& to, double start) {
  return {.name = to, .kind = JointKind::kPrismatic, .from = from, .to = to, .placement = {}, .axes = {Axis::kX, Axis::kY},
          .freedoms = {{.name = to, .start = start}}};
}

/// A block of 2 kg on a slide along x.
Linkage make_block(double start) {
  Linkage linkage;
  linkage.bodies = {make_body("block", 2.0, {0.0, 0.0, 0.0}, {1e-3, 1e-3, 1e-3})};
  linkage.joints = {slide(kGroundName, "block", start)};
  return linkage;
}

// m x'' = -k (x - L_0) - d x': x = L_0 + a exp(-b t) (cos(w t) + b / w sin(w t)), b = d / (2 m), w^2 = k / m - b^2.
TEST(PointSpring, LetsABlockSwing) {
  Linkage linkage = make_block(0.4);
  linkage.springs = {{.name = "spring", .from = kGroundName, .to = "block", .stiffness = 800.0, .damping = 4.0, .free_length = 0.3}};
  for (const Integrator integrator : {Integrator::kDopri5, Integrator::kRadau5, Integrator::kRodas5, Integrator::kRk4}) {
    RunOptions options = accurate(1.0);
    options.integrator = integrator;
    options.step = 1e-4;
    const LinkageRun run(linkage, options);
    const double b = 1.0, w = std::sqrt(400.0 - 1.0);
    for (std::size_t k = 0; k < run.column("t_s").size(); ++k) {
      const double t = run.column("t_s")[k];
      const double x = 0.3 + 0.1 * std::exp(-b * t) * (std::cos(w * t) + b / w * std::sin(w * t));
      EXPECT_NEAR(run.column("block_m")[k], x, 2e-8) << t;
      EXPECT_NEAR(run.column("spring_length_m")[k], x, 2e-8) << t;
      EXPECT_NEAR(run.column("spring_tension_n")[k], 800.0 * (x - 0.3) + 4.0 * run.column("block_m_s")[k], 2e-4) << t;
    }
    // The damper has taken the initial energy of the spring, less the energy that is left at the end.
    const double left = 0.5 * 800.0 * std::pow(run.last("block_m") - 0.3, 2) + std::pow(run.last("block_m_s"), 2);
    EXPECT_NEAR(run.metric("structural_loss_j"), 4.0 - left, 1e-6);
    EXPECT_LT(run.metric("energy_imbalance_j"), 1e-6);
    EXPECT_NEAR(run.metric("peak_spring_tension_n"), 80.0, 1e-6);
  }
}

// Along a slide it is the same spring as one on the slide's coordinate.
TEST(PointSpring, DoesWhatASpringOnTheCoordinateDoes) {
  Linkage on_coordinate = make_block(0.1);
  on_coordinate.joints[0].freedoms[0].stiffness = 800.0;
  on_coordinate.joints[0].freedoms[0].damping = 4.0;
  Linkage between_points = make_block(0.1);
  between_points.springs = {{.name = "spring", .from = kGroundName, .to = "block", .at = {-0.5, 0.0, 0.0}, .stiffness = 800.0, .damping = 4.0,
                             .free_length = 0.5}};
  for (const Integrator integrator : {Integrator::kDopri5, Integrator::kRadau5, Integrator::kRodas5}) {
    RunOptions options = accurate(1.0);
    options.integrator = integrator;
    const LinkageRun one(on_coordinate, options), other(between_points, options);
    for (std::size_t k = 0; k < one.column("block_m").size(); ++k) {
      EXPECT_NEAR(one.column("block_m")[k], other.column("block_m")[k], 1e-12) << k;
      EXPECT_NEAR(one.column("potential_energy_j")[k], other.column("potential_energy_j")[k], 1e-11) << k;
    }
    EXPECT_NEAR(one.metric("structural_loss_j"), other.metric("structural_loss_j"), 1e-11);
    // By the same Jacobian: of a linear system, whose iteration converges at once but for rounding, which decides on a step here and there.
    EXPECT_NEAR(one.metric("steps"), other.metric("steps"), 0.05 * one.metric("steps"));
  }
}

TEST(PointSpring, IsUnloadedInTheAssembledPositionIfNothingIsSaid) {
  Linkage linkage = make_four_bar(JointKind::kRevolute);
  linkage.springs = {{.name = "tie", .from = kGroundName, .to = "lower", .at = {0.1, 0.5, 0.0}, .to_at = {0.2, 0.0, 0.0}, .stiffness = 100.0}};
  const LinkageRun run(linkage, accurate(0.2));
  EXPECT_NEAR(run.column("tie_tension_n").front(), 0.0, 1e-10);
  const double length = run.column("tie_length_m").front();
  EXPECT_GT(length, 0.1);
  EXPECT_NEAR(run.last("tie_tension_n"), 100.0 * (run.last("tie_length_m") - length), 1e-9);
}

// Two blocks on one line, the second carried by the first: their distance swings with w^2 = k (1 / m_1 + 1 / m_2), their middle stays.
TEST(PointSpring, PullsBothOfItsBodies) {
  Linkage linkage = make_block(0.0);
  linkage.bodies.push_back(make_body("other", 3.0, {0.0, 0.0, 0.0}, {1e-3, 1e-3, 1e-3}));
  linkage.joints.push_back(slide("block", "other", 0.5));
  linkage.springs = {{.name = "spring", .from = "other", .to = "block", .stiffness = 600.0, .free_length = 0.4}};
  const LinkageRun run(linkage, accurate(1.0));
  const double w = std::sqrt(600.0 * (1.0 / 2.0 + 1.0 / 3.0));
  EXPECT_NEAR(run.last("other_m"), 0.4 + 0.1 * std::cos(w), 1e-8);
  EXPECT_NEAR(2.0 * run.last("block_m") + 3.0 * (run.last("block_m") + run.last("other_m")), 1.5, 1e-8);
}

// Across the slide: along it m x'' = -T x / L, across it the slide bears T h / L, and the moment of the force's arm.
TEST(PointSpring, LoadsTheJointsThatHoldItsBodies) {
  Linkage linkage = make_block(0.3);
  constexpr double kArm = 0.05;
  linkage.springs = {{.name = "spring", .from = "block", .to = kGroundName, .at = {0.0, kArm, 0.0}, .to_at = {0.0, 0.4 + kArm, 0.0},
                      .stiffness = 100.0, .free_length = 0.2}};
  const LinkageRun run(linkage, accurate(0.1));
  const double tension = 100.0 * (0.5 - 0.2);
  EXPECT_NEAR(run.column("spring_length_m").front(), 0.5, 1e-12);
  EXPECT_NEAR(run.column("block_m_s2").front(), -tension * 0.6 / 2.0, 1e-9);
  EXPECT_NEAR(run.column("block_force_y_n").front(), -tension * 0.8, 1e-9);
  EXPECT_NEAR(run.column("block_moment_z_n_m").front(), -tension * 0.6 * kArm, 1e-9);  // against the force along -x at y = arm
}

// A crank that turns evenly, all by itself, under a spring from its tip to the ground: the drive bears dV/dpsi, and the damper's part of it.
TEST(PointSpring, IsFeltByADrive) {
  constexpr double kRadius = 0.2, kAnchor = 0.5, kRate = 3.0;
  Linkage linkage;
  linkage.bodies = {make_body("crank", 1.0, {0.0, 0.0, 0.0}, {1e-2, 1e-2, 1e-2})};
  linkage.joints = {{.name = "crank", .from = kGroundName, .to = "crank", .placement = {},
                     .freedoms = {{.name = "crank", .drive = Polynomial{{0.4, kRate}}}}}};
  linkage.springs = {{.name = "spring", .from = kGroundName, .to = "crank", .at = {kAnchor, 0.0, 0.0}, .to_at = {kRadius, 0.0, 0.0},
                      .stiffness = 50.0, .damping = 2.0, .free_length = 0.1}};
  for (const Integrator integrator : {Integrator::kDopri5, Integrator::kRadau5, Integrator::kRodas5, Integrator::kRk4}) {
    RunOptions options = accurate(1.0);
    options.integrator = integrator;
    options.step = 1e-3;
    const LinkageRun run(linkage, options);
    for (std::size_t k = 0; k < run.column("t_s").size(); ++k) {
      const double psi = run.column("crank_rad")[k];
      const double length = std::sqrt(kAnchor * kAnchor + kRadius * kRadius - 2.0 * kAnchor * kRadius * std::cos(psi));
      const double by_angle = kAnchor * kRadius * std::sin(psi) / length;
      EXPECT_NEAR(run.column("crank_drive_n_m")[k], (50.0 * (length - 0.1) + 2.0 * by_angle * kRate) * by_angle, 1e-9) << k;
    }
    EXPECT_LT(run.metric("energy_imbalance_j"), 1e-8);
    EXPECT_GT(run.metric("structural_loss_j"), 0.1);
  }
}

// On bodies of a flexible beam and of a closed loop; implicit and explicit methods, drives by law and by multipliers.
TEST(PointSpring, KeepsTheEnergyAccountInALoop) {
  Linkage linkage = make_spatial_slider_crank(JointKind::kSpherical);
  linkage.springs = {{.name = "spring", .from = kGroundName, .to = "rod", .at = {0.1, -0.2, 0.3}, .to_at = {-0.1, 0.02, 0.01}, .stiffness = 300.0,
                      .damping = 2.0, .drag = 1.5, .free_length = 0.1},
                     {.name = "across", .from = "crank", .to = "slider", .at = {0.0, 0.0, 0.06}, .stiffness = 200.0}};
  const LinkageRun dopri5(linkage, accurate(0.5));
  EXPECT_LT(dopri5.metric("energy_imbalance_j"), 1e-7);
  EXPECT_GT(dopri5.metric("structural_loss_j"), 0.01);
  for (const Integrator integrator : {Integrator::kRadau5, Integrator::kRodas5}) {
    RunOptions options = accurate(0.5);
    options.integrator = integrator;
    const LinkageRun implicit(linkage, options);
    EXPECT_NEAR(implicit.last("theta_rad"), dopri5.last("theta_rad"), 1e-7);
    EXPECT_NEAR(implicit.last("spring_tension_n"), dopri5.last("spring_tension_n"), 1e-5);
  }
}

// The end of an elastic cantilever: F l^3 / (3 E I) of a weak spring's pull, less (1 / (4 n^2)) of it by the division into n segments.
TEST(PointSpring, BendsABeam) {
  Linkage linkage;
  const UniformBeam beam = make_beam({.length = 0.5, .mass = 0.3, .I_x = 4e-6, .diameter = 0.01, .youngs_modulus = 2.1e11, .shear_modulus = 0.8e11,
                                      .damping_ratio = 1.0});
  linkage.bodies = {{.name = "beam", .mass = 0.3, .beam = beam, .elements = 9}};
  linkage.joints = {{.name = "clamp", .kind = JointKind::kPrismatic, .from = kGroundName, .to = "beam", .placement = {}, .axes = {Axis::kX, Axis::kY},
                     .freedoms = {{.name = "clamp", .drive = Polynomial{{0.0}}}}}};
  linkage.springs = {{.name = "spring", .from = kGroundName, .to = "beam", .at = {0.5, 1.0, 0.0}, .to_at = {0.5, 0.0, 0.0}, .stiffness = 10.0,
                      .free_length = 0.5}};
  const LinkageRun run(linkage, {.duration = 2.0, .output_rate = 10.0});
  const double sag = 1.0 - run.last("spring_length_m");
  EXPECT_NEAR(sag, 10.0 * (0.5 - sag) * 0.125 / (3.0 * beam.EI_z) * (1.0 - 1.0 / 256.0), 1e-3 * sag);
}

TEST(PointSpring, WithoutADirectionIsRefused) {
  Linkage linkage = make_block(0.0);
  linkage.springs = {{.name = "spring", .from = kGroundName, .to = "block", .stiffness = 1.0, .free_length = 0.1}};
  const auto refused_field = [&]() -> std::string {
    try {
      check_linkage(linkage);
    } catch (const InvalidInput& refusal) {
      return refusal.field();
    }
    return "";
  };
  EXPECT_EQ(refused_field(), "springs.spring");
  linkage.springs[0].free_length = 0.0;
  linkage.springs[0].damping = 1.0;
  EXPECT_EQ(refused_field(), "springs.spring");
  linkage.springs[0].damping = 0.0;  // pulls with k times the way between its ends
  EXPECT_EQ(refused_field(), "");
  linkage.springs[0].free_length = std::nullopt;
  EXPECT_EQ(refused_field(), "");
}

// Of free length 0 it is linear in the plane: m r'' = -k r through its own middle, where it has no direction.
TEST(PointSpring, OfNoFreeLengthPassesThroughZero) {
  Linkage linkage = make_block(0.2);
  linkage.springs = {{.name = "spring", .from = kGroundName, .to = "block", .stiffness = 200.0, .free_length = 0.0}};
  for (const Integrator integrator : {Integrator::kDopri5, Integrator::kRadau5, Integrator::kRodas5}) {
    RunOptions options = accurate(1.0);
    options.integrator = integrator;
    const LinkageRun run(linkage, options);
    for (std::size_t k = 0; k < run.column("t_s").size(); ++k)
      EXPECT_NEAR(run.column("block_m")[k], 0.2 * std::cos(10.0 * run.column("t_s")[k]), 2e-8) << k;
    EXPECT_LT(run.metric("energy_imbalance_j"), 1e-8);
  }
}

// m v' = -c v + m g: thrown along x, it falls along -y.
TEST(PointDrag, SlowsAThrownBody) {
  constexpr double kBall = 2.0, kDrag = 3.0, kThrown = 5.0, kWeight = 9.81, kEnd = 1.0;
  Linkage linkage;
  linkage.gravity_W = {0.0, -kWeight, 0.0};
  linkage.bodies = {make_body("ball", kBall, {0.0, 0.0, 0.0}, {1e-3, 1e-3, 1e-3})};
  linkage.joints = {{.name = "air", .kind = JointKind::kPlanar, .from = kGroundName, .to = "ball", .placement = {},
                     .freedoms = {{.name = "x", .start_rate = kThrown}, {.name = "y"}, {.name = "turn"}}}};
  linkage.springs = {{.name = "drag", .from = kGroundName, .to = "ball", .drag = kDrag}};
  const double left = std::exp(-kDrag / kBall * kEnd), terminal = kBall * kWeight / kDrag;
  for (const Integrator integrator : {Integrator::kDopri5, Integrator::kRadau5, Integrator::kRodas5}) {
    RunOptions options = accurate(kEnd);
    options.integrator = integrator;
    const LinkageRun run(linkage, options);
    EXPECT_NEAR(run.last("x_m_s"), kThrown * left, 1e-8);
    EXPECT_NEAR(run.last("y_m_s"), -terminal * (1.0 - left), 1e-8);
    const double kinetic = 0.5 * kBall * (std::pow(run.last("x_m_s"), 2) + std::pow(run.last("y_m_s"), 2));
    EXPECT_NEAR(run.metric("structural_loss_j"),
                0.5 * kBall * kThrown * kThrown - kBall * kWeight * run.last("y_m") - kinetic, 1e-6);
    EXPECT_LT(run.metric("energy_imbalance_j"), 1e-6);
  }
}

// I w' = -c r^2 w.
TEST(PointDrag, SlowsATurningBodyByItsArm) {
  constexpr double kArm = 0.4, kInertia = 0.5, kDrag = 2.0, kRate = 5.0;
  Linkage linkage;
  linkage.bodies = {make_body("arm", 1.0, {0.0, 0.0, 0.0}, {0.3, 0.3, kInertia})};
  linkage.joints = {{.name = "arm", .from = kGroundName, .to = "arm", .placement = {},
                     .freedoms = {{.name = "arm", .start_rate = kRate}}}};
  linkage.springs = {{.name = "drag", .from = "arm", .to = kGroundName, .at = {kArm, 0.0, 0.0}, .to_at = {3.0, 0.0, 0.0}, .drag = kDrag}};
  const LinkageRun run(linkage, accurate(1.0));
  EXPECT_NEAR(run.last("arm_rad_s"), kRate * std::exp(-kDrag * kArm * kArm / kInertia), 1e-8);
  EXPECT_NEAR(run.metric("peak_drag_tension_n"), 0.0, 0.0) << "along the spring there is none";
}

// The slide bears the moment of the force's arm.
TEST(PointDrag, LoadsTheJointThatHoldsItsBody) {
  constexpr double kArm = 0.05, kDrag = 2.0, kRate = 3.0;
  Linkage linkage = make_block(0.3);
  linkage.joints[0].freedoms[0].start_rate = kRate;
  linkage.springs = {{.name = "drag", .from = kGroundName, .to = "block", .to_at = {0.0, kArm, 0.0}, .drag = kDrag}};
  const LinkageRun run(linkage, accurate(0.1));
  EXPECT_NEAR(run.column("block_m_s2").front(), -kDrag * kRate / 2.0, 1e-9);
  EXPECT_NEAR(run.column("block_moment_z_n_m").front(), -kDrag * kRate * kArm, 1e-9);
}

}  // namespace
}  // namespace engine
