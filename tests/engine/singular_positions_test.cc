// SPDX-License-Identifier: Apache-2.0
// Positions in which equations degenerate though the motion does not: change points, gimbal lock, links without
// mass, joints turned over.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "engine/errors.h"
#include "tests/engine/linkage_cases.h"
#include "tests/engine/linkage_run.h"

namespace engine {
namespace {

/// A parallelogram: crank and rocker of 0.2 m, 1 m apart. It is flat where the crank lies along the ground.
Linkage make_parallelogram(const DriveLaw& law, double start) {
  Linkage linkage;
  linkage.gravity_W = {0.0, -9.81, 0.0};
  linkage.bodies = {make_body("crank", 1.0, {0.1, 0.0, 0.0}, {1e-4, 3e-3, 3e-3}),
                    make_body("rod", 2.0, {0.5, 0.0, 0.0}, {2e-3, 0.17, 0.17}),
                    make_body("rocker", 1.0, {0.1, 0.0, 0.0}, {1e-4, 3e-3, 3e-3})};
  linkage.joints = {
      {.name = "crank", .from = kGroundName, .to = "crank", .placement = {},
       .freedoms = {{.name = "crank", .drive = law}}},
      {.name = "pin", .from = "crank", .to = "rod", .placement = {.p = {0.2, 0.0, 0.0}},
       .freedoms = {{.name = "pin", .guess = -start}}},
      {.name = "rocker", .from = kGroundName, .to = "rocker", .placement = {.p = {1.0, 0.0, 0.0}},
       .freedoms = {{.name = "rocker", .guess = start}}},
      {.name = "close", .from = "rocker", .to = "rod", .placement = {.p = {0.2, 0.0, 0.0}}, .cut = true,
       .to_placement = {.p = {1.0, 0.0, 0.0}}}};
  return linkage;
}

RunResult run(const Linkage& linkage, double duration, Integrator integrator = Integrator::kAuto) {
  return simulate_linkage(linkage, {.duration = duration, .integrator = integrator}, 0.0, {});
}

class PassesAChangePoint : public testing::TestWithParam<double> {};

// In the parallelogram the rod does not turn: rocker and crank have one angle, whatever the speed.
TEST_P(PassesAChangePoint, OnTheSmoothBranch) {
  const double speed = GetParam();
  const LinkageRun passed(make_parallelogram(Polynomial{{-0.1, speed}}, -0.1), {.duration = 0.3 / speed});
  const std::vector<double>&crank = passed.column("crank_rad"), &rocker = passed.column("rocker_rad");
  for (std::size_t k = 0; k < crank.size(); ++k) EXPECT_NEAR(rocker[k], crank[k], 1e-9) << k;
  EXPECT_NEAR(passed.last("rocker_rad_s"), speed, 1e-9 * speed);
  EXPECT_LT(passed.metric("steps"), 400.0);
  EXPECT_LT(passed.metric("energy_residual"), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(SlowlyAndFast, PassesAChangePoint, testing::Values(0.01, 0.1, 0.3, 1.0, 10.0, 30.0));

// Without a drive and without weight the parallelogram turns on as it began, whatever its links weigh.
TEST(ChangePoint, IsPassedOnTheSmoothBranchWithoutADrive) {
  constexpr double kMasses[][3] = {{1.0, 2.0, 1.0}, {100.0, 0.01, 1.0}, {1.0, 100.0, 0.001}, {0.001, 1.0, 1000.0}};
  constexpr double kLengths[] = {0.2, 1.0, 0.2};
  for (const auto& masses : kMasses)
    for (const double speed : {0.01, 1.0, 10.0}) {
      Linkage linkage = make_parallelogram(Polynomial{{0.0, 0.0}}, -0.1);
      linkage.gravity_W.setZero();
      for (std::size_t k = 0; k < 3; ++k) {
        const double inertia = masses[k] * kLengths[k] * kLengths[k] / 12.0;
        linkage.bodies[k] = make_body(linkage.bodies[k].name, masses[k], {0.5 * kLengths[k], 0.0, 0.0},
                                      {0.01 * inertia, inertia, inertia});
      }
      linkage.joints[0].freedoms[0] = {.name = "crank", .start = -0.1, .start_rate = speed};
      const LinkageRun passed(linkage, {.duration = 0.3 / speed});
      const std::vector<double>&crank = passed.column("crank_rad"), &rocker = passed.column("rocker_rad");
      for (std::size_t k = 0; k < crank.size(); ++k) EXPECT_NEAR(rocker[k], crank[k], 1e-8) << k;
      EXPECT_LT(passed.metric("energy_residual"), 1e-9);
    }
}

// Instants of the grid fall into the change points, at whole and half turns.
TEST(ChangePoint, IsPassedAtAnInstantOfTheGrid) {
  const double turn = std::numbers::pi;
  const LinkageRun passed(make_parallelogram(Polynomial{{-0.5 * turn, turn}}, -0.5 * turn), {.duration = 3.25});
  const std::vector<double>&crank = passed.column("crank_rad"), &rocker = passed.column("rocker_rad");
  for (std::size_t k = 0; k < crank.size(); ++k) EXPECT_NEAR(rocker[k], crank[k], 1e-8) << k;
}

TEST(ChangePoint, EndsARunThatStartsOrRestsThere) {
  const RunResult starts = run(make_parallelogram(RunUp{.omega = 10.0, .run_up = 0.5}, 0.0), 0.2);
  EXPECT_EQ(starts.status, RunStatus::kSingular);
  EXPECT_EQ(starts.t_end, 0.0);
  EXPECT_NE(starts.detail.find("crank at 0 rad"), std::string::npos) << starts.detail;
  const RunResult rests =
      run(make_parallelogram(CycloidalRise{.from = -0.5, .rise = 0.5, .time = 0.3}, -0.5), 0.5);
  EXPECT_EQ(rests.status, RunStatus::kSingular);
  EXPECT_NEAR(rests.t_end, 0.3, 0.01);
}

/// The parallelogram flat, in motion, with the rate of its rocker given, too.
Linkage make_flat_parallelogram(double crank_rate, double rocker_rate) {
  Linkage linkage = make_parallelogram(Polynomial{{0.0, crank_rate}}, 0.0);
  linkage.joints[2].freedoms[0] = {.name = "rocker", .start = 0.0, .start_rate = rocker_rate};
  return linkage;
}

// Crank and rocker of length a, rod of length b and the rates u, v of crank and rocker: the loop's second derivative
// vanishes for b (u^2 - v^2) + a (v - u)^2 = 0, which is v = u or, with b = 5 a, v = -1.5 u. Other rates have no
// accelerations.
TEST(ChangePoint, IsAStartForTheRatesOfABranch) {
  const LinkageRun parallel(make_flat_parallelogram(2.0, 2.0), {.duration = 0.3});
  EXPECT_NEAR(parallel.last("rocker_rad"), 0.6, 1e-6);
  const LinkageRun crossed(make_flat_parallelogram(2.0, -3.0), {.duration = 0.1});
  EXPECT_LT(crossed.last("rocker_rad"), -0.2);
  EXPECT_EQ(run(make_flat_parallelogram(2.0, 1.0), 0.1).status, RunStatus::kSingular);
  EXPECT_EQ(run(make_flat_parallelogram(2.0, -2.0), 0.1).status, RunStatus::kSingular);
}

// Nothing drives the linkage: at rest gravity may take it along either branch.
TEST(ChangePoint, IsNoStartFromRest) {
  Linkage linkage = make_parallelogram(Polynomial{{0.0, 0.0}}, 0.0);
  linkage.joints[0].freedoms[0] = {.name = "crank", .start = 0.0, .start_rate = 0.0};
  EXPECT_EQ(run(linkage, 0.1).status, RunStatus::kSingular);
}

// A loop nearly flat, of a rocker as heavy as a pen and a coupler as heavy as a motor: of its two rows one binds the
// heavy links alone, with an eigenvalue of 1e-10 of the other's. The energy tells the speed at each position.
TEST(NearlyFlatLoop, KeepsTheEnergyOfHeavyLinksWithALightOne) {
  Linkage linkage;
  linkage.gravity_W = {0.0, -9.81, 0.0};
  const double length[] = {2.4, 5.2, 1.0}, mass[] = {5.0, 170.0, 0.02}, angle[] = {-5e-4, std::numbers::pi - 1e-4, -2e-4};
  Placement end;
  std::string from = kGroundName;
  double before = 0.0;
  for (int k = 0; k < 3; ++k) {
    const std::string name(1, static_cast<char>('a' + k));
    const double inertia = mass[k] * length[k] * length[k] / 12.0;
    linkage.bodies.push_back(make_body(name, mass[k], {0.5 * length[k], 0.0, 0.0}, {0.01 * inertia, inertia, inertia}));
    linkage.joints.push_back({.name = name, .from = from, .to = name, .placement = {.p = {before, 0.0, 0.0}},
                              .freedoms = {{.name = name, .guess = angle[k]}}});
    end.p += end.R * Eigen::Vector3d(before, 0.0, 0.0);
    end.R = end.R * Eigen::AngleAxisd(angle[k], Eigen::Vector3d::UnitZ()).toRotationMatrix();
    before = length[k];
    from = name;
  }
  linkage.joints.push_back({.name = "pin", .from = kGroundName, .to = "c",
                            .placement = {.p = end.p + end.R * Eigen::Vector3d(before, 0.0, 0.0)}, .cut = true,
                            .to_placement = {.p = {before, 0.0, 0.0}}});
  const LinkageRun swings(linkage, {.duration = 0.3, .relative_tolerance = 1e-6, .absolute_tolerance = 1e-6});
  EXPECT_LT(swings.metric("steps"), 2000.0);
  EXPECT_LT(swings.metric("energy_residual"), 1e-5);
}

/// Three rods of 1 m in a row, from one pin on the ground to another.
Linkage make_chain(double pins_apart) {
  Linkage linkage;
  linkage.gravity_W = {0.0, -9.81, 0.0};
  std::string from = kGroundName;
  for (const char* const name : {"a", "b", "c"}) {
    linkage.bodies.push_back(make_body(name, 1.0, {0.5, 0.0, 0.0}, {1e-3, 0.1, 0.1}));
    linkage.joints.push_back({.name = name, .from = from, .to = name,
                              .placement = {.p = {from == kGroundName ? 0.0 : 1.0, 0.0, 0.0}},
                              .freedoms = {{.name = name, .guess = std::string(name) == "a" ? 0.1 : 0.0}}});
    from = name;
  }
  linkage.joints.push_back({.name = "pin", .from = kGroundName, .to = "c", .placement = {.p = {pins_apart, 0.0, 0.0}},
                            .cut = true, .to_placement = {.p = {1.0, 0.0, 0.0}}});
  return linkage;
}

// Where the pins are as far apart as the chain is long, no other position closes the loop.
TEST(TautChain, CannotMove) {
  Linkage taut = make_chain(3.0);
  for (LinkageJoint& joint : taut.joints)
    if (!joint.cut) joint.freedoms[0].start = 0.0;
  const RunResult stands = run(taut, 0.1);
  EXPECT_EQ(stands.status, RunStatus::kLockUp);
  EXPECT_EQ(stands.t_end, 0.0);
  EXPECT_EQ(run(make_chain(2.9), 0.1).status, RunStatus::kSucceeded);
}

TEST(Drives, EndAtOnceIfNoAccelerationSatisfiesThem) {
  Linkage linkage = make_parallelogram(Polynomial{{0.4, 1.0}}, 0.4);
  linkage.joints[2].freedoms[0] = {.name = "rocker", .drive = Polynomial{{0.4, 1.0, 1.0}}};
  EXPECT_EQ(run(linkage, 0.1).status, RunStatus::kLockUp);
}

// Open chains have no constraints that could decide them, whatever drives they have.
TEST(ChangePoint, IsNoneInAnOpenChain) {
  Linkage chain = make_parallelogram(Polynomial{{0.0, 1.0}}, 0.0);
  chain.joints.pop_back();
  EXPECT_EQ(run(chain, 0.1).status, RunStatus::kSucceeded);
}

/// The same mechanism with a rod of other mass.
Linkage with_rod(Linkage linkage, double mass) {
  linkage.bodies[1] = make_body("rod", mass, {0.5, 0.0, 0.0}, Eigen::Vector3d(1e-3, 0.085, 0.085) * mass);
  return linkage;
}

// Where drives determine the motion, a link's mass may vanish, and its share of the forces with it.
TEST(LightBody, FollowsTheLoopDownToNoMass) {
  const Linkage linkage = make_parallelogram(Polynomial{{0.4, 1.0}}, 0.4);
  const LinkageRun none(with_rod(linkage, 0.0), {.duration = 1.0});
  for (const double mass : {1e-12, 1e-9, 1e-6}) {
    const LinkageRun light(with_rod(linkage, mass), {.duration = 1.0});
    EXPECT_NEAR(light.metric("peak_crank_drive_n_m"), none.metric("peak_crank_drive_n_m"), 10.0 * mass + 1e-12);
    EXPECT_EQ(light.metric("steps"), none.metric("steps"));
  }
  // m g r cos(angle) of crank and rocker.
  EXPECT_NEAR(none.metric("peak_crank_drive_n_m"), 2.0 * 9.81 * 0.1 * std::cos(0.4), 1e-9);
}

// Nothing drives the linkage, so that loops are solved with masses.
TEST(LightBody, IsRefusedWithItsRatioWhereMassesDecide) {
  Linkage linkage = make_parallelogram(Polynomial{{0.4, 1.0}}, 0.4);
  linkage.joints[0].freedoms[0] = {.name = "crank", .start = 0.4, .start_rate = 1.0};
  EXPECT_EQ(run(with_rod(linkage, 1e-7), 0.5).status, RunStatus::kSucceeded);
  for (const double mass : {1e-9, 1e-12, 0.0}) {
    try {
      static_cast<void>(run(with_rod(linkage, mass), 0.5));
      ADD_FAILURE() << mass;
    } catch (const InvalidInput& refused) {
      EXPECT_EQ(refused.field(), "joints.pin") << mass;
    }
  }
}

/// A body on a joint with three turning freedoms, near theta = 90 degrees soon.
Linkage make_tumbling_body(JointKind kind) {
  Linkage linkage;
  linkage.gravity_W.setZero();
  linkage.bodies = {make_body("body", 1.0, {0.0, 0.0, 0.0}, {0.3, 0.4, 0.5})};
  std::vector<LinkageFreedom> freedoms;
  if (kind == JointKind::kFree)
    freedoms = {{.name = "x", .start = 0.0, .start_rate = 0.0},
                {.name = "y", .start = 0.0, .start_rate = 0.0},
                {.name = "z", .start = 0.0, .start_rate = 0.0}};
  freedoms.push_back({.name = "psi", .start = 0.0, .start_rate = 0.01});
  freedoms.push_back({.name = "theta", .start = 0.0, .start_rate = 3.0});
  freedoms.push_back({.name = "phi", .start = 0.0, .start_rate = 0.01});
  linkage.joints = {{.name = "joint", .kind = kind, .from = kGroundName, .to = "body", .placement = {},
                     .freedoms = freedoms}};
  return linkage;
}

/// Angular velocity of a free body by Euler's equations, in its own frame, and its rotation: by Runge and Kutta
/// on quaternions.
struct FreeBody {
  Eigen::Vector3d w;
  Eigen::Quaterniond q;
};
FreeBody derivative(const FreeBody& at) {
  const Eigen::Vector3d J(0.3, 0.4, 0.5), Jw = J.cwiseProduct(at.w);
  Eigen::Quaterniond rate = at.q * Eigen::Quaterniond(0.0, at.w.x(), at.w.y(), at.w.z());
  rate.coeffs() *= 0.5;
  return {Jw.cross(at.w).cwiseQuotient(J), rate};
}
FreeBody add(const FreeBody& to, double dt, const FreeBody& rate) {
  return {to.w + dt * rate.w, Eigen::Quaterniond(Eigen::Vector4d(to.q.coeffs() + dt * rate.q.coeffs()))};
}
FreeBody integrate_euler(FreeBody at, double duration) {
  constexpr int kSteps = 20000;
  const double dt = duration / kSteps;
  for (int k = 0; k < kSteps; ++k) {
    const FreeBody a = derivative(at), b = derivative(add(at, 0.5 * dt, a)), c = derivative(add(at, 0.5 * dt, b)),
                   d = derivative(add(at, dt, c));
    at = add(add(add(add(at, dt / 6.0, a), dt / 3.0, b), dt / 3.0, c), dt / 6.0, d);
  }
  return at;
}

struct TumblingCase {
  JointKind kind;
  Integrator integrator;
};
class TumblesThroughGimbalLock : public testing::TestWithParam<TumblingCase> {};

TEST_P(TumblesThroughGimbalLock, AsEulersEquationsSay) {
  constexpr double kDuration = 2.62;  // theta passes 90, 270 and 450 degrees
  const LinkageRun tumbled(make_tumbling_body(GetParam().kind),
                           {.duration = kDuration, .integrator = GetParam().integrator,
                            .relative_tolerance = 1e-9, .absolute_tolerance = 1e-9});
  const FreeBody exact = integrate_euler({{0.01, 3.0, 0.01}, Eigen::Quaterniond::Identity()}, kDuration);
  const Eigen::Quaterniond turned(tumbled.last("pose_body_qw"), tumbled.last("pose_body_qx"),
                                  tumbled.last("pose_body_qy"), tumbled.last("pose_body_qz"));
  EXPECT_LT(turned.angularDistance(exact.q), 1e-6);
  EXPECT_LT(tumbled.metric("energy_residual"), 1e-7);
  EXPECT_LT(tumbled.metric("steps"), 10000.0);
  // The angles reported are those of the joint as it was described.
  const Eigen::Quaterniond reported = Eigen::AngleAxisd(tumbled.last("psi_rad"), Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(tumbled.last("theta_rad"), Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(tumbled.last("phi_rad"), Eigen::Vector3d::UnitX());
  EXPECT_LT(reported.angularDistance(exact.q), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Everywhere, TumblesThroughGimbalLock,
                         testing::Values(TumblingCase{JointKind::kFree, Integrator::kRadau5},
                                         TumblingCase{JointKind::kFree, Integrator::kRodas5},
                                         TumblingCase{JointKind::kFree, Integrator::kAuto},
                                         TumblingCase{JointKind::kSpherical, Integrator::kRadau5},
                                         TumblingCase{JointKind::kSpherical, Integrator::kDopri5}));

TEST(TumblesThroughGimbalLock, AlsoFromTheSingularAngle) {
  Linkage linkage = make_tumbling_body(JointKind::kSpherical);
  linkage.joints[0].freedoms[1].start = 0.5 * std::numbers::pi;
  EXPECT_EQ(run(linkage, 0.5).status, RunStatus::kSucceeded);
}

/// A body held as by a hinge about y: by a joint of three turns, and a revolute or cylindrical one.
Linkage make_hinge_of_two(JointKind carrier, JointKind closing, double start) {
  Linkage linkage;
  linkage.gravity_W = {0.0, 0.0, -9.81};
  linkage.bodies = {make_body("body", 1.0, {0.2, 0.1, 0.05}, {0.01, 0.02, 0.025})};
  LinkageJoint joint{.name = "carrier", .kind = carrier, .from = kGroundName, .to = "body", .placement = {}};
  const std::size_t count = freedoms_of(joint).size();
  for (std::size_t k = 0; k < count; ++k) joint.freedoms.push_back({.name = "q" + std::to_string(k)});
  joint.freedoms[count - 2].start = start;
  const Eigen::Matrix3d to_y =
      Eigen::AngleAxisd(-0.5 * std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  linkage.joints = {joint,
                    {.name = "closing",
                     .kind = closing,
                     .from = kGroundName,
                     .to = "body",
                     .placement = {.R = to_y},
                     .cut = true,
                     .to_placement = {.R = to_y}}};
  linkage.accelerometers = {
      {.name = "sensor", .body = "body", .at = {0.1, 0.2, 0.3}, .direction = {1.0, 0.0, 0.0}}};
  return linkage;
}

// A right angle is a usual number: the start shows what one beside it does.
TEST(GimbalLock, AtTheStartIsNoneOfTheLinkage) {
  for (const double sign : {-1.0, 1.0})
    for (const JointKind carrier : {JointKind::kSpherical, JointKind::kFree})
      for (const JointKind closing : {JointKind::kRevolute, JointKind::kCylindrical, JointKind::kUniversal}) {
        const double right = sign * 0.5 * std::numbers::pi;
        const LinkageRun beside(make_hinge_of_two(carrier, closing, right - 1e-4), accurate(0.1));
        for (const double start : {right, right + 1e-9, sign * 1.5708}) {
          const LinkageRun run(make_hinge_of_two(carrier, closing, start), accurate(0.1));
          EXPECT_EQ(run.metric("redundant_constraints"), beside.metric("redundant_constraints"));
          for (const char* const shown :
               {"sensor_accelerometer_m_s2", "carrier_reaction_n", "kinetic_energy_j"}) {
            EXPECT_NEAR(run.column(shown)[0], beside.column(shown)[0], 2e-3) << shown << " from " << start;
            EXPECT_NEAR(run.last(shown), beside.last(shown), 2e-2) << shown << " from " << start;
          }
        }
      }
}

/// A driven crank with an upright rod on a ball joint, whose other end a guide keeps above the crank's start.
Linkage make_upright_rod(double start) {
  Linkage linkage;
  linkage.gravity_W = {0.0, 0.0, -9.81};
  linkage.bodies = {make_body("crank", 0.5, {0.0, 0.0, 0.0}, {1e-3, 1e-3, 1e-3}),
                    make_body("rod", 0.5, {0.15, 0.0, 0.0}, {4e-4, 0.015, 0.015}),
                    make_body("slider", 1.0, {0.0, 0.0, 0.0}, {1e-3, 1e-3, 1e-3})};
  linkage.joints = {
      {.name = "crank", .from = kGroundName, .to = "crank", .placement = {},
       .freedoms = {{.name = "crank", .drive = Polynomial{{start, 0.0, 3.0}}}}},
      {.name = "ball", .kind = JointKind::kSpherical, .from = "crank", .to = "rod", .placement = {.p = {0.1, 0.0, 0.0}},
       .freedoms = {{.name = "psi"}, {.name = "theta", .guess = -0.5 * std::numbers::pi}, {.name = "phi"}}},
      {.name = "guide", .kind = JointKind::kPrismatic, .from = kGroundName, .to = "slider", .placement = {.p = {0.1, 0.0, 0.0}},
       .freedoms = {{.name = "height", .guess = 0.3}}},
      {.name = "yoke", .kind = JointKind::kUniversal, .from = "rod", .to = "slider", .placement = {.p = {0.3, 0.0, 0.0}},
       .axes = {Axis::kY, Axis::kX}, .cut = true}};
  return linkage;
}

// A quarter turn of the ball joint at the start is no change point of a linkage that its drive moves.
TEST(GimbalLock, AtTheStartOfADrivenLinkageIsNoneOfIt) {
  const LinkageRun run(make_upright_rod(0.0), accurate(1.0)), beside(make_upright_rod(1e-5), accurate(1.0));
  for (const char* const shown : {"height_m", "height_m_s", "guide_reaction_n", "crank_drive_n_m"})
    EXPECT_NEAR(run.last(shown), beside.last(shown), 1e-3) << shown;
  const double across = 0.2 * std::sin(0.5 * 3.0);  // of the rod's ends
  EXPECT_NEAR(run.last("height_m"), std::sqrt(0.09 - across * across), 1e-6);
}

std::string refusal(const Linkage& linkage) {
  try {
    check_linkage(linkage);
    return "";
  } catch (const InvalidInput& fault) {
    return fault.what();
  }
}

/// A body on a hinge, held to the ground by a second joint that is turned.
Linkage make_turned(JointKind kind, const Eigen::Vector3d& about, double angle) {
  Linkage linkage;
  linkage.bodies = {make_body("body", 1.0, {0.1, 0.0, 0.0}, {1e-3, 1e-2, 1e-2})};
  linkage.joints = {{.name = "hinge", .from = kGroundName, .to = "body", .placement = {},
                     .freedoms = {{.name = "angle"}}},
                    {.name = "second", .kind = kind, .from = "body", .to = kGroundName, .placement = {}, .cut = true,
                     .to_placement = {.R = Eigen::AngleAxisd(angle, about).toRotationMatrix()}}};
  return linkage;
}

TEST(HalfTurn, IsAGap) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  for (const JointKind kind : {JointKind::kWeld, JointKind::kPrismatic, JointKind::kRevolute, JointKind::kCylindrical})
    for (const Eigen::Vector3d& about : {x, y})
      EXPECT_NE(refusal(make_turned(kind, about, std::numbers::pi)), "") << static_cast<int>(kind);
  // About its own axis the hinge turns into the right position.
  EXPECT_EQ(refusal(make_turned(JointKind::kWeld, z, std::numbers::pi)), "");
  EXPECT_EQ(refusal(make_turned(JointKind::kRevolute, z, std::numbers::pi)), "");
}

// Axes a right angle off, where scalar products pull nowhere.
TEST(RightAngle, ClosesFromTheGuess) {
  for (const JointKind kind :
       {JointKind::kWeld, JointKind::kPrismatic, JointKind::kRevolute, JointKind::kCylindrical})
    for (const int axis : {0, 1, 2})
      for (const double angle : {-0.5 * std::numbers::pi, 0.5 * std::numbers::pi}) {
        Linkage linkage = make_turned(kind, Eigen::Vector3d::Unit(axis), angle);
        linkage.joints[0].kind = JointKind::kSpherical;
        linkage.joints[0].freedoms = {{.name = "z"}, {.name = "y"}, {.name = "x"}};
        EXPECT_EQ(refusal(linkage), "") << static_cast<int>(kind) << " about axis " << axis;
      }
}

TEST(SmallMotion, KeepsItsEnergy) {
  Linkage linkage;
  linkage.gravity_W.setZero();
  linkage.bodies = {make_body("block", 1.0, {0.0, 0.0, 0.0}, {1e-3, 1e-3, 1e-3})};
  for (const double amplitude : {1e-3, 1e-6, 1e-9}) {
    linkage.joints = {{.name = "rail", .kind = JointKind::kPrismatic, .from = kGroundName, .to = "block",
                       .placement = {}, .freedoms = {{.name = "x", .start = amplitude, .stiffness = 1e6}}}};
    const LinkageRun vibrating(linkage, {.duration = 1.0});
    EXPECT_NEAR(vibrating.metric("peak_x_acceleration_m_s2"), 1e6 * amplitude, 1e3 * amplitude) << amplitude;
    EXPECT_LT(vibrating.metric("energy_residual"), 0.01) << amplitude;
  }
}

// Masses times a number, and no forces but theirs: the motion is the same.
TEST(MassScaling, ChangesNoStep) {
  for (const Integrator integrator : {Integrator::kAuto, Integrator::kRadau5, Integrator::kRodas5}) {
    std::vector<double> steps;
    for (const double factor : {1.0, 1e-2, 1e4}) {
      Linkage linkage = make_four_bar(JointKind::kRevolute);
      linkage.gravity_W.setZero();
      for (LinkageBody& body : linkage.bodies) {
        body.mass *= factor;
        body.inertia *= factor;
      }
      steps.push_back(LinkageRun(linkage, {.duration = 1.0, .integrator = integrator}).metric("steps"));
    }
    const auto [least, most] = std::ranges::minmax(steps);
    EXPECT_LE(most, 1.05 * least);
  }
}

TEST(Tolerance, CostsNoMoreIfItIsLooser) {
  for (const JointKind cut : {JointKind::kSpherical, JointKind::kUniversal, JointKind::kPrismatic}) {
    std::vector<double> steps;
    for (const double factor : {1.0, 0.1, 0.01, 5e-4}) {
      RunOptions options{.duration = 1.0};
      options.relative_tolerance *= factor;
      options.absolute_tolerance *= factor;
      steps.push_back(LinkageRun(make_spatial_slider_crank(cut), options).metric("steps"));
    }
    EXPECT_TRUE(std::ranges::is_sorted(steps)) << steps[0] << ' ' << steps[1] << ' ' << steps[2];
  }
}

/// A journal on a planar joint, in a bearing on the ground.
Linkage make_journal(double x) {
  Linkage linkage;
  ClearanceParameters clearance;
  clearance.c_r = 0.25e-3;
  linkage.gravity_W.setZero();
  linkage.bodies = {make_body("body", 1.0, {0.0, 0.0, 0.0}, {1e-2, 1e-2, 1e-2})};
  linkage.joints = {{.name = "plane", .kind = JointKind::kPlanar, .from = kGroundName, .to = "body",
                     .placement = {}, .freedoms = {{.name = "x", .start = x}, {.name = "y"}, {.name = "turn"}}},
                    {.name = "bearing", .from = "body", .to = kGroundName, .placement = {}, .cut = true,
                     .clearance = clearance}};
  return linkage;
}

TEST(Journal, MayStartAnywhereInItsClearance) {
  for (const double x : {0.0, 1e-4, 0.2e-3, 0.25e-3}) EXPECT_EQ(refusal(make_journal(x)), "") << x;
  for (const double x : {0.3e-3, -1e-3, 0.1}) EXPECT_NE(refusal(make_journal(x)), "") << x;
  const LinkageRun rests(make_journal(1e-4), {.duration = 0.05});
  EXPECT_NEAR(rests.last("x_m"), 1e-4, 1e-15);
}

}  // namespace
}  // namespace engine
