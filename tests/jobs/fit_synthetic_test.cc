// SPDX-License-Identifier: Apache-2.0
// Fits of RPSUP to measurements that were simulated: noise of 2 % of the RMS, a converter of 12 bit. Two
// velocities are fitted, a third one is predicted.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "engine/simulate_rpsup.h"
#include "jobs/measurements/measurement.h"
#include "jobs/requests/parameters.h"
#include "jobs/service.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr const char* kAcceleration = "slider_acceleration_m_s2";

/// Parameters that the fits look for.
struct Truth {
  double clearance_mm, restitution, friction_kinetic, bristle_viscous_s_m;
};

json parameters_of(const Truth& truth, double velocity) {
  return {{"crank_velocity_rad_s", velocity},
          {"duration_s", 4},
          {"output_rate_hz", 2000},
          {"clearance_mm", truth.clearance_mm},
          {"restitution", truth.restitution},
          {"friction_kinetic", truth.friction_kinetic},
          {"bristle_viscous_s_m", truth.bristle_viscous_s_m}};
}

jobs::MeasuredRun measure(const Truth& truth, double velocity, std::mt19937_64& random) {
  const jobs::JobSpec spec = jobs::to_job_spec(jobs::complete_parameters(parameters_of(truth, velocity), ""));
  const engine::RunResult result =
      engine::simulate_rpsup(spec.parameters, spec.options, [](double) { return false; });
  const auto& channels = result.trajectory.channels;
  const auto channel = std::ranges::find(channels, kAcceleration, &engine::QuantityInfo::key);
  std::vector<double> y = result.trajectory.columns.at(static_cast<std::size_t>(channel - channels.begin()));
  double squares = 0.0;
  double largest = 0.0;
  for (const double value : y) {
    squares += value * value;
    largest = std::max(largest, std::abs(value));
  }
  std::normal_distribution<double> noise(0.0, 0.02 * std::sqrt(squares / static_cast<double>(y.size())));
  const double step = 2.2 * largest / 4096.0;
  for (double& value : y) value = std::round((value + noise(random)) / step) * step;
  return {.parameters = {{"crank_velocity_rad_s", velocity}},
          .time_s = result.trajectory.columns[0],
          .columns = {std::move(y)}};
}

json fit_to(jobs::Service& service, const Truth& truth) {
  std::mt19937_64 random(1);
  jobs::Measurement measurement;
  measurement.name = "rig";
  measurement.channels = {{.name = kAcceleration, .column = kAcceleration}};
  for (const double velocity : {5.0, 8.0, 6.5}) measurement.runs.push_back(measure(truth, velocity, random));
  const ordered_json request{
      {"parameters", {{"duration_s", 4}}},
      {"over",
       {{"clearance_mm", {{"from", 0.05}, {"to", 0.5}}},
        {"restitution", {{"from", 0.3}, {"to", 1}}},
        {"friction_kinetic", {{"from", 0.01}, {"to", 0.5}}},
        {"bristle_viscous_s_m", {{"from", 0}, {"to", 3}}}}},
      {"measurements",
       {{{"id", service.submit_measurement(measurement, "").at("id")}, {"held_back_runs", {2}}}}}};
  const std::string id = service.submit_study(jobs::StudyKind::kFit, request).at("id");
  while (!service.wait_for_study(jobs::StudyKind::kFit, id, std::chrono::seconds(5))) continue;
  return service.find_study(jobs::StudyKind::kFit, id).value();
}

TEST(SyntheticFit, LongFindsTheTruth) {
  const Truth truth{0.1714, 0.7449, 0.1425, 1.2871};
  const TemporaryStore store;
  jobs::Service service(options_of(store, 2));
  const json fit = fit_to(service, truth);
  ASSERT_EQ(fit.at("state"), "succeeded") << fit.at("error");
  EXPECT_EQ(fit.at("basis"), "point_wise");
  const json& parameters = fit.at("parameters");
  EXPECT_NEAR(parameters[0].at("value").get<double>(), truth.clearance_mm, 0.02 * truth.clearance_mm);
  EXPECT_NEAR(parameters[1].at("value").get<double>(), truth.restitution, 0.02);
  const json& predicted = fit.at("signals")[2].at("held_back");
  const double measured_peak = predicted.at("measured_peak");
  EXPECT_NEAR(predicted.at("predicted_peak").get<double>(), measured_peak, 0.05 * measured_peak);
}

}  // namespace
}  // namespace jobs_tests
