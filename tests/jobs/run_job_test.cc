// SPDX-License-Identifier: Apache-2.0
// The layer with the real engine behind it.

#include <cmath>
#include <cstddef>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/results/csv.h"
#include "jobs/run_job.h"
#include "jobs/service.h"
#include "tests/jobs/request_support.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using nlohmann::json;
using std::numbers::pi;

std::vector<double> column_of(const engine::Trajectory& trajectory, const std::string& key) {
  for (std::size_t i = 0; i < trajectory.channels.size(); ++i) {
    if (trajectory.channels[i].key == key) return trajectory.columns[i];
  }
  ADD_FAILURE() << "no channel " << key;
  return {};
}

// The ideal rigid linkage is pure kinematics: z = r cos(psi) + sqrt(l^2 - z_g^2 - (r sin(psi) - y_g)^2), r =
// 0.15 m + the stroke's part by the cosine law. The crank's angle is the integral of the cycloidal law.
TEST(RunJob, SimulatesTheIdealLinkage) {
  const jobs::Outcome outcome =
      jobs::run_job({{"clearance_mm", 0}, {"duration_s", 0.2}}, [](double) { return false; });
  EXPECT_EQ(outcome.job.at("state"), "succeeded");
  EXPECT_EQ(outcome.job.at("parameters").at("duration_s"), 0.2);
  EXPECT_FALSE(outcome.job.contains("id"));
  const auto angle = column_of(outcome.trajectory, "crank_angle_rad");
  const auto rod = column_of(outcome.trajectory, "rod_displacement_m");
  const auto slider = column_of(outcome.trajectory, "slider_position_m");
  ASSERT_EQ(slider.size(), 201U);
  for (std::size_t k = 0; k < slider.size(); ++k) {
    const double t = 1e-3 * static_cast<double>(k), u = t / 2.0;
    const double psi = 10.0 * 2.0 * (0.5 * u * u + (std::cos(2.0 * pi * u) - 1.0) / (4.0 * pi * pi));
    const double r = 0.15 + 0.015 * 0.5 * (1.0 - std::cos(pi * t / 0.5));
    const double y = r * std::sin(psi);
    EXPECT_NEAR(angle[k], psi, 1e-6) << k;
    EXPECT_NEAR(rod[k], r - 0.2, 1e-6) << k;
    EXPECT_NEAR(slider[k], r * std::cos(psi) + std::sqrt(0.25 - 0.24 * 0.24 - y * y), 1e-6) << k;
  }
}

// The guide is turned about y, and the crank begins elsewhere: z = x_S + sqrt(l^2 - y_S^2 - z_S^2) with the
// place (x_S, y_S, z_S) of the S joint in the guide's frame.
TEST(RunJob, SimulatesTheIdealLinkageWithAGuideThatIsTurned) {
  const double tilt = pi / 12.0;
  const json given{{"clearance_mm", 0},      {"duration_s", 0.6},     {"run_up_s", 0},
                   {"crank_start_rad", 0.5}, {"guide_angle_deg", 15}, {"guide_offset_y_m", 0.03},
                   {"rod_law", "parabolic"}, {"rod_start_m", 0.12},   {"rod_stroke_mm", -20}};
  const jobs::Outcome outcome = jobs::run_job(given, [](double) { return false; });
  ASSERT_EQ(outcome.job.at("state"), "succeeded") << outcome.job.at("error");
  const auto slider = column_of(outcome.trajectory, "slider_position_m");
  ASSERT_EQ(slider.size(), 601U);
  for (std::size_t k = 0; k < slider.size(); ++k) {
    const double t = 1e-3 * static_cast<double>(k), psi = 0.5 + 10.0 * t;
    const double u = t <= 0.5 ? t / 0.5 : 2.0 - t / 0.5;  // the return goes back the same way
    const double r = 0.12 - 0.02 * (u < 0.5 ? 2.0 * u * u : 1.0 - 2.0 * (1.0 - u) * (1.0 - u));
    const double x = r * std::cos(psi), y = r * std::sin(psi) - 0.03, z = -0.24;
    const double along = x * std::cos(tilt) + z * std::sin(tilt),
                 beside = -x * std::sin(tilt) + z * std::cos(tilt);
    EXPECT_NEAR(slider[k], along + std::sqrt(0.25 - y * y - beside * beside), 1e-6) << k;
  }
}

TEST(RunJob, BendsEveryLinkThatIsFlexible) {
  const json given = json_of(
      R"({"clearance_mm": 0, "duration_s": 0.1, "run_up_s": 0.05, "coupler": "flexible", "crank": "flexible",
                                 "rod": "flexible", "cross": "flexible", "cross_length_mm": 100,
         "crank_elements": 3, "rod_elements": 5})");
  const jobs::Outcome outcome = jobs::run_job(given, [](double) { return false; });
  ASSERT_EQ(outcome.job.at("state"), "succeeded") << outcome.job.at("error");
  std::set<std::string> channels;
  for (const auto& channel : outcome.trajectory.channels) channels.insert(channel.key);
  for (const char* key : {"crank_deflection_mm", "rod_deflection_mm", "cross_deflection_mm", "pose_1_1_2_x_m",
                          "pose_1_2_4_x_m", "pose_2_2_3_qw"})
    EXPECT_TRUE(channels.contains(key)) << key;
  EXPECT_FALSE(channels.contains("pose_1_1_3_x_m"));
  EXPECT_GT(outcome.job.at("metrics").at("structural_loss_j"), 0.0);
  EXPECT_LT(outcome.job.at("metrics").at("energy_residual"), 1e-6);
}

TEST(RunJob, StopsWhenAsked) {
  const jobs::Outcome outcome =
      jobs::run_job({{"duration_s", 100}, {"output_rate_hz", 10}}, [](double t) { return t > 0.01; });
  EXPECT_EQ(outcome.job.at("state"), "cancelled");
  EXPECT_TRUE(outcome.job.at("metrics").is_null());
}

TEST(Service, ComputesWithTheEngineWhatRunJobComputes) {
  const TemporaryStore store;
  jobs::ServiceOptions options;
  options.store = store.file();
  jobs::Service service(options);
  const json sweep = service.submit_sweep(request_of(
      R"({"parameters": {"duration_s": 0.05}, "sweep": {"coupler": ["rigid", "flexible"], "clearance_mm": [0,
         0.25]}})"));
  ASSERT_TRUE(service.wait_for_sweep(sweep.at("id"), std::chrono::minutes(2)));
  const auto rows = service.find_results(sweep.at("id")).value().rows;
  ASSERT_EQ(rows.size(), 4U);
  for (const auto& row : rows) {
    const json stored = service.find_job(row.at(0)).value();
    const jobs::Outcome direct = jobs::run_job(stored.at("parameters"), [](double) { return false; });
    EXPECT_EQ(stored.at("state"), "succeeded") << stored.at("error");
    EXPECT_EQ(stored.at("metrics"), direct.job.at("metrics"));
    EXPECT_EQ(jobs::to_csv(service.find_trajectory(row.at(0), {}).value()), jobs::to_csv(direct.trajectory));
  }
}

}  // namespace
}  // namespace jobs_tests
