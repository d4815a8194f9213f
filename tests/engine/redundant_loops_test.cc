// SPDX-License-Identifier: Apache-2.0
// Loops whose joints repeat one another, and starts that close a loop but for their last digits.

#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "engine/errors.h"
#include "tests/engine/linkage_cases.h"
#include "tests/engine/linkage_run.h"

namespace engine {
namespace {

std::vector<Eigen::Matrix3d> some_rotations() {
  std::vector<Eigen::Matrix3d> all{Eigen::Matrix3d::Identity()};
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1.0, 2.0, 3.0), Eigen::Vector3d(-0.3, 0.2, 0.9)})
    all.push_back(Eigen::AngleAxisd(0.7, axis.normalized()).toRotationMatrix());
  return all;
}

/// A body on a joint, three bars of 1 m welded to a triangle: the third weld repeats what the others say.
Linkage make_welded_triangle(JointKind carrier, const Eigen::Matrix3d& R) {
  Linkage linkage;
  for (const char* const name : {"a", "b", "c"})
    linkage.bodies.push_back(make_body(name, 1.0, {0.5, 0.0, 0.0}, {1e-3, 8e-2, 8e-2}));
  LinkageJoint joint{
      .name = "carrier", .kind = carrier, .from = kGroundName, .to = "a", .placement = {.R = R}};
  for (std::size_t k = 0; k < freedoms_of(joint).size(); ++k)
    joint.freedoms.push_back({.name = "q" + std::to_string(k)});
  linkage.joints.push_back(joint);
  const Placement corner{
      .R = Eigen::AngleAxisd(2.0 * std::numbers::pi / 3.0, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
      .p = {1.0, 0.0, 0.0}};
  linkage.joints.push_back(
      {.name = "ab", .kind = JointKind::kWeld, .from = "a", .to = "b", .placement = corner});
  linkage.joints.push_back(
      {.name = "bc", .kind = JointKind::kWeld, .from = "b", .to = "c", .placement = corner});
  linkage.joints.push_back(
      {.name = "ca", .kind = JointKind::kWeld, .from = "c", .to = "a", .placement = corner, .cut = true});
  return linkage;
}

TEST(Redundancy, OfAWeldThatIsThereAlreadyIsSix) {
  for (const JointKind carrier : {JointKind::kRevolute, JointKind::kCylindrical, JointKind::kUniversal,
                                  JointKind::kSpherical, JointKind::kFree})
    for (const Eigen::Matrix3d& R : some_rotations()) {
      const LinkageRun run(make_welded_triangle(carrier, R), {.duration = 0.1});
      EXPECT_EQ(run.metric("redundant_constraints"), 6.0) << static_cast<int>(carrier);
    }
}

/// A door of 1.2 m between two joints of a kind on one axis, or in line.
Linkage make_door(JointKind kind, const Eigen::Matrix3d& R) {
  Linkage linkage;
  linkage.bodies = {make_body("door", 10.0, {0.4, 0.0, 0.6}, {1.0, 1.0, 0.5})};
  LinkageJoint low{.name = "low", .kind = kind, .from = kGroundName, .to = "door", .placement = {.R = R}};
  for (std::size_t k = 0; k < freedoms_of(low).size(); ++k)
    low.freedoms.push_back({.name = "q" + std::to_string(k)});
  const Eigen::Vector3d up(0.0, 0.0, 1.2);
  linkage.joints = {low,
                    {.name = "high",
                     .kind = kind,
                     .from = kGroundName,
                     .to = "door",
                     .placement = {.R = R, .p = R * up},
                     .cut = true,
                     .to_placement = {.p = up}}};
  return linkage;
}

TEST(Redundancy, OfASecondJointInLineIsAllOfIt) {
  for (const Eigen::Matrix3d& R : some_rotations()) {
    EXPECT_EQ(
        LinkageRun(make_door(JointKind::kRevolute, R), {.duration = 0.1}).metric("redundant_constraints"),
        5.0);
    EXPECT_EQ(
        LinkageRun(make_door(JointKind::kPrismatic, R), {.duration = 0.1}).metric("redundant_constraints"),
        5.0);
    EXPECT_EQ(
        LinkageRun(make_door(JointKind::kCylindrical, R), {.duration = 0.1}).metric("redundant_constraints"),
        4.0);
  }
}

/// A four-bar with the start of each coordinate, and its rate.
Linkage make_started_four_bar(const std::vector<double>& starts, const std::vector<double>& rates) {
  Linkage linkage;
  linkage.gravity_W = {0.0, -9.81, 0.0};
  linkage.bodies = {make_body("crank", 1.0, {0.1, 0.0, 0.0}, {1e-3, 1e-2, 1e-2}),
                    make_body("rod", 1.0, {0.25, 0.0, 0.0}, {1e-3, 2e-2, 2e-2}),
                    make_body("rocker", 1.0, {0.2, 0.0, 0.0}, {1e-3, 2e-2, 2e-2})};
  linkage.joints = {
      {.name = "A", .from = kGroundName, .to = "crank", .placement = {}, .freedoms = {{.name = "A"}}},
      {.name = "B",
       .from = "crank",
       .to = "rod",
       .placement = {.p = {0.2, 0.0, 0.0}},
       .freedoms = {{.name = "B"}}},
      {.name = "D",
       .from = kGroundName,
       .to = "rocker",
       .placement = {.p = {0.5, 0.0, 0.0}},
       .freedoms = {{.name = "D"}}},
      {.name = "C",
       .from = "rod",
       .to = "rocker",
       .placement = {.p = {0.5, 0.0, 0.0}},
       .cut = true,
       .to_placement = {.p = {0.4, 0.0, 0.0}}}};
  for (std::size_t k = 0; k < starts.size(); ++k) {
    linkage.joints[k].freedoms[0].start = starts[k];
    if (!rates.empty()) linkage.joints[k].freedoms[0].start_rate = rates[k];
  }
  return linkage;
}

TEST(Starts, MayCloseALoopButForTheirLastDigits) {
  const std::vector<double> starts{1.0, -0.52608883, 1.43801773};
  const LinkageRun run(make_started_four_bar(starts, {}), accurate(0.5));
  EXPECT_NEAR(run.column("A_rad")[0], 1.0, 1e-7);
  EXPECT_NEAR(run.column("D_rad")[0], 1.43801773, 1e-7);
  EXPECT_LT(run.metric("energy_residual"), 1e-6);
}

TEST(Starts, GoOnWhereATrajectoryOfSinglePrecisionEnds) {
  const LinkageRun first(make_started_four_bar({1.0, -0.52608883, 1.43801773}, {}), accurate(0.5));
  std::vector<double> starts, rates;
  for (const char* const name : {"A", "B", "D"}) {
    starts.push_back(static_cast<float>(first.last(std::string(name) + "_rad")));
    rates.push_back(static_cast<float>(first.last(std::string(name) + "_rad_s")));
  }
  const LinkageRun second(make_started_four_bar(starts, rates), accurate(0.1));
  EXPECT_NEAR(second.column("A_rad_s")[0], first.last("A_rad_s"), 1e-5);
  EXPECT_EQ(second.metric("redundant_constraints"), 3.0);
}

TEST(Starts, ThatTearALoopApartAreRefused) {
  for (const double off : {1e-4, 1e-2}) {
    try {
      check_linkage(make_started_four_bar({1.0, -0.52608883 + off, 1.43801773}, {}));
      ADD_FAILURE() << off;
    } catch (const InvalidInput& fault) {
      EXPECT_NE(std::string(fault.what()).find("leaves a gap of"), std::string::npos) << fault.what();
      EXPECT_EQ(std::string(fault.what()).find("gap of 0 m"), std::string::npos) << fault.what();
    }
  }
  EXPECT_THROW(check_linkage(make_started_four_bar({1.0, -0.52608883, 1.43801773}, {1.0, 1.0, 1.0})),
               InvalidInput);
}

}  // namespace
}  // namespace engine
