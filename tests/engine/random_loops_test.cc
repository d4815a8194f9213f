// SPDX-License-Identifier: Apache-2.0
// Loops of links drawn at random, with lengths and masses over orders of magnitude, at and near change points:
// nearly all runs end soon, or say why not, and keep their energy.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "engine/errors.h"
#include "engine/simulate_linkage.h"
#include "tests/engine/draw.h"
#include "tests/engine/linkage_cases.h"

namespace engine {
namespace {

/// A chain of rods whose last end is pinned where it is. Some lie flat at the start, but for a little.
Linkage draw_loop(Draw& draw) {
  const std::size_t links = 3 + draw.below(5);  // the ground is one more
  const bool flat = draw.happens(0.4);
  const double askew = draw.happens(0.5) ? 0.0 : std::pow(10.0, draw.within(-8.0, -2.0));
  const bool spatial = draw.happens(0.3);
  Linkage linkage;
  linkage.gravity_W = {0.0, -9.81, 0.0};
  Placement end;  // of the chain, at the angles of the start
  double before = 0.0;
  for (std::size_t k = 0; k < links; ++k) {
    const std::string name(1, static_cast<char>('a' + static_cast<int>(k)));
    const double length = std::pow(10.0, draw.within(-2.0, 1.0));
    const double mass = std::pow(10.0, draw.within(-3.0, 3.0));
    const double inertia = mass * length * length / 12.0;
    linkage.bodies.push_back(make_body(name, mass, {0.5 * length, 0.0, 0.0}, {0.01 * inertia, inertia, inertia}));
    const double angle = flat ? (draw.happens(0.5) ? 0.0 : std::numbers::pi) + askew * draw.within(-1.0, 1.0)
                              : draw.within(-std::numbers::pi, std::numbers::pi);
    LinkageJoint joint{.name = "to_" + name, .from = k == 0 ? kGroundName : linkage.bodies[k - 1].name,
                       .to = name, .placement = {.p = {before, 0.0, 0.0}}};
    if (spatial && k > 0 && draw.happens(0.5)) {
      joint.kind = JointKind::kUniversal;
      joint.axes = {Axis::kZ, Axis::kY};
      joint.freedoms = {{.name = name + "_1", .guess = angle}, {.name = name + "_2", .guess = 0.0}};
    } else {
      joint.freedoms = {{.name = name, .guess = angle}};
    }
    if (k == 0 && draw.happens(0.7)) {
      joint.freedoms[0].guess = 0.0;
      joint.freedoms[0].drive = draw.happens(0.5) ? DriveLaw{Polynomial{{angle, draw.within(-5.0, 5.0)}}}
                                                  : DriveLaw{RunUp{.omega = draw.within(-5.0, 5.0), .run_up = 0.1, .start = angle}};
    }
    linkage.joints.push_back(joint);
    end.p += end.R * joint.placement.p;
    end.R = end.R * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    before = length;
  }
  linkage.joints.push_back({.name = "close", .kind = spatial ? JointKind::kSpherical : JointKind::kRevolute, .from = kGroundName,
                            .to = linkage.bodies.back().name, .placement = {.p = end.p + end.R * Eigen::Vector3d(before, 0.0, 0.0)},
                            .cut = true, .to_placement = {.p = {before, 0.0, 0.0}}});
  return linkage;
}

double energy_residual(const Linkage& linkage, const RunResult& run) {
  const std::vector<QuantityInfo> metrics = linkage_tables(linkage).metrics;
  const auto found = std::ranges::find(metrics, "energy_residual", &QuantityInfo::key);
  return run.metrics.at(static_cast<std::size_t>(found - metrics.begin()));
}

int number_of_loops() {
  const char* const given = std::getenv("RPSUP_TEST_RANDOM_LOOPS");
  return given ? std::atoi(given) : 50;
}

TEST(RandomLoops, EndSoonOrSayWhyNot) {
  const int loops = number_of_loops();
  std::map<std::string_view, int> ends;
  for (int seed = 0; seed < loops; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(static_cast<unsigned>(seed));
    const Linkage linkage = draw_loop(draw);
    try {
      const RunResult run = simulate_linkage(linkage, {.duration = 0.5, .output_rate = 100.0, .step_limit = 100'000}, 0.0, {});
      ++ends[status_name(run.status)];
      if (run.status == RunStatus::kSucceeded) {
        EXPECT_LT(energy_residual(linkage, run), 1e-2);
      } else {
        EXPECT_FALSE(run.detail.empty());
      }
    } catch (const InvalidInput& refused) {
      ++ends["refused"];
      EXPECT_FALSE(refused.detail().empty());
    }
  }
  for (const auto& [end, count] : ends) std::printf("%d %.*s\n", count, static_cast<int>(end.size()), end.data());
  EXPECT_GE(ends[status_name(RunStatus::kSucceeded)], loops / 3);
  EXPECT_LE(ends[status_name(RunStatus::kStepLimit)], 3 + loops / 100);  // torn by their drives, with powers that grow without bound
}

}  // namespace
}  // namespace engine
