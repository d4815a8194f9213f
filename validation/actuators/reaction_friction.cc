// SPDX-License-Identifier: Apache-2.0
// Dry friction in joints without play, under the reactions that it changes itself.

#include <cmath>
#include <string>
#include <vector>

#include "validation/actuators/mover.h"
#include "validation/actuators/parts.h"

namespace validation {

namespace {

constexpr double kFrictionMu = 0.5;
constexpr FrictionParameters kSharpCoulomb{.mu_k = kFrictionMu, .law = FrictionLaw::kCoulomb, .v_0 = 1e-7};

/// An arm on a pin, without gravity: its centre of mass pulls at the pin.
Check compare_whirling_arm() {
  constexpr double kMass = 2.0, kArm = 0.1, kMoment = 0.03, kPin = 0.05, kStart = 20.0, kTime = 1.0;
  Linkage arm;
  arm.bodies = {{.name = "arm",
                 .mass = kMass,
                 .com = {kArm, 0.0, 0.0},
                 .inertia = Eigen::Vector3d(1e-3, kMoment, kMoment).asDiagonal()}};
  arm.joints = {{.name = "pin", .from = kGroundName, .to = "arm", .placement = {}}};
  arm.joints[0].freedoms = {
      {.name = "q",
       .start = 0.0,
       .start_rate = kStart,
       .friction = JointFriction{.law = kSharpCoulomb, .radius = kPin, .by_reaction = true}}};
  const double k = kFrictionMu * kPin * kMass * kArm / kMoment, kappa = k / std::sqrt(1.0 - k * k);
  return compare(
      "speed of an arm that whirls on a pin with friction, after 1 s",
      "J w' = -mu r m d sqrt(w^4 + w'^2): w = w_0 / (1 + k w_0 t / sqrt(1 - k^2)), k = mu r m d / J",
      column(run_linkage(arm, Integrator::kRadau5, kTime), "q_rad_s").back(),
      kStart / (1.0 + kappa * kStart * kTime), 1e-8, "rad/s", kStepTolerance);
}

/// A wheel on an upright shaft, whose end bears its weight.
Check compare_upright_wheel() {
  constexpr double kPin = 0.05, kStart = 30.0, kG = 9.81;
  Linkage wheel =
      make_mover(JointKind::kRevolute,
                 {.name = "q",
                  .start = 0.0,
                  .start_rate = kStart,
                  .friction = JointFriction{.law = kSharpCoulomb, .radius = kPin, .by_reaction = true}});
  wheel.gravity_W = {0.0, 0.0, -kG};
  return compare(
      "speed of a wheel on an upright shaft whose end rubs under its weight, after 1 s",
      "w_0 - mu r m g t / J", column(run_linkage(wheel, Integrator::kRadau5, 1.0), "q_rad_s").back(),
      kStart - kFrictionMu * kPin * kBlockMass * kG / kFlywheelInertia, 1e-8, "rad/s", kStepTolerance);
}

/// A block on a slide along x. @param length  of the guide, [m]
Linkage make_rubbing_block(double length) {
  Linkage linkage;
  linkage.bodies = {{.name = "block", .mass = kBlockMass}};
  linkage.joints = {{.name = "slide",
                     .kind = JointKind::kPrismatic,
                     .from = kGroundName,
                     .to = "block",
                     .placement = {},
                     .axes = {Axis::kX, Axis::kY}}};
  linkage.joints[0].freedoms = {
      {.name = "q",
       .start = 0.0,
       .start_rate = 1.0,
       .friction = JointFriction{.law = kSharpCoulomb, .by_reaction = true, .length = length}}};
  return linkage;
}

Check compare_incline() {
  constexpr double kAngle = 0.6, kG = 9.81;
  Linkage incline = make_rubbing_block(0.0);
  incline.gravity_W = kG * Eigen::Vector3d(std::sin(kAngle), -std::cos(kAngle), 0.0);
  return compare("velocity of a block that its weight presses on an incline, from 1 m/s, after 1 s",
                 "v_0 + g (sin a - mu cos a) t",
                 column(run_linkage(incline, Integrator::kRadau5, 1.0), "q_m_s").back(),
                 1.0 + kG * (std::sin(kAngle) - kFrictionMu * std::cos(kAngle)), 1e-8, "m/s", kStepTolerance);
}

/// A push beside the axis of the guide: its ends bear a couple.
Check compare_drawer() {
  constexpr double kPush = 10.0, kAside = 0.06, kLength = 0.2;
  Linkage drawer = make_rubbing_block(kLength);
  drawer.loads = {{.name = "push",
                   .body = "block",
                   .at = {0.0, kAside, 0.0},
                   .force = {1.0, 0.0, 0.0},
                   .law = Constant{kPush}}};
  return compare(
      "velocity of a drawer that is pushed beside its middle, from 1 m/s, after 1 s",
      "v_0 + F (1 - 2 mu e / L) t / m", column(run_linkage(drawer, Integrator::kRadau5, 1.0), "q_m_s").back(),
      1.0 + kPush * (1.0 - 2.0 * kFrictionMu * kAside / kLength) / kBlockMass, 1e-8, "m/s", kStepTolerance);
}

/// A slider-crank that runs down by the friction of all joints but the cut one.
Linkage make_rubbing_slider_crank() {
  constexpr double kCrank = 0.1, kRod = 0.3;
  const auto rub = [](double radius) {
    return JointFriction{.law = {.mu_s = 0.2, .mu_k = 0.15, .sigma_0 = 1e4, .sigma_1 = 10.0},
                         .radius = radius,
                         .by_reaction = true};
  };
  Linkage linkage;
  linkage.gravity_W = {0.0, -9.81, 0.0};
  linkage.bodies = {{.name = "crank", .mass = 1.0, .inertia = 0.02 * Eigen::Matrix3d::Identity().eval()},
                    {.name = "rod",
                     .mass = 0.5,
                     .com = {0.15, 0.0, 0.0},
                     .inertia = Eigen::Vector3d(1e-3, 0.02, 0.02).asDiagonal()},
                    {.name = "slider", .mass = 0.8}};
  linkage.joints = {{.name = "crank", .from = kGroundName, .to = "crank", .placement = {}},
                    {.name = "pin", .from = "crank", .to = "rod", .placement = {.p = {kCrank, 0.0, 0.0}}},
                    {.name = "slide",
                     .kind = JointKind::kPrismatic,
                     .from = kGroundName,
                     .to = "slider",
                     .placement = {},
                     .axes = {Axis::kX, Axis::kY}},
                    {.name = "end",
                     .from = "slider",
                     .to = "rod",
                     .placement = {},
                     .cut = true,
                     .to_placement = {.p = {kRod, 0.0, 0.0}}}};
  linkage.joints[0].freedoms = {{.name = "crank", .start = 0.5, .start_rate = 30.0, .friction = rub(0.02)}};
  linkage.joints[1].freedoms = {{.name = "pin", .guess = -0.7, .friction = rub(0.01)}};
  linkage.joints[2].freedoms = {{.name = "slide", .guess = 0.4, .friction = rub(1.0)}};
  return linkage;
}

}  // namespace

Findings compute_reaction_friction() {
  Findings findings;
  findings.checks = {compare_whirling_arm(), compare_upright_wheel(), compare_incline(), compare_drawer()};
  const Linkage rubbing = make_rubbing_slider_crank();
  const RunResult run = run_linkage(rubbing, Integrator::kRadau5, 2.0);
  findings.checks.push_back(limit("energy residual of a slider-crank with friction by its reactions", "0",
                                  metric_of(rubbing, run, "energy_residual"), 1e-7, "1", kStepTolerance));
  return findings;
}

}  // namespace validation
