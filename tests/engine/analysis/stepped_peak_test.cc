// SPDX-License-Identifier: Apache-2.0
// Peaks of loads inside integration steps: of a given function of time, and of whole runs against fine ones.

#include "engine/analysis/stepped_peak.h"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "engine/simulate_rpsup.h"
#include "validation/support/across_rpsup.h"
#include "validation/support/runs.h"

namespace engine {
namespace {

using validation::metric;

/// Takes a function by steps of h from t = 0 on. @returns how often a middle was taken
template <typename Function>
int take_all(const Function& f, double h, int steps, SteppedPeak& peak) {
  int middles = 0;
  for (int k = 0; k < steps; ++k) {
    const double t0 = h * k;
    if (!peak.take_step(f(t0), f(t0 + h), t0, t0 + h)) continue;
    ++middles;
    peak.take_middle(f(t0 + 0.5 * h));
  }
  return middles;
}

// A half sine, as an impact's force is: the parabola on half a step is off by (h / 2)^4 / 64 at most, 4e-7 of it at h = 0.14; the ends by h^2 / 8.
TEST(SteppedPeak, FindsTheTopOfASineInsideItsStep) {
  for (const double sign : {1.0, -1.0})
    for (const double phase : {0.05, 0.3, 0.5, 0.7, 0.95}) {
      constexpr double kStep = 0.14;
      const double top = kStep * (11.0 + phase);
      SteppedPeak peak;
      const int middles = take_all([&](double t) { return sign * std::cos(t - top); }, kStep, 20, peak);
      EXPECT_NEAR(peak.peak().magnitude, 1.0, 1e-6) << phase;
      EXPECT_NEAR(peak.peak().t, top, 1e-3) << phase;
      EXPECT_LE(middles, 4) << phase;  // of 20 steps
    }
}

TEST(SteppedPeak, TakesTheEndsWhereNothingTurns) {
  SteppedPeak peak;
  EXPECT_EQ(take_all([](double t) { return 1.0 - 4.0 * t; }, 0.1, 10, peak), 1);  // the first step, which has none before it
  EXPECT_DOUBLE_EQ(peak.peak().magnitude, 3.0);
  EXPECT_DOUBLE_EQ(peak.peak().t, 1.0);
}

TEST(SteppedPeak, LeavesLowerTurnsAlone) {
  SteppedPeak peak;
  (void)take_all([](double t) { return t < 1.0 ? 2.0 - t : std::cos(t); }, 0.1, 10, peak);
  EXPECT_FALSE(peak.take_step(0.9, 0.9, 1.0, 1.1));
}

// The journal drops and bounces. Read at the ends of these steps, the contact force would be 0.7 % low.
TEST(SteppedPeak, LoadsOfLongStepsAreThoseOfFineOnes) {
  RunOptions options{.duration = 0.1, .integrator = Integrator::kDopri5, .relative_tolerance = 1e-9, .absolute_tolerance = 1e-9};
  const RunResult fine = simulate_rpsup(validation::across_rpsup(), options, {});
  options.integrator = Integrator::kRodas5;
  options.relative_tolerance = options.absolute_tolerance = 3e-5;
  const RunResult coarse = simulate_rpsup(validation::across_rpsup(), options, {});
  ASSERT_EQ(fine.status, RunStatus::kSucceeded) << fine.detail;
  ASSERT_EQ(coarse.status, RunStatus::kSucceeded) << coarse.detail;
  ASSERT_LT(metric(coarse, "steps"), 0.2 * metric(fine, "steps"));
  for (const std::string key : {"peak_contact_force_n", "max_penetration_um", "peak_crank_torque_n_m", "peak_joint_reaction_n"}) {
    const double peak = metric(fine, key);
    EXPECT_NEAR(metric(coarse, key), peak, 1e-3 * peak) << key;
  }
}

}  // namespace
}  // namespace engine
