// The layer with the real engine behind it.

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "jobs/results/csv.h"
#include "jobs/run_job.h"
#include "jobs/service.h"
#include "tests/jobs/request_support.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using nlohmann::json;

// The ideal rigid linkage is pure kinematics: z = r cos(psi) + sqrt(L^2 - z0^2 - r^2 sin^2(psi)), r = 0.2 + stroke.
TEST(RunJob, SimulatesTheIdealLinkage) {
  const jobs::Outcome outcome = jobs::run_job({{"clearance_mm", 0}, {"duration_s", 0.2}}, [](double) { return false; });
  EXPECT_EQ(outcome.job.at("state"), "succeeded");
  EXPECT_EQ(outcome.job.at("parameters").at("duration_s"), 0.2);
  EXPECT_FALSE(outcome.job.contains("id"));
  const auto column = [&](const char* key) {
    for (std::size_t i = 0; i < outcome.trajectory.channels.size(); ++i) {
      if (outcome.trajectory.channels[i].key == key) return outcome.trajectory.columns[i];
    }
    ADD_FAILURE() << "no channel " << key;
    return std::vector<double>{};
  };
  const auto angle = column("crank_angle_rad");
  const auto rod = column("rod_displacement_m");
  const auto slider = column("slider_position_m");
  ASSERT_EQ(slider.size(), 201U);
  for (std::size_t k = 0; k < slider.size(); ++k) {
    const double r = 0.2 + rod[k];
    const double y = r * std::sin(angle[k]);
    EXPECT_NEAR(slider[k], r * std::cos(angle[k]) + std::sqrt(0.25 - 0.04 - y * y), 1e-6);
  }
}

TEST(RunJob, BendsEveryLinkThatIsFlexible) {
  const json given = json_of(R"({"clearance_mm": 0, "duration_s": 0.1, "run_up_s": 0.05, "coupler": "flexible", "crank": "flexible",
                                 "rod": "flexible", "cross": "flexible", "cross_length_mm": 100, "crank_elements": 3, "rod_elements": 5})");
  const jobs::Outcome outcome = jobs::run_job(given, [](double) { return false; });
  ASSERT_EQ(outcome.job.at("state"), "succeeded") << outcome.job.at("error");
  std::set<std::string> channels;
  for (const auto& channel : outcome.trajectory.channels) channels.insert(channel.key);
  for (const char* key : {"crank_deflection_mm", "rod_deflection_mm", "cross_deflection_mm", "pose_1_1_2_x_m", "pose_1_2_4_x_m", "pose_2_2_3_qw"})
    EXPECT_TRUE(channels.contains(key)) << key;
  EXPECT_FALSE(channels.contains("pose_1_1_3_x_m"));
  EXPECT_GT(outcome.job.at("metrics").at("structural_loss_j"), 0.0);
  EXPECT_LT(outcome.job.at("metrics").at("energy_residual"), 1e-6);
}

TEST(RunJob, StopsWhenAsked) {
  const jobs::Outcome outcome = jobs::run_job({{"duration_s", 100}, {"output_rate_hz", 10}}, [](double t) { return t > 0.01; });
  EXPECT_EQ(outcome.job.at("state"), "cancelled");
  EXPECT_TRUE(outcome.job.at("metrics").is_null());
}

TEST(Service, ComputesWithTheEngineWhatRunJobComputes) {
  const TemporaryStore store;
  jobs::ServiceOptions options;
  options.store = store.file();
  jobs::Service service(options);
  const json sweep = service.submit_sweep(request_of(R"({"parameters": {"duration_s": 0.05}, "sweep": {"coupler": ["rigid", "flexible"], "clearance_mm": [0, 0.25]}})"));
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
