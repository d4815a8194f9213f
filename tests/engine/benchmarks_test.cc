// SPDX-License-Identifier: Apache-2.0
// Public benchmark problems of multibody dynamics, each as a linkage of data.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/clearance/normal_law.h"
#include "engine/model/linkage.h"
#include "engine/simulate.h"
#include "engine/simulate_linkage.h"
#include "tests/engine/linkage_cases.h"

namespace engine {
namespace {

constexpr double kPi = std::numbers::pi;

/// Keeps samples, and how far the energy account strays.
class Course : public Observer {
 public:
  void on_step(const Evaluation&, const Evaluation&) override {}
  void on_sample(const Evaluation& at) override {
    samples.push_back(at);
    imbalance = std::max(imbalance, std::abs(at.energy.calc_balance() - samples.front().energy.calc_balance()));
  }
  void on_onsets(int, int) override {}
  bool stop_requested(double) override { return false; }

  std::vector<Evaluation> samples;
  double imbalance = 0.0;
};

LinkageBody make_benchmark_rod(const std::string& name, double mass, double length) {
  const Eigen::Vector3d inertia = Eigen::Vector3d(0.0, 1.0, 1.0) * (mass * length * length / 3.0);
  return {.name = name, .mass = mass, .com = {0.5 * length, 0.0, 0.0}, .inertia = inertia.asDiagonal()};
}

RunOptions benchmark_options(double duration, double tolerance) {
  return {.duration = duration, .output_rate = 100.0, .integrator = Integrator::kDopri5, .relative_tolerance = tolerance,
          .absolute_tolerance = tolerance};
}

double metric(const Linkage& linkage, const RunResult& run, const std::string& key) {
  const std::vector<QuantityInfo> table = linkage_tables(linkage).metrics;
  for (std::size_t k = 0; k < table.size(); ++k)
    if (table[k].key == key) return run.metrics.at(k);
  throw std::out_of_range("no metric " + key);
}

// A point mass of 1 kg on a massless bar of 1 m falls from the horizontal. Source: problem A01 of M. Gonzalez et al., Multibody System
// Dynamics 16 (2006), and the benchmark library of IFToMM's technical committee for multibody dynamics.
TEST(Benchmarks, PointPendulum) {
  Linkage linkage;
  linkage.bodies = {{.name = "bar", .mass = 1.0, .com = {-1.0, 0.0, 0.0}, .inertia = Eigen::Vector3d(0.0, 1.0, 1.0).asDiagonal()}};
  linkage.joints = {{.name = "pivot", .from = kGroundName, .to = "bar", .placement = {}, .freedoms = {{.name = "angle"}}}};
  linkage.gravity_W = {0.0, -9.81, 0.0};
  Course course;
  ASSERT_EQ(simulate(build_linkage(linkage).mechanism, benchmark_options(10.0, 1e-10), course).status, RunStatus::kSucceeded);
  const FrameMotion& bar = course.samples.back().frames[0];
  const Eigen::Vector3d point = bar.p - bar.R.col(0);
  EXPECT_NEAR(point.x(), -0.275087, 1e-6);
  EXPECT_NEAR(point.y(), -0.961419, 1e-6);
}

/// N windows in a row: uprights B_0 ... B_N on the ground, 1 m apart, joined by bars; each 1 m and 1 kg.
Linkage make_windows(int n) {
  Linkage linkage;
  linkage.gravity_W = {0.0, -9.81, 0.0};
  const Eigen::Matrix3d up = (Eigen::Matrix3d() << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0).finished();
  for (int k = 0; k <= n; ++k) {
    const std::string upright = "upright" + std::to_string(k);
    linkage.bodies.push_back(make_benchmark_rod(upright, 1.0, 1.0));
    linkage.joints.push_back({.name = "foot" + std::to_string(k), .from = kGroundName, .to = upright,
                              .placement = {up, {static_cast<double>(k), 0.0, 0.0}},
                              .freedoms = {{.name = upright, .start_rate = k == 0 ? std::optional(-1.0) : std::nullopt}}});
  }
  for (int k = 0; k < n; ++k) {
    const std::string bar = "bar" + std::to_string(k);
    linkage.bodies.push_back(make_benchmark_rod(bar, 1.0, 1.0));
    linkage.joints.push_back({.name = "hinge" + std::to_string(k), .from = "upright" + std::to_string(k), .to = bar,
                              .placement = {up.transpose(), {1.0, 0.0, 0.0}}, .freedoms = {{.name = bar}}});
    linkage.joints.push_back({.name = "closing" + std::to_string(k), .from = "upright" + std::to_string(k + 1), .to = bar,
                              .placement = {Eigen::Matrix3d::Identity(), {1.0, 0.0, 0.0}}, .cut = true,
                              .to_placement = {Eigen::Matrix3d::Identity(), {1.0, 0.0, 0.0}}});
  }
  return linkage;
}

Eigen::Vector3d tip_of(const Evaluation& at, std::size_t frame) { return at.frames[frame].p + at.frames[frame].R.col(0); }

class Windows : public testing::Test {
 protected:
  void run(double duration) {
    const RunOutcome end = simulate(build_linkage(make_windows(40)).mechanism, benchmark_options(duration, 1e-8), course);
    ASSERT_EQ(end.status, RunStatus::kSucceeded) << end.detail << " at " << end.t;
    EXPECT_EQ(end.redundant_constraints, 120);  // out of the plane: a position and two turns of each window
  }
  void expect_tip_at(double t, double x, double y) {
    const Eigen::Vector3d tip = tip_of(course.samples.at(static_cast<std::size_t>(100.0 * t)), 0);
    EXPECT_NEAR(tip.x(), x, 1e-6);
    EXPECT_NEAR(tip.y(), y, 1e-6);
  }
  Course course;
};

// Problem A02 of the same library, N = 40. At 0.7 s all bars lie in one line: for an instant the linkage has N + 1 freedoms.
TEST_F(Windows, PassOneSingularPosition) {
  run(1.0);
  expect_tip_at(1.0, -0.115357, -0.993324);
}

// All of A02's ten seconds, with every singular position on the way.
TEST_F(Windows, HeavyPassAllSingularPositions) {
  run(10.0);
  expect_tip_at(1.0, -0.115357, -0.993324);
  expect_tip_at(10.0, 0.180512, 0.983573);
}

// Source: E. J. Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems (1989), section 12.2; the values at 5 s are those of the
// benchmark library of IFToMM's technical committee for multibody dynamics. The rod turns about a pin that stays perpendicular to the slide.
TEST(Benchmarks, SpatialSliderCrank) {
  Course course;
  const RunOutcome end = simulate(build_linkage(make_spatial_slider_crank(JointKind::kSpherical)).mechanism, benchmark_options(5.0, 1e-11), course);
  ASSERT_EQ(end.status, RunStatus::kSucceeded) << end.detail;
  EXPECT_EQ(end.redundant_constraints, 0);
  EXPECT_NEAR(course.samples.back().q[0], 51.36943989, 2e-8);
  EXPECT_NEAR(course.samples.back().q[1], 0.254650085, 1e-9);
}

/// Slider-crank of P. Flores et al., Kinematics and Dynamics of Multibody Systems with Imperfect Joints (2008): the clearance is between rod
/// and slider, in the plane, without friction and gravity.
Linkage make_flores_slider_crank() {
  ClearanceParameters clearance;
  clearance.r_b = 10e-3;
  clearance.c_r = 0.5e-3;
  clearance.c_a = 1.0;
  clearance.n_r = 1;
  clearance.chi = calc_damping_factor(NormalForceLaw::kLankaraniNikravesh, 0.9);
  clearance.K = calc_hertz_stiffness(10e-3, 0.5e-3, 207e9, 0.3);
  Linkage linkage;
  linkage.bodies = {make_body("crank", 0.3, {0.025, 0.0, 0.0}, {1e-5, 1e-4, 1e-4}),
                    make_body("rod", 0.21, {0.06, 0.0, 0.0}, {2.5e-5, 2.5e-4, 2.5e-4}),
                    make_body("slider", 0.14, {0.0, 0.0, 0.0}, {1e-5, 1e-5, 1e-5})};
  linkage.joints = {
      {.name = "crank", .from = kGroundName, .to = "crank", .placement = {},
       .freedoms = {{.name = "crank", .drive = RunUp{5000.0 * 2.0 * kPi / 60.0, 0.0}}}},
      {.name = "pin", .from = "crank", .to = "rod", .placement = {.p = {0.05, 0.0, 0.0}}, .freedoms = {{.name = "rod"}}},
      {.name = "slide", .kind = JointKind::kPrismatic, .from = kGroundName, .to = "slider", .placement = {}, .axes = {Axis::kX, Axis::kY},
       .freedoms = {{.name = "slide", .guess = 0.17}}},
      {.name = "bearing", .from = "slider", .to = "rod", .placement = {}, .cut = true, .to_placement = {.p = {0.12, 0.0, 0.0}},
       .clearance = clearance}};
  return linkage;
}

/// Waits for the first impact.
class FirstImpact : public Course {
 public:
  void on_step(const Evaluation&, const Evaluation& end) override {
    const JournalMotion& journal = end.joints[0].journal;
    if (t > 0.0 || !(end.joints[0].load.max_penetration > 0.0)) return;
    t = end.t;
    speed = journal.v.dot(journal.p_bj) / journal.p_bj.norm();
  }
  double t = 0.0, speed = 0.0;
};

TEST(Benchmarks, SliderCrankWithClearance) {
  const Linkage linkage = make_flores_slider_crank();
  FirstImpact impact;
  ASSERT_EQ(simulate(build_linkage(linkage).mechanism, benchmark_options(3e-4, 1e-11), impact).status, RunStatus::kSucceeded);
  EXPECT_NEAR(impact.t, 2.27286e-4, 1e-9);
  EXPECT_NEAR(impact.speed, 4.385783, 2e-6);
  const RunResult run = simulate_linkage(linkage, benchmark_options(0.024, 1e-10), 0.0, {});
  ASSERT_EQ(run.status, RunStatus::kSucceeded) << run.detail;
  EXPECT_NEAR(metric(linkage, run, "peak_slide_acceleration_m_s2"), 3.2734e5, 5e0);
  EXPECT_GE(metric(linkage, run, "impact_count"), 1.0);
}

/// Bars along six edges of a cube, each joint's axis at right angles to both of its bars: six revolute joints that Gruebler's formula holds for
/// rigid. Bars of 1 m and 1 kg with a square section of 0.1 m.
Linkage make_bricard() {
  const std::array<Eigen::Vector3d, 7> corner{Eigen::Vector3d(0, 0, 0), {1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}, {0, 0, 1}, {0, 0, 0}};
  Linkage linkage;
  linkage.gravity_W = {0.0, -9.81, 0.0};
  Eigen::Matrix3d last_R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d last_p = Eigen::Vector3d::Zero();
  std::string last = kGroundName;
  // Ground is the edge from corner 5 to corner 0.
  for (std::size_t k = 0; k < 5; ++k) {
    const Eigen::Vector3d x = corner[k + 1] - corner[k];
    const Eigen::Vector3d before = corner[k] - corner[k == 0 ? 5 : k - 1];
    const Eigen::Vector3d z = before.cross(x);
    Eigen::Matrix3d R;
    R << x, z.cross(x), z;
    const std::string name = "bar" + std::to_string(k);
    linkage.bodies.push_back(make_benchmark_rod(name, 1.0, 1.0));
    linkage.bodies.back().inertia = Eigen::Vector3d(0.1 * 0.1 / 6.0, 1.0 / 3.0 + 0.01 / 12.0, 1.0 / 3.0 + 0.01 / 12.0).asDiagonal();
    linkage.joints.push_back({.name = name, .from = last, .to = name,
                              .placement = {last_R.transpose() * R, last_R.transpose() * (corner[k] - last_p)},
                              .freedoms = {{.name = name, .start = 0.0}}});
    last_R = R;
    last_p = corner[k];
    last = name;
  }
  const Eigen::Vector3d x = corner[5] - corner[4];
  const Eigen::Vector3d z = x.cross(Eigen::Vector3d(corner[6] - corner[5]));
  Eigen::Matrix3d R;
  R << x, z.cross(x), z;
  linkage.joints.push_back({.name = "closing", .from = last, .to = kGroundName, .placement = {last_R.transpose() * R, {1.0, 0.0, 0.0}}, .cut = true,
                            .to_placement = {R, corner[5]}});
  return linkage;
}

// Problem A04 of the library: the linkage moves, though its 30 + 5 constraints leave 36 - 35 = 1 and five rows of the six close the loop.
TEST(Benchmarks, BricardKeepsItsEnergy) {
  Course course;
  const RunOutcome end = simulate(build_linkage(make_bricard()).mechanism, benchmark_options(10.0, 1e-12), course);
  ASSERT_EQ(end.status, RunStatus::kSucceeded) << end.detail;
  EXPECT_EQ(end.redundant_constraints, 1);
  const double energy = course.samples.front().energy.calc_balance();
  EXPECT_LT(course.imbalance, 1e-9 * energy);
  double fastest = 0.0;
  for (const Evaluation& at : course.samples) fastest = std::max(fastest, at.energy.kinetic);
  EXPECT_GT(fastest, energy);  // it falls: what is constant is more than what is at rest
}

}  // namespace
}  // namespace engine
