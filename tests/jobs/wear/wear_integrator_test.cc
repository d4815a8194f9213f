// SPDX-License-Identifier: Apache-2.0
// A bore that wears step by step, against closed forms.

#include "jobs/wear/wear_integrator.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/clearance/worn_bore.h"
#include "jobs/wear/pressed_arc.h"

namespace jobs_tests {
namespace {

using jobs::WearEvaluation;
using jobs::WearGrid;
using jobs::WearVerdict;
using std::numbers::pi;

constexpr std::size_t kSectors = 72;
constexpr double kClearance = 0.25e-3;
constexpr double kPenetration = 2e-6;
constexpr double kLoadedAt = 1.0;        // [rad]
constexpr double kWorkPerHour = 1.4e5;   // 100 N at 0.4 m/s, [J/h]
constexpr double kCoefficient = 1e-15;   // [m^2/N]
constexpr double kCell = 5e-3 * 2.0 * pi / kSectors * 20e-3;  // its area, [m^2]

WearEvaluation done(WearGrid rate) {
  return {.state = WearEvaluation::State::kDone, .rate_um_h = std::move(rate)};
}

WearGrid even(double value) { return {std::vector<double>(kSectors, value)}; }

/// A journal that turns under a load which stands still: all wear is where the load presses it into the bore,
/// on the arc that has become of it.
WearEvaluation press(const WearGrid& depth_um) {
  engine::WearDepth depth = depth_um;
  for (double& d : depth[0]) d *= 1e-6;
  const engine::WornBore bore(kClearance, depth);
  jobs::PressedArc arc(bore, 0, kClearance, kSectors);
  WearGrid rate = even(0.0);
  arc.add(1e6 * kCoefficient * kWorkPerHour / kCell, kLoadedAt, kPenetration, rate[0]);
  return done(rate);
}

jobs::WearHistory follow_wear(const jobs::WearRule& rule, WearGrid depth_um, const jobs::FindWear& find) {
  jobs::WearIntegrator integrator(rule, std::move(depth_um));
  integrator.advance(find);
  return integrator.history();
}

double volume_of(const WearGrid& depth_um) {
  double sum = 0.0;
  for (const double d : depth_um[0]) sum += 1e-6 * d * kCell;
  return sum;
}

// The same rate everywhere: depth = rate * hours, in as many steps as that takes.
TEST(WearIntegrator, WornEvenlyItIsAsDeepAsTheRateTimesTheHours) {
  const jobs::WearRule rule{.depth_step_um = 0.8, .hours = 100.0, .deepest_um = {}};
  const auto history = follow_wear(rule, even(0.0), [](const WearGrid&) { return done(even(0.05)); });
  EXPECT_EQ(history.verdict, WearVerdict::kHoursReached);
  ASSERT_EQ(history.cycles.size(), 1U + 7U);  // 5 um in steps of 0.8
  EXPECT_NEAR(history.cycles[1].hours, 16.0, 1e-12);
  EXPECT_DOUBLE_EQ(history.cycles.back().hours, 100.0);
  for (const double d : history.cycles.back().depth_um[0]) EXPECT_NEAR(d, 5.0, 1e-12);
  EXPECT_EQ(history.cycles.back().step_hours, 0.0);
}

TEST(WearIntegrator, EndsAtTheClearanceThatWasAskedFor) {
  const auto history = follow_wear({.hours = 1e6, .deepest_um = 2.5}, even(0.0),
                                   [](const WearGrid&) { return done(even(0.05)); });
  EXPECT_EQ(history.verdict, WearVerdict::kClearanceReached);
  EXPECT_NEAR(history.cycles.back().hours, 50.0, 1e-9);
  EXPECT_NEAR(jobs::largest_of(history.cycles.back().depth_um), 2.5, 1e-12);
}

// Archard: the volume is k N s, whatever the steps and however the bore gives way.
TEST(WearIntegrator, WearsTheVolumeOfASteadyLoadWhateverTheSteps) {
  for (const double step : {2.0, 1.0, 0.3}) {
    const auto history = follow_wear(
        {.depth_step_um = step, .rate_change = 10.0, .hours = 10.0, .deepest_um = {}}, even(0.0), press);
    EXPECT_EQ(history.verdict, WearVerdict::kHoursReached);
    const double expected = kCoefficient * kWorkPerHour * 10.0;
    EXPECT_NEAR(volume_of(history.cycles.back().depth_um), expected, 1e-9 * expected) << step;
  }
}

double depth_with_steps_of(double step_um) {
  const jobs::WearRule rule{
      .depth_step_um = step_um, .rate_change = 10.0, .hours = 5.0, .deepest_um = {}, .cycles = 1000};
  const auto history = follow_wear(rule, even(0.0), press);
  EXPECT_EQ(history.verdict, WearVerdict::kHoursReached);
  return jobs::largest_of(history.cycles.back().depth_um);
}

// Euler's method: half the step, half the error.
TEST(WearIntegrator, ConvergesWithTheFirstPowerOfTheStep) {
  const double fine = depth_with_steps_of(0.025);
  const double coarse = depth_with_steps_of(0.4) - fine;
  const double half = depth_with_steps_of(0.2) - fine;
  EXPECT_GT(std::abs(coarse), 1e-4);
  EXPECT_NEAR(coarse / half, 0.375 / 0.175, 0.3);  // errors of 0.4 and 0.2 less that of 0.025
}

// A bore that has long been worn is round where the journal lies, with the journal's own radius: c_r + g =
// |e| cos(phi - theta), but for what it is pressed in.
TEST(WearIntegrator, WearsTheBoreToTheShapeOfTheJournal) {
  const jobs::WearRule rule{
      .depth_step_um = 0.4, .rate_change = 10.0, .hours = 30.0, .deepest_um = {}, .cycles = 1000};
  const auto history = follow_wear(rule, even(0.0), press);
  const auto& depth = history.cycles.back().depth_um[0];
  engine::WearDepth bore_depth{depth};
  for (double& d : bore_depth[0]) d *= 1e-6;
  const engine::WornBore bore(kClearance, bore_depth);
  const double distance = kClearance + bore.calc_added_clearance(0, kLoadedAt).value;
  ASSERT_GT(distance - kClearance, 15e-6);
  int worn = 0;
  for (std::size_t s = 0; s < kSectors; ++s) {
    const double phi = 2.0 * pi * (static_cast<double>(s) + 0.5) / kSectors;
    if (depth[s] < 3.0) continue;
    ++worn;
    // and the last step
    EXPECT_NEAR(distance * std::cos(phi - kLoadedAt), kClearance + bore.calc_depth(0, phi),
                kPenetration + 0.4e-6)
        << phi;
  }
  EXPECT_GE(worn, 9);  // 45 degrees
}

// The rate of a bore deeper than 1 um is four times that of a round one: steps of 2 um across it are halved
// as long as they may be.
TEST(WearIntegrator, HalvesStepsAcrossWhichTheRateChanges) {
  const auto find = [](const WearGrid& depth) { return done(even(depth[0][0] < 1.0 ? 0.1 : 0.4)); };
  const auto history = follow_wear(
      {.depth_step_um = 2.0, .rate_change = 0.5, .hours = 20.0, .deepest_um = {}}, even(0.0), find);
  EXPECT_EQ(history.verdict, WearVerdict::kHoursReached);
  // 2 and 1 um are too long; half a one is none; then a whole one, twice as long again, is, and its half is,
  // and so on to the least.
  EXPECT_NEAR(history.cycles.at(1).depth_um[0][0], 0.5, 1e-12);
  EXPECT_GE(history.rejected, 3U);
  EXPECT_EQ(history.cycles.at(0).rate_change, std::nullopt);
  EXPECT_DOUBLE_EQ(history.cycles.at(1).rate_change.value(), 0.0);
  // No jump of the rate is passed with more than the least part of a step.
  for (std::size_t k = 1; k < history.cycles.size(); ++k) {
    if (history.cycles[k].rate_change.value() < 0.5) continue;
    EXPECT_LE(history.cycles[k].depth_um[0][0] - history.cycles[k - 1].depth_um[0][0], 0.25 + 1e-12);
  }
}

TEST(WearIntegrator, WaitsForWhatIsUnderWayAndEndsWhereItCannotGoOn) {
  const jobs::WearRule rule{.hours = 100.0, .deepest_um = {}, .cycles = 3};
  const auto unknown = follow_wear(rule, even(0.0), [](const WearGrid&) { return std::nullopt; });
  EXPECT_EQ(unknown.verdict, WearVerdict::kOpen);
  EXPECT_EQ(unknown.next, even(0.0));
  const auto pending = follow_wear(rule, even(0.0), [](const WearGrid&) { return WearEvaluation{}; });
  EXPECT_EQ(pending.verdict, WearVerdict::kOpen);
  EXPECT_FALSE(pending.next);
  const auto lost = follow_wear(
      rule, even(0.0), [](const WearGrid&) { return WearEvaluation{.state = WearEvaluation::State::kLost}; });
  EXPECT_EQ(lost.verdict, WearVerdict::kLost);
  const auto still = follow_wear(rule, even(0.0), [](const WearGrid&) { return done(even(0.0)); });
  EXPECT_EQ(still.verdict, WearVerdict::kNoWear);
  const auto slow = follow_wear(rule, even(0.0), [](const WearGrid&) { return done(even(0.1)); });
  EXPECT_EQ(slow.verdict, WearVerdict::kCycleLimit);
  EXPECT_EQ(slow.cycles.size(), 3U);
}

// As a study does: each time one more bore has been computed. Each is asked for when it is new and when it
// has been computed, and no more.
TEST(WearIntegrator, GoesOnWhereItWas) {
  const jobs::WearRule rule{.depth_step_um = 0.8, .hours = {}, .deepest_um = 10.0};
  std::vector<WearGrid> computed;
  int asked = 0;
  jobs::WearIntegrator integrator(rule, even(0.0));
  const auto find = [&](const WearGrid& depth) -> std::optional<WearEvaluation> {
    ++asked;
    return std::ranges::find(computed, depth) == computed.end() ? std::nullopt : std::optional(press(depth));
  };
  for (integrator.advance(find); integrator.history().next; integrator.advance(find))
    computed.push_back(*integrator.history().next);
  const auto at_once = follow_wear(rule, even(0.0), press);
  EXPECT_EQ(integrator.history().verdict, WearVerdict::kClearanceReached);
  ASSERT_EQ(integrator.history().cycles.size(), at_once.cycles.size());
  EXPECT_EQ(integrator.history().cycles.back().depth_um, at_once.cycles.back().depth_um);
  EXPECT_EQ(integrator.history().cycles.back().hours, at_once.cycles.back().hours);
  EXPECT_GT(computed.size(), 10U);
  EXPECT_EQ(static_cast<std::size_t>(asked), 2 * computed.size());
}

}  // namespace
}  // namespace jobs_tests
