// SPDX-License-Identifier: Apache-2.0
#include "engine/model/velocity_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/model/rpsup.h"
#include "engine/simulate_rpsup.h"

namespace engine {
namespace {

constexpr double kNoPoint = std::numeric_limits<double>::infinity();
const std::vector<double> kTimes{0.5, 1.0, 2.0, 2.5, 4.0}, kVelocities{1.0, 3.0, 2.0, 2.0, -1.0};

TEST(VelocityTable, GoesStraightBetweenItsPointsAndOnOutside) {
  const VelocityTable table(kTimes, kVelocities, TableInterpolation::kLinear, 0.3);
  for (std::size_t k = 0; k < kTimes.size(); ++k) EXPECT_NEAR(table.calc(kTimes[k]).qd, kVelocities[k], 1e-15);
  EXPECT_EQ(table.calc(0.0).qd, 1.0);
  EXPECT_EQ(table.calc(0.75).qd, 2.0);
  EXPECT_EQ(table.calc(0.75).qdd, 4.0);
  EXPECT_EQ(table.calc(9.0).qd, -1.0);
  EXPECT_EQ(table.calc(9.0).qdd, 0.0);
  // Areas of trapezia.
  EXPECT_NEAR(table.calc(0.0).q, 0.3, 1e-15);
  EXPECT_NEAR(table.calc(1.0).q, 0.3 + 0.5 + 1.0, 1e-15);
  EXPECT_NEAR(table.calc(4.0).q, 1.8 + 2.5 + 1.0 + 0.75, 1e-14);
  EXPECT_NEAR(table.calc(5.0).q, 6.05 - 1.0, 1e-14);
  EXPECT_NEAR(table.calc(-1.0).q, 0.3 - 1.0, 1e-15);
}

// Slopes by the formula of Fritsch and Butland, worked out by hand.
TEST(VelocityTable, HasTheSlopesOfTheMonotoneCubic) {
  const VelocityTable even({0.0, 1.0, 2.0, 3.0}, {0.0, 1.0, 4.0, 9.0}, TableInterpolation::kMonotoneCubic, 0.0);
  EXPECT_NEAR(even.calc(1.0).qdd, 1.5, 1e-14);        // 2 / (1/1 + 1/3)
  EXPECT_NEAR(even.calc(2.0).qdd, 3.75, 1e-14);       // 2 / (1/3 + 1/5)
  EXPECT_NEAR(even.calc(0.0).qdd, 0.0, 1e-14);        // (3 1 - 3)/2
  EXPECT_NEAR(even.calc(3.0 - 1e-13).qdd, 6.0, 1e-9); // (3 5 - 3)/2
  const VelocityTable uneven({0.0, 1.0, 3.0}, {0.0, 1.0, 5.0}, TableInterpolation::kMonotoneCubic, 0.0);
  EXPECT_NEAR(uneven.calc(1.0).qdd, 9.0 / (5.0 / 1.0 + 4.0 / 2.0), 1e-14);
}

TEST(VelocityTable, HasNoExtremesBetweenThePointsOfTheMonotoneCubic) {
  const VelocityTable table(kTimes, kVelocities, TableInterpolation::kMonotoneCubic, 0.0);
  for (std::size_t k = 0; k + 1 < kTimes.size(); ++k) {
    const double low = std::min(kVelocities[k], kVelocities[k + 1]), high = std::max(kVelocities[k], kVelocities[k + 1]);
    for (int i = 0; i <= 50; ++i) {
      const double v = table.calc(kTimes[k] + (kTimes[k + 1] - kTimes[k]) * i / 50.0).qd;
      EXPECT_GE(v, low - 1e-14);
      EXPECT_LE(v, high + 1e-14);
    }
  }
  EXPECT_EQ(table.calc(1.0).qdd, 0.0) << "an extreme";
  EXPECT_NEAR(table.calc(2.2).qd, 2.0, 1e-14) << "between equal points";
}

TEST(VelocityTable, IsTheDerivativeOfItsPosition) {
  constexpr double h = 1e-4;
  for (const TableInterpolation kind : {TableInterpolation::kLinear, TableInterpolation::kMonotoneCubic}) {
    const VelocityTable table(kTimes, kVelocities, kind, 0.3);
    EXPECT_NEAR(table.calc(0.0).q, 0.3, 1e-15);
    for (const double t : {0.2, 0.7, 1.3, 2.2, 3.1, 5.0}) {
      const DrivenMotion before = table.calc(t - h), at = table.calc(t), after = table.calc(t + h);
      EXPECT_NEAR(at.qd, (after.q - before.q) / (2.0 * h), 1e-7) << t;
      EXPECT_NEAR(at.qdd, (after.qd - before.qd) / (2.0 * h), 1e-7) << t;
      EXPECT_NEAR(at.qddd, (after.qdd - before.qdd) / (2.0 * h), 1e-6) << t;
    }
    for (const double t : kTimes) EXPECT_NEAR(table.calc(t - 1e-9).q, table.calc(t + 1e-9).q, 1e-8) << "continuous";
  }
}

TEST(VelocityTable, TellsWhereItsAccelerationJumps) {
  const VelocityTable straight(kTimes, kVelocities, TableInterpolation::kLinear, 0.0);
  EXPECT_EQ(straight.next_jump(0.0), 0.5);
  EXPECT_EQ(straight.next_jump(0.5), 1.0);
  EXPECT_EQ(straight.next_jump(4.0), kNoPoint);
  const VelocityTable smooth(kTimes, kVelocities, TableInterpolation::kMonotoneCubic, 0.0);
  EXPECT_EQ(smooth.next_point(0.5), 1.0);
  EXPECT_EQ(smooth.next_jump(0.0), 0.5) << "the velocity is constant before the first point";
  EXPECT_EQ(smooth.next_jump(0.5), 4.0);
}

// At an extreme the slope is 0, and that of the piece before it a rounding.
TEST(VelocityTable, JumpsNowhereInsideTheMonotoneCubic) {
  std::vector<double> t, v;
  for (int k = 0; k < 1000; ++k) {
    t.push_back(0.01 * k);
    v.push_back(10.0 + std::sin(20.0 * t.back()) + 0.1 * std::sin(777.0 * k));
  }
  const VelocityTable table(t, v, TableInterpolation::kMonotoneCubic, 0.0);
  EXPECT_EQ(table.next_jump(0.0), t.back());
}

// The same law by another name.
TEST(RpsupDrives, GiveTheBytesOfTheirParameters) {
  RpsupParameters named;
  named.run_up = 0.1;
  const RunOptions options{.duration = 0.2};
  RpsupParameters given = named;
  given.crank_velocity = 3.0;
  given.rod_stroke = 0.02;
  given.crank_drive = RunUp{.omega = 10.0, .run_up = 0.1};
  given.rod_drive = RiseReturnPause{.stroke = 0.015, .stroke_time = 0.5, .pause = 0.5, .law = StrokeLaw::kCosine};
  given.rod_start = named.rod_length;
  named.rod_start = named.rod_length;
  const RunResult by_names = simulate_rpsup(named, options, {}), by_laws = simulate_rpsup(given, options, {});
  ASSERT_EQ(by_laws.status, RunStatus::kSucceeded) << by_laws.detail;
  EXPECT_EQ(by_laws.trajectory.columns, by_names.trajectory.columns);
}

// Straight pieces add up to a constant acceleration, as a parabola has it.
TEST(RpsupDrives, FollowATableExactly) {
  const RunOptions options{.duration = 0.3, .output_rate = 100.0, .relative_tolerance = 1e-9, .absolute_tolerance = 1e-9};
  RpsupParameters parameters;
  parameters.run_up = 0.1;
  parameters.crank_drive = VelocityTable({0.0, 0.07, 0.3}, {0.0, 1.4, 6.0}, TableInterpolation::kLinear, 0.2);
  const RunResult by_table = simulate_rpsup(parameters, options, {});
  parameters.crank_drive = Polynomial{{0.2, 0.0, 10.0}};
  const RunResult by_parabola = simulate_rpsup(parameters, options, {});
  ASSERT_EQ(by_table.status, RunStatus::kSucceeded) << by_table.detail;
  ASSERT_EQ(by_parabola.status, RunStatus::kSucceeded) << by_parabola.detail;
  for (std::size_t k = 0; k < by_table.trajectory.channels.size(); ++k) {
    if (by_table.trajectory.channels[k].key != "slider_acceleration_m_s2") continue;
    for (std::size_t i = 0; i < by_table.trajectory.columns[k].size(); ++i)
      EXPECT_NEAR(by_table.trajectory.columns[k][i], by_parabola.trajectory.columns[k][i], 1e-3) << i;
  }
}

}  // namespace
}  // namespace engine
