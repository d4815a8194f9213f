// SPDX-License-Identifier: Apache-2.0
// Fits of RPSUP to measurements that were simulated: noise of 2 % of the RMS, a converter of 12 bit. Two
// velocities are fitted, a third one is predicted.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <iostream>
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

/// Truths are drawn as a lab might meet them: of a tenth to four tenths of a millimetre, hard or soft.
Truth draw_truth(std::mt19937_64& random) {
  const auto between = [&](double from, double to) {
    return std::round(std::uniform_real_distribution(from, to)(random) * 1e4) / 1e4;
  };
  Truth truth{};
  truth.clearance_mm = between(0.1, 0.4);
  truth.restitution = between(0.5, 0.95);
  truth.friction_kinetic = between(0.05, 0.3);
  truth.bristle_viscous_s_m = between(0.2, 2.0);
  return truth;
}

json fit_to(jobs::Service& service, const Truth& truth, std::mt19937_64& random) {
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

/// Whether the value lies within the interval that a fit gives for a parameter; an end that is null is open.
bool is_inside(const json& parameter, double value) {
  const char* kind = "linearised";
  for (const char* const better : {"profile", "range"})
    if (!parameter.at(better).is_null()) kind = better;
  const json& interval = parameter.at(kind);
  const auto is_kept = [&](const char* end, double sign) {
    return interval.at(end).is_null() || sign * interval.at(end).get<double>() <= sign * value;
  };
  return is_kept("low", 1.0) && is_kept("high", -1.0);
}

/// Verdicts on the fit of one set: whether its values are right, and all true ones within their intervals.
struct Reached {
  bool clearance, restitution, intervals, peak;
  [[nodiscard]] bool values() const { return clearance && restitution && peak; }
};

Reached judge(const json& fit, const Truth& truth) {
  const json& parameters = fit.at("parameters");
  const auto value = [&](std::size_t k) { return parameters[k].at("value").get<double>(); };
  const json& predicted = fit.at("signals")[2].at("held_back");
  const double peak = predicted.at("measured_peak");
  return {.clearance = std::abs(value(0) - truth.clearance_mm) <= 0.02 * truth.clearance_mm,
          .restitution = std::abs(value(1) - truth.restitution) <= 0.02,
          .intervals = is_inside(parameters[0], truth.clearance_mm) &&
                       is_inside(parameters[1], truth.restitution) &&
                       is_inside(parameters[2], truth.friction_kinetic) &&
                       is_inside(parameters[3], truth.bristle_viscous_s_m),
          .peak = std::abs(predicted.at("predicted_peak").get<double>() - peak) <= 0.05 * peak};
}

std::size_t number_of_sets() {
  const char* const given = std::getenv("RPSUP_TEST_FITS");
  return given == nullptr ? 3 : std::stoul(given);
}

// Three sets of the twenty in a run of every day; RPSUP_TEST_FITS says how many.
TEST(SyntheticFit, HeavyFindsTheTruth) {
  const std::size_t sets = number_of_sets();
  ASSERT_GT(sets, 0U);
  std::size_t found = 0;
  std::size_t inside = 0;
  for (std::size_t set = 1; set <= sets; ++set) {
    std::mt19937_64 random(set);
    const Truth truth = draw_truth(random);
    const TemporaryStore store;
    jobs::Service service(options_of(store, 2));
    const auto begin = std::chrono::steady_clock::now();
    const json fit = fit_to(service, truth, random);
    ASSERT_EQ(fit.at("state"), "succeeded") << fit.at("error");
    EXPECT_EQ(fit.at("basis"), "point_wise");
    const Reached reached = judge(fit, truth);
    if (reached.values()) ++found;
    if (reached.intervals) ++inside;
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    std::cout << "set " << set << ": truth " << truth.clearance_mm << ' ' << truth.restitution << ' '
              << truth.friction_kinetic << ' ' << truth.bristle_viscous_s_m << ", found";
    for (const json& parameter : fit.at("parameters")) std::cout << ' ' << parameter.at("value");
    std::cout << ", clearance " << reached.clearance << ", restitution " << reached.restitution
              << ", intervals " << reached.intervals << ", peak " << reached.peak << ", points "
              << fit.at("points").at("succeeded") << ", " << std::lround(time.count()) << " s" << std::endl;
  }
  // Seventeen of twenty, and so two of three: a search of so rugged a landscape misses some by chance.
  EXPECT_GE(found, 17 * sets / 20) << found << " of " << sets;
  EXPECT_GE(inside, 17 * sets / 20) << inside << " of " << sets << " with all true values in their intervals";
}

}  // namespace
}  // namespace jobs_tests
