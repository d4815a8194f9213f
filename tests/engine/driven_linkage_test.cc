// SPDX-License-Identifier: Apache-2.0
// Linkages that their drives decide alone, and those that only seem to be such.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/linkage_cases.h"
#include "tests/engine/linkage_run.h"

namespace engine {
namespace {

Linkage drive_crank(Linkage linkage, const DriveLaw& law) {
  linkage.joints.front().freedoms.front() = {.name = "theta", .drive = law};
  return linkage;
}

struct DriveCase {
  const char* name;
  DriveLaw law;
};
void PrintTo(const DriveCase& c, std::ostream* out) { *out << c.name; }

/// Energy balance under every law: the work of the drive is the only source of energy.
class DrivenBy : public testing::TestWithParam<DriveCase> {};

TEST_P(DrivenBy, ALawIsFollowedWithoutLoss) {
  const LinkageRun run(drive_crank(make_spatial_slider_crank(JointKind::kSpherical), GetParam().law), accurate(2.0));
  const std::vector<double>& energy = run.column("kinetic_energy_j");
  EXPECT_GT(*std::max_element(energy.begin(), energy.end()), 1e-2);
  EXPECT_LT(run.metric("energy_imbalance_j"), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(
    Engine, DrivenBy,
    testing::Values(DriveCase{"run_up", RunUp{.omega = 6.0, .run_up = 0.5}},
                    DriveCase{"rise_return_pause", RiseReturnPause{.stroke = 1.0, .stroke_time = 0.3, .pause = 0.2}},
                    DriveCase{"cycloidal_rise", CycloidalRise{.from = 0.1, .rise = 3.0, .begin = 0.2, .time = 0.7}},
                    DriveCase{"harmonic", Harmonic{.mean = 0.1, .amplitude = 0.8, .omega = 8.0, .phase = 0.4}},
                    DriveCase{"polynomial", Polynomial{{0.1, 0.5, -2.0, 3.0}}},
                    // From rest to rest without a jolt: the first three derivatives vanish where it begins.
                    DriveCase{"gentle_polynomial", Polynomial{{0.0, 0.0, 0.0, 0.0, 6.5625, -7.875, 3.28125, -0.46875}}},
                    DriveCase{"spline", Spline({0.0, 0.3, 0.7, 1.4, 2.0}, {0.0, 0.5, 1.8, 0.9, 2.0})},
                    DriveCase{"straight_velocities", VelocityTable({0.0, 0.3, 0.7, 1.4}, {0.0, 4.0, -2.0, 3.0},
                                                                   TableInterpolation::kLinear, 0.2)},
                    DriveCase{"smooth_velocities", VelocityTable({0.0, 0.3, 0.7, 1.4}, {0.0, 4.0, -2.0, 3.0},
                                                                 TableInterpolation::kMonotoneCubic, 0.2)}));

/// A cart along x, from which a pendulum of half a metre hangs at rest.
Linkage make_cart(const DriveLaw& law) {
  Linkage linkage;
  linkage.gravity_W = {0.0, -9.81, 0.0};
  linkage.bodies = {make_body("cart", 1.0, {0.0, 0.0, 0.0}, {0.01, 0.01, 0.01}), make_body("bob", 1.0, {0.0, -0.5, 0.0}, {1e-6, 1e-6, 1e-6})};
  linkage.joints = {{.name = "rail", .kind = JointKind::kPrismatic, .from = kGroundName, .to = "cart", .placement = {},
                     .axes = {Axis::kX, Axis::kY}, .freedoms = {{.name = "x", .drive = law}}},
                    {.name = "pivot", .from = "cart", .to = "bob", .placement = {}, .freedoms = {{.name = "angle", .start = 0.0}}}};
  return linkage;
}

// Steps of 5 ms would pass by a motion of a millisecond. The bob stays where it is as the cart moves on by a centimetre.
TEST(DrivenLinkage, DoesNotMissAShortMotion) {
  constexpr double kRise = 0.01;
  for (double begin = 0.5; begin < 0.505; begin += 0.0007) {
    const std::vector<DriveLaw> laws{
        CycloidalRise{.from = 0.0, .rise = kRise, .begin = begin, .time = 0.001},
        VelocityTable({0.0, begin, begin + 0.001, begin + 0.002, 2.0}, {0.0, 0.0, kRise / 0.001, 0.0, 0.0},
                      TableInterpolation::kMonotoneCubic, 0.0)};
    for (const DriveLaw& law : laws) {
      const LinkageRun run(make_cart(law), {.duration = begin + 0.02});
      EXPECT_NEAR(std::abs(run.last("angle_rad")), kRise / 0.5, 0.1 * kRise / 0.5) << begin << ' ' << law.index();
    }
  }
}

// The same forces and moments, whether the motion is solved or integrated.
TEST(DrivenLinkage, ItsJointsBearTheMomentsOfTheEquationsOfMotion) {
  const Linkage linkage = drive_crank(make_spatial_slider_crank(JointKind::kUniversal), RunUp{.omega = 6.0, .run_up = 0.2});
  const LinkageRun solved(linkage, accurate(0.5));
  RunOptions stepped = accurate(0.5);
  stepped.integrator = Integrator::kRk4;
  stepped.step = 1e-4;
  const LinkageRun integrated(linkage, stepped);
  double largest = 0.0;
  for (const char* const joint : {"pin", "ball", "slide"})
    for (const char* const axis : {"x", "y", "z"}) {
      const std::string key = std::string(joint) + "_moment_" + axis + "_n_m";
      EXPECT_NEAR(solved.last(key), integrated.last(key), 1e-6) << key;
      largest = std::max(largest, std::abs(solved.last(key)));
    }
  for (const char* const axis : {"x", "y", "z"}) EXPECT_NEAR(solved.last(std::string("ball_moment_") + axis + "_n_m"), 0.0, 1e-9) << axis;
  EXPECT_GT(largest, 1e-2);
}

TEST(DrivenLinkage, AShaftMayRunInMoreBearingsThanItNeeds) {
  Linkage linkage;
  linkage.gravity_W = {0.0, -9.81, 0.0};
  linkage.bodies = {make_body("shaft", 2.0, {0.0, 0.0, 0.0}, {0.01, 0.01, 0.01})};
  linkage.joints = {{.name = "one", .from = kGroundName, .to = "shaft", .placement = {},
                     .freedoms = {{.name = "angle", .drive = RunUp{.omega = 5.0, .run_up = 1.0}}}},
                    {.name = "two", .from = kGroundName, .to = "shaft", .placement = {}, .cut = true}};
  const LinkageRun run(linkage, accurate(0.5));
  EXPECT_EQ(run.metric("redundant_constraints"), 5.0);
  EXPECT_NEAR(run.last("one_force_y_n") + run.last("two_force_y_n"), 2.0 * 9.81, 1e-9);
  EXPECT_LT(run.metric("energy_imbalance_j"), 1e-9);
}

/// A flat chain of five bars, of which the ground is one: free to move by one coordinate beside the drive's.
Linkage make_five_bar(JointKind cut) {
  Linkage linkage;
  linkage.gravity_W = {0.0, -9.81, 0.0};
  linkage.bodies = {make_body("first", 1.0, {0.1, 0.0, 0.0}, {1e-3, 1e-2, 1e-2})};
  for (const char* const name : {"second", "third", "fourth"}) linkage.bodies.push_back(make_body(name, 1.0, {0.2, 0.0, 0.0}, {1e-3, 1e-2, 1e-2}));
  linkage.joints = {
      {.name = "r1", .from = kGroundName, .to = "first", .placement = {}, .freedoms = {{.name = "q1", .drive = RunUp{.omega = 2.0, .run_up = 1.0}}}},
      {.name = "r2", .from = "first", .to = "second", .placement = {.p = {0.2, 0.0, 0.0}}, .freedoms = {{.name = "q2", .guess = -0.9}}},
      {.name = "r3", .from = "second", .to = "third", .placement = {.p = {0.4, 0.0, 0.0}}, .freedoms = {{.name = "q3", .guess = 0.9}}},
      {.name = "r4", .from = "third", .to = "fourth", .placement = {.p = {0.4, 0.0, 0.0}}, .freedoms = {{.name = "q4", .guess = 0.9}}},
      {.name = "r5", .kind = cut, .from = kGroundName, .to = "fourth", .placement = {.p = {1.0, 0.0, 0.0}}, .cut = true,
       .to_placement = {.p = {0.4, 0.0, 0.0}}}};
  return linkage;
}

// Three rows for three unknowns, of which one row says nothing in a flat linkage.
TEST(DrivenLinkage, AsManyRowsAsUnknownsNeedNotDecideThem) {
  const LinkageRun run(make_five_bar(JointKind::kSpherical), accurate(0.2));
  EXPECT_EQ(run.metric("redundant_constraints"), 1.0);
  EXPECT_LT(run.metric("energy_imbalance_j"), 1e-8);
  const LinkageRun revolute(make_five_bar(JointKind::kRevolute), accurate(0.2));
  EXPECT_NEAR(run.last("q2_rad"), revolute.last("q2_rad"), 1e-8);
  EXPECT_GT(std::abs(run.last("q2_rad") - run.column("q2_rad").front()), 1e-2);
}

}  // namespace
}  // namespace engine
