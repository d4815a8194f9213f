// What the validation's chapter on kinematics leaves open of the linkage without clearance.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/simulate_rpsup.h"
#include "engine/validation/support/runs.h"

namespace engine {
namespace {

using validation::column;

// Samples fall between the instants of the solution too, and energy and work must be of one instant.
TEST(IdealLinkage, EnergyAndWorkOfASampleBelongTogether) {
  RpsupParameters parameters;
  parameters.c_r = 0.0;
  const RunResult run = simulate_rpsup(parameters, {.duration = 2.3, .output_rate = 1300.0}, {});
  ASSERT_EQ(run.status, RunStatus::kSucceeded) << run.detail;
  double worst = 0.0;
  for (const double residual : column(run, "energy_residual")) worst = std::max(worst, std::abs(residual));
  EXPECT_LT(worst, 1e-8);  // the cubic in a step of 0.25 ms
}

}  // namespace
}  // namespace engine
