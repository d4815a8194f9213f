// SPDX-License-Identifier: Apache-2.0
// Accelerometers on bodies against closed forms.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <gtest/gtest.h>

#include "tests/engine/linkage_cases.h"
#include "tests/engine/linkage_run.h"

namespace engine {
namespace {

constexpr double kGravity = 9.81, kPlace = 0.4;

LinkageAccelerometer at_place(const char* name, const Eigen::Vector3d& direction) {
  return {.name = name, .body = "bar", .at = {kPlace, 0.0, 0.0}, .direction = direction};
}

/// A uniform bar of 1 m on a pivot about z, from the horizontal, with sensors along and across it.
Linkage make_sensed_pendulum() {
  Linkage linkage;
  linkage.bodies = {make_body("bar", 1.0, {0.5, 0.0, 0.0}, {1e-3, 1.0 / 12.0, 1.0 / 12.0})};
  linkage.joints = {{.name = "pivot",
                     .from = kGroundName,
                     .to = "bar",
                     .placement = {},
                     .freedoms = {{.name = "q", .start = 0.0}}}};
  linkage.gravity_W = {0.0, -kGravity, 0.0};
  linkage.accelerometers = {at_place("along", {1.0, 0.0, 0.0}), at_place("across", {0.0, 1.0, 0.0})};
  return linkage;
}

// q'' = -1.5 g cos q; at the distance r the bar shows r q'' + g cos q across, and -r q'^2 + g sin q along.
TEST(Accelerometers, ShowWhatAPendulumFeels) {
  const LinkageRun run(make_sensed_pendulum(), accurate(2.0));
  double largest = 0.0;
  for (std::size_t k = 0; k < run.column("t_s").size(); ++k) {
    const double q = run.column("q_rad")[k], rate = run.column("q_rad_s")[k];
    const double across = (1.0 - 1.5 * kPlace) * kGravity * std::cos(q);
    const double along = -kPlace * rate * rate + kGravity * std::sin(q);
    EXPECT_NEAR(run.column("across_accelerometer_m_s2")[k], across, 1e-9);
    EXPECT_NEAR(run.column("along_accelerometer_m_s2")[k], along, 1e-9);
    largest = std::max(largest, std::abs(along));
  }
  EXPECT_GE(run.metric("peak_along_accelerometer_m_s2"), largest);
  EXPECT_NEAR(run.metric("peak_along_accelerometer_m_s2"), (3.0 * kPlace + 1.0) * kGravity,
              1e-2);  // where it hangs
}

/// Sensed pendulum beside a frame that is welded to the ground, with a sensor of its own, and a load.
Linkage make_pendulum_and_frame() {
  Linkage linkage = make_sensed_pendulum();
  linkage.bodies.push_back(make_body("frame", 1.0, {0.0, 0.0, 0.0}, {1e-3, 1e-3, 1e-3}));
  linkage.joints.push_back(
      {.name = "bolts", .kind = JointKind::kWeld, .from = kGroundName, .to = "frame", .placement = {}});
  linkage.accelerometers.push_back(
      {.name = "fixed", .body = "frame", .at = {1.0, 2.0, 3.0}, .direction = {0.0, 1.0, 0.0}});
  linkage.loads = {{.name = "push",
                    .body = "frame",
                    .at = {1.0, 0.0, 0.0},
                    .force = {3.0, 0.0, 0.0},
                    .law = Constant{2.0}}};
  return linkage;
}

TEST(Accelerometers, ShowGravityOnABodyThatDoesNotMove) {
  const LinkageRun alone(make_sensed_pendulum(), accurate(0.5)),
      run(make_pendulum_and_frame(), accurate(0.5));
  for (const double shown : run.column("fixed_accelerometer_m_s2")) EXPECT_NEAR(shown, kGravity, 1e-12);
  EXPECT_NEAR(run.metric("peak_fixed_accelerometer_m_s2"), kGravity, 1e-12);
  EXPECT_EQ(run.last("push_n"), 2.0);
  EXPECT_NEAR(run.last("q_rad"), alone.last("q_rad"), 1e-9);
  EXPECT_LT(run.metric("energy_residual"), 1e-8);
}

// Loads and sensors beside the root of a clamped beam, whose first part does not move.
TEST(Accelerometers, ShowTheGroundsAccelerationAtTheRootOfACantilever) {
  Linkage linkage;
  linkage.gravity_W.setZero();
  linkage.bodies = {
      {.name = "rod",
       .mass = 1.0,
       .beam =
           UniformBeam{.length = 1.0, .mass = 1.0, .I_x = 1e-5, .EI_y = 175.0, .EI_z = 175.0, .GJ = 100.0},
       .elements = 4}};
  linkage.joints = {
      {.name = "bolt", .kind = JointKind::kWeld, .from = kGroundName, .to = "rod", .placement = {}}};
  linkage.ground_acceleration[1] = Constant{3.0};
  linkage.accelerometers = {{.name = "root", .body = "rod", .direction = {0.0, 1.0, 0.0}}};
  linkage.loads = {{.name = "near",
                    .body = "rod",
                    .at = {0.03, 0.0, 0.0},
                    .force = {0.0, 1.0, 0.0},
                    .law = Constant{5.0}}};
  const LinkageRun run(linkage, {.duration = 0.05});
  for (const double shown : run.column("root_accelerometer_m_s2")) EXPECT_NEAR(shown, 3.0, 1e-12);
}

TEST(Accelerometers, ShowTheAccelerationAloneInTheDirectionsOfTheGround) {
  Linkage linkage = make_sensed_pendulum();
  for (LinkageAccelerometer& one : linkage.accelerometers) one.follows_body = one.shows_gravity = false;
  const LinkageRun run(linkage, accurate(2.0));
  for (std::size_t k = 0; k < run.column("t_s").size(); ++k) {
    const double q = run.column("q_rad")[k], w = run.column("q_rad_s")[k], turn = run.column("q_rad_s2")[k];
    EXPECT_NEAR(run.column("along_accelerometer_m_s2")[k],
                kPlace * (-turn * std::sin(q) - w * w * std::cos(q)), 1e-9);
    EXPECT_NEAR(run.column("across_accelerometer_m_s2")[k],
                kPlace * (turn * std::cos(q) - w * w * std::sin(q)), 1e-9);
  }
}

// A block that nothing drives stays behind a ground that moves: its sensor shows nothing, one across shows
// both.
TEST(Accelerometers, FeelTheGroundMove) {
  Linkage linkage;
  linkage.bodies = {make_body("bar", 2.0, {0.0, 0.0, 0.0}, {0.1, 0.1, 0.1})};
  linkage.joints = {{.name = "slide",
                     .kind = JointKind::kPrismatic,
                     .from = kGroundName,
                     .to = "bar",
                     .placement = {},
                     .axes = {Axis::kX, Axis::kY},
                     .freedoms = {{.name = "q", .start = 0.0}}}};
  linkage.gravity_W = {0.0, -kGravity, 0.0};
  linkage.ground_acceleration = {Constant{3.0}, Constant{2.0}, std::nullopt};
  linkage.accelerometers = {at_place("along", {1.0, 0.0, 0.0}), at_place("across", {0.0, 1.0, 0.0})};
  const LinkageRun run(linkage, accurate(0.5));
  EXPECT_NEAR(run.last("q_m_s2"), -3.0, 1e-9);
  EXPECT_NEAR(run.last("along_accelerometer_m_s2"), 0.0, 1e-9);
  EXPECT_NEAR(run.last("across_accelerometer_m_s2"), kGravity + 2.0, 1e-9);
}

// A welded body turns its sensor's directions with it.
TEST(Accelerometers, SitOnWeldedBodies) {
  Linkage linkage = make_sensed_pendulum();
  linkage.bodies.push_back({.name = "box"});
  Eigen::Matrix3d quarter;
  quarter << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  linkage.joints.push_back({.name = "glue",
                            .kind = JointKind::kWeld,
                            .from = "bar",
                            .to = "box",
                            .placement = {quarter, {kPlace, 0.0, 0.0}}});
  linkage.accelerometers.push_back({.name = "box_along", .body = "box", .direction = {1.0, 0.0, 0.0}});
  const LinkageRun run(linkage, accurate(0.5));
  EXPECT_NEAR(run.last("box_along_accelerometer_m_s2"), run.last("across_accelerometer_m_s2"), 1e-9);
}

}  // namespace
}  // namespace engine
