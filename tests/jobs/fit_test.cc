// SPDX-License-Identifier: Apache-2.0
// Fits on a service whose jobs give a closed form in the place of the engine's trajectory: the slider's
// position is clearance (cos(velocity t) + 0.3 restitution sin(3 velocity t)), with lengths in mm.

#include <atomic>
#include <chrono>
#include <cmath>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "jobs/base/errors.h"
#include "jobs/base/ids.h"
#include "jobs/fits/fit_signals.h"
#include "jobs/fits/fit_study.h"
#include "jobs/measurements/measurement.h"
#include "jobs/measurements/measurement_codec.h"
#include "jobs/service.h"
#include "jobs/store/store.h"
#include "jobs/studies/study_runner.h"
#include "tests/jobs/request_support.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using jobs::StudyKind;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr StudyKind kFit = StudyKind::kFit;
constexpr const char* kChannel = "slider_position_m";

double position(double clearance, double restitution, double velocity, double t) {
  return clearance * (std::cos(velocity * t) + 0.3 * restitution * std::sin(3.0 * velocity * t));
}

/// Runner of the closed form.
/// @param scatter  of each job's signal, by its parameters
/// @param from_mm  clearance from which on signals scatter
class ClosedForm {
 public:
  explicit ClosedForm(double scatter = 0.0, double from_mm = 0.0) : scatter_(scatter), from_mm_(from_mm) {}

  [[nodiscard]] jobs::Runner runner() {
    return [this](const jobs::JobSpec& spec, const engine::StopQuery&, const auto&...) { return run(spec); };
  }
  [[nodiscard]] int runs() const { return runs_; }

 private:
  engine::RunResult run(const jobs::JobSpec& spec) {
    ++runs_;
    engine::RunResult result;
    const engine::RpsupParameters& p = spec.parameters;
    if (p.restitution == 0.5) {
      result.status = engine::RunStatus::kNonFinite;
      result.detail = "no number";
      return result;
    }
    std::mt19937_64 random(static_cast<std::uint64_t>(1e12 * p.c_r));
    std::normal_distribution<double> noise;
    result.trajectory.columns.resize(2);
    const double rate = spec.options.output_rate;
    const auto samples = static_cast<int>(std::floor(spec.options.duration * rate + 1e-9));
    const double scatter = 1e3 * p.c_r < from_mm_ ? 0.0 : scatter_;
    double wandering = 0.0;
    for (int k = 0; k <= samples; ++k) {
      const double t = k / rate;
      wandering += scatter * noise(random);
      result.trajectory.columns[0].push_back(t);
      result.trajectory.columns[1].push_back(
          position(1e3 * p.c_r, p.restitution, p.crank_velocity, t + wandering));
    }
    result.trajectory.channels = {{.key = "t_s", .help = "Time"}, {.key = kChannel, .help = "Position"}};
    result.metrics.assign(engine::metric_table().size(), 1.0);
    return result;
  }

  double scatter_, from_mm_;
  std::atomic<int> runs_ = 0;
};

jobs::ServiceOptions options_of(const TemporaryStore& store, ClosedForm& form) {
  jobs::ServiceOptions options = jobs_tests::options_of(store, 2);
  options.runner = form.runner();
  return options;
}

/// Measured runs at some velocities, with 1 % of noise.
jobs::Measurement measured(const std::vector<double>& velocities, double gain = 1.0, double delay_s = 0.0) {
  jobs::Measurement made;
  made.name = "rig";
  made.channels = {{.name = kChannel, .column = kChannel}};
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0.0, 0.01 * 0.3);
  for (const double velocity : velocities) {
    jobs::MeasuredRun run;
    run.parameters = {{"crank_velocity_rad_s", velocity}};
    run.columns.resize(1);
    for (int k = 20; k < 400; ++k) {
      const double t = k / 200.0;
      run.time_s.push_back(t);
      run.columns[0].push_back(gain * position(0.3, 0.8, velocity, t - delay_s) + noise(random));
    }
    made.runs.push_back(std::move(run));
  }
  return made;
}

ordered_json fit_request(const std::string& measurement) {
  return {
      {"name", "rig"},
      {"parameters", {{"run_up_s", 0.1}}},
      {"budget", 250},
      {"over", {{"clearance_mm", {{"from", 0.1}, {"to", 0.5}}}, {"restitution", {{"from", 0.6}, {"to", 1}}}}},
      {"measurements", {{{"id", measurement}}}}};
}

json wait_for_fit(const jobs::Service& service, const std::string& id) {
  for (int tries = 0; tries < 8000; ++tries) {
    json study = service.find_study(kFit, id).value();
    if (study.at("state") != "running") return study;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  throw std::runtime_error("the fit does not end");
}

json run_fit(jobs::Service& service, const ordered_json& request) {
  return wait_for_fit(service, service.submit_study(kFit, request).at("id"));
}

std::string store_measurement(jobs::Service& service, const jobs::Measurement& measurement) {
  return service.submit_measurement(measurement, "").at("id");
}

std::set<std::string> fit_faults_of(jobs::Service& service, const ordered_json& request) {
  try {
    (void)service.submit_study(kFit, request);
  } catch (const jobs::InvalidRequest& invalid) {
    std::set<std::string> pointers;
    for (const jobs::Fault& fault : invalid.faults()) pointers.insert(fault.pointer);
    return pointers;
  }
  return {};
}

json parameter_of(const json& fit, const std::string& path) {
  for (const json& one : fit.at("parameters"))
    if (one.at("path") == path) return one;
  throw std::runtime_error("the fit has no " + path);
}

// Parameters are found by signals with far less noise than stated, and by signals of any weight.
TEST(Fit, FindsTheParametersWithCautiousNoiseAndAnyWeight) {
  for (const json& channel : {json{{"noise", 0.1}}, json{{"weight", 1e-7}}, json{{"weight", 1e5}}}) {
    const TemporaryStore store;
    ClosedForm form;
    jobs::Service service(options_of(store, form));
    ordered_json request = fit_request(store_measurement(service, measured({4, 6})));
    request["measurements"][0]["channels"] = {{kChannel, channel}};
    const json ended = run_fit(service, request);
    ASSERT_EQ(ended.at("state"), "succeeded") << ended.at("error");
    EXPECT_NEAR(parameter_of(ended, "clearance_mm").at("value").get<double>(), 0.3, 0.005) << channel;
    EXPECT_NEAR(parameter_of(ended, "restitution").at("value").get<double>(), 0.8, 0.005) << channel;
    EXPECT_FALSE(parameter_of(ended, "clearance_mm").at("profile").is_null()) << channel;
    EXPECT_TRUE(parameter_of(ended, "clearance_mm").at("range").is_null()) << channel;
  }
}

// A signal that no parameters give: one of the two has another gain.
TEST(Fit, GivesRangesWhereMoreThanNoiseIsLeft) {
  const TemporaryStore store;
  ClosedForm form;
  jobs::Service service(options_of(store, form));
  jobs::Measurement rig = measured({4, 6});
  for (double& y : rig.runs[1].columns[0]) y *= 1.3;
  ordered_json request = fit_request(store_measurement(service, rig));
  request["budget"] = 300;
  const json ended = run_fit(service, request);
  ASSERT_EQ(ended.at("state"), "succeeded") << ended.at("error");
  EXPECT_LE(ended.at("points").at("succeeded"), 300 + 20) << "a generation that has begun is finished";
  for (const json& parameter : ended.at("parameters")) {
    EXPECT_TRUE(parameter.at("profile").is_null());
    EXPECT_LT(parameter.at("range").at("low"), parameter.at("value"));
    EXPECT_GT(parameter.at("range").at("high"), parameter.at("value"));
  }
  EXPECT_LE(parameter_of(ended, "clearance_mm").at("range").at("low"), 0.31);
  EXPECT_GE(parameter_of(ended, "clearance_mm").at("range").at("high"), 0.38);
  EXPECT_THAT(ended.at("remarks").dump(), testing::HasSubstr("more than noise"));
}

TEST(Fit, FindsTheParametersOfTheMeasuredSignals) {
  const TemporaryStore store;
  ClosedForm form;
  jobs::Service service(options_of(store, form));
  ordered_json request = fit_request(store_measurement(service, measured({4, 6, 5})));
  request["measurements"][0]["held_back_runs"] = {2};
  const json ended = run_fit(service, request);
  ASSERT_EQ(ended.at("state"), "succeeded") << ended.at("error");
  EXPECT_EQ(ended.at("basis"), "point_wise");
  EXPECT_LT(ended.at("divergence").at("ratio"), 0.001);
  for (const auto& [path, truth] :
       std::vector<std::pair<std::string, double>>{{"clearance_mm", 0.3}, {"restitution", 0.8}}) {
    const json found = parameter_of(ended, path);
    EXPECT_NEAR(found.at("value").get<double>(), truth, 0.005) << path;
    EXPECT_EQ(found.at("identified"), true) << path;
    for (const char* const kind : {"linearised", "profile"}) {
      EXPECT_LT(found.at(kind).at("low").get<double>(), truth) << path;
      EXPECT_GT(found.at(kind).at("high").get<double>(), truth) << path;
    }
  }
  EXPECT_EQ(ended.at("signals").size(), 3U);
  EXPECT_TRUE(ended.at("signals")[2].at("fitted").is_null());
  EXPECT_NEAR(ended.at("signals")[2].at("held_back").at("rms").get<double>(), 0.003, 0.0005);
  EXPECT_NEAR(ended.at("correlation")[0][1].get<double>(), ended.at("correlation")[1][0].get<double>(),
              1e-12);
  const auto rows = service.find_study_table(kFit, ended.at("id")).value().rows.size();
  EXPECT_EQ(static_cast<std::size_t>(form.runs()), 2 * rows + 1)
      << "the run held back at the best point alone";
  const auto signals = service.find_study_signals(kFit, ended.at("id")).value();
  EXPECT_EQ(signals.rows.size(), 3U * 380U);
}

TEST(Fit, FindsGainAndDelayOfASensorWithoutMoreJobs) {
  const TemporaryStore store;
  ClosedForm form;
  jobs::Service service(options_of(store, form));
  ordered_json request = fit_request(store_measurement(service, measured({4}, 2.0, 0.03)));
  request["over"] = {{"restitution", {{"from", 0.6}, {"to", 1}}},
                     {"sensor.slider_position_m.gain", {{"from", 0.5}, {"to", 4}, {"scale", "log"}}},
                     {"sensor.slider_position_m.delay_s", {{"from", 0}, {"to", 0.08}}}};
  request["parameters"]["clearance_mm"] = 0.3;
  const json ended = run_fit(service, request);
  ASSERT_EQ(ended.at("state"), "succeeded") << ended.at("error");
  EXPECT_NEAR(parameter_of(ended, "sensor.slider_position_m.gain").at("value").get<double>(), 2.0, 0.02);
  EXPECT_NEAR(parameter_of(ended, "sensor.slider_position_m.delay_s").at("value").get<double>(), 0.03, 0.001);
  EXPECT_LT(form.runs(), ended.at("points").at("succeeded")) << "points that differ in a sensor share jobs";
}

TEST(Fit, GivesARunAParameterOfItsOwn) {
  const TemporaryStore store;
  ClosedForm form;
  jobs::Service service(options_of(store, form));
  ordered_json request = fit_request(store_measurement(service, measured({4, 6})));
  request["over"] = {{"clearance_mm", {{"from", 0.1}, {"to", 0.5}}},
                     {"runs.1.crank_velocity_rad_s", {{"from", 5}, {"to", 7}}}};
  request["parameters"]["restitution"] = 0.8;
  const json ended = run_fit(service, request);
  ASSERT_EQ(ended.at("state"), "succeeded") << ended.at("error");
  EXPECT_NEAR(parameter_of(ended, "runs.1.crank_velocity_rad_s").at("value").get<double>(), 6.0, 0.01);
  EXPECT_NEAR(parameter_of(ended, "clearance_mm").at("value").get<double>(), 0.3, 0.005);
}

TEST(Fit, SharesTheJobsOfRunsThatAreRepeated) {
  const TemporaryStore store;
  ClosedForm form;
  jobs::Service service(options_of(store, form));
  ordered_json request = fit_request(store_measurement(service, measured({4, 4, 6, 5, 5, 3})));
  request["measurements"][0]["held_back_runs"] = {3, 4, 5};
  const json ended = run_fit(service, request);
  ASSERT_EQ(ended.at("state"), "succeeded") << ended.at("error");
  EXPECT_EQ(ended.at("signals").size(), 6U);
  EXPECT_EQ(form.runs(), 2 * ended.at("points").at("succeeded").get<int>() + 2);
}

TEST(Fit, EndsWhereItsNumbersCannotGoOn) {
  const TemporaryStore store;
  ClosedForm form;
  jobs::Service service(options_of(store, form));
  jobs::Measurement constant = measured({4});
  for (double& y : constant.runs[0].columns[0]) y = 1.0;
  ordered_json request = fit_request(store_measurement(service, constant));
  request["measurements"][0]["channels"] = {{kChannel, {{"noise", 1e-9}}}};
  const std::string id = service.submit_study(kFit, request).at("id");
  const json good = run_fit(service, fit_request(store_measurement(service, measured({4}))));
  EXPECT_EQ(good.at("state"), "succeeded") << "beside any other fit";
  EXPECT_NE(wait_for_fit(service, id).at("state"), "running");
}

TEST(Fit, SaysWhatTheSignalsDoNotTell) {
  const TemporaryStore store;
  ClosedForm form;
  jobs::Service service(options_of(store, form));
  ordered_json request = fit_request(store_measurement(service, measured({4})));
  request["over"]["friction_kinetic"] = {{"from", 0.1}, {"to", 0.3}};
  const json ended = run_fit(service, request);
  ASSERT_EQ(ended.at("state"), "succeeded") << ended.at("error");
  EXPECT_EQ(parameter_of(ended, "friction_kinetic").at("identified"), false);
  EXPECT_EQ(parameter_of(ended, "clearance_mm").at("identified"), true);
  EXPECT_NE(ended.at("remarks").dump().find("friction_kinetic"), std::string::npos) << ended.at("remarks");
}

TEST(Fit, ComparesFeaturesOfMotionsThatDiverge) {
  const TemporaryStore store;
  ClosedForm form(0.02);
  jobs::Service service(options_of(store, form));
  ordered_json request = fit_request(store_measurement(service, measured({4})));
  request["over"] = {{"clearance_mm", {{"from", 0.1}, {"to", 0.5}}}};
  request["parameters"]["restitution"] = 0.8;
  const json ended = run_fit(service, request);
  ASSERT_EQ(ended.at("state"), "succeeded") << ended.at("error");
  EXPECT_EQ(ended.at("basis"), "features");
  EXPECT_GT(ended.at("divergence").at("ratio"), 0.1);
  EXPECT_NEAR(parameter_of(ended, "clearance_mm").at("value").get<double>(), 0.3, 0.03);
}

// The measured signal is never above three times its RMS, and those of all jobs are.
TEST(Fit, ComparesFeaturesThatTheMeasuredSignalHasNot) {
  const TemporaryStore store;
  ClosedForm form;
  jobs::Service service(options_of(store, form));
  ordered_json request = fit_request(store_measurement(service, measured({4}, 0.25)));
  request["basis"] = "features";
  request["over"] = {{"clearance_mm", {{"from", 0.3}, {"to", 0.5}}}};
  request["parameters"]["restitution"] = 0.8;
  const json ended = run_fit(service, request);
  ASSERT_EQ(ended.at("state"), "succeeded") << ended.at("error");
  EXPECT_NEAR(parameter_of(ended, "clearance_mm").at("value").get<double>(), 0.3, 0.01);
  EXPECT_FALSE(parameter_of(ended, "clearance_mm").at("linearised").is_null()) << ended.at("remarks");
  EXPECT_NE(ended.at("local_end"), "The fit ended at its largest number of iterations.");
}

// Point by point the quietest motion is nearest to a measured one that wanders.
TEST(Fit, JudgesDivergenceByMotionsLikeTheMeasuredOne) {
  const TemporaryStore store;
  ClosedForm form(0.2, 0.2);
  jobs::Service service(options_of(store, form));
  jobs::Measurement rig = measured({4});
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0.0, 0.2);
  double wandering = 0.0;
  for (std::size_t k = 0; k < rig.runs[0].time_s.size(); ++k) {
    wandering += noise(random);
    rig.runs[0].columns[0][k] = position(0.3, 0.8, 4.0, rig.runs[0].time_s[k] + wandering);
  }
  ordered_json request = fit_request(store_measurement(service, rig));
  request["over"] = {{"clearance_mm", {{"from", 0.01}, {"to", 0.5}}}};
  request["parameters"]["restitution"] = 0.8;
  const json ended = run_fit(service, request);
  ASSERT_EQ(ended.at("state"), "succeeded") << ended.at("error");
  EXPECT_EQ(ended.at("basis"), "features") << ended.at("divergence");
  EXPECT_NEAR(parameter_of(ended, "clearance_mm").at("value").get<double>(), 0.3, 0.03);
}

// Motions of the design that diverge may have features like those of a measured motion that does not.
TEST(Fit, ComparesSamplesOfAMotionThatConvergesBesideOthersThatDoNot) {
  const TemporaryStore store;
  ClosedForm form(0.005, 0.301);
  jobs::Service service(options_of(store, form));
  ordered_json request = fit_request(store_measurement(service, measured({4})));
  request["over"] = {{"clearance_mm", {{"from", 0.295}, {"to", 0.5}, {"start", 0.3005}}}};
  request["parameters"]["restitution"] = 0.8;
  const json ended = run_fit(service, request);
  ASSERT_EQ(ended.at("state"), "succeeded") << ended.at("error");
  EXPECT_EQ(ended.at("basis"), "point_wise") << ended.at("divergence");
  EXPECT_LT(ended.at("divergence").at("ratio"), 0.1);
  EXPECT_NEAR(parameter_of(ended, "clearance_mm").at("value").get<double>(), 0.3, 0.001);
}

TEST(Fit, GoesOnAfterARestartWithoutRepeatingAJob) {
  const TemporaryStore store;
  ClosedForm form;
  std::string id;
  json undisturbed;
  {
    const TemporaryStore other;
    ClosedForm alone;
    jobs::Service service(options_of(other, alone));
    undisturbed = run_fit(service, fit_request(store_measurement(service, measured({4}))));
  }
  {
    jobs::Service service(options_of(store, form));
    id = service.submit_study(kFit, fit_request(store_measurement(service, measured({4})))).at("id");
    while (form.runs() < 40) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    service.stop();
  }
  jobs::Service service(options_of(store, form));
  const json ended = wait_for_fit(service, id);
  EXPECT_EQ(ended.at("parameters"), undisturbed.at("parameters"));
  EXPECT_EQ(ended.at("points"), undisturbed.at("points"));
  EXPECT_LE(form.runs(), ended.at("points").at("succeeded").get<int>() + 2)
      << "but for those that were cut off";
}

// The ids of jobs that are added while the service runs are not known before they end.
TEST(Fit, WaitsForItsJobsOnceOneIsCancelled) {
  const TemporaryStore store;
  ClosedForm form;
  std::atomic<int> begun = 0, held_from = 1;
  std::atomic<bool> is_held = true;
  jobs::ServiceOptions options = options_of(store, form);
  options.threads = 1;
  options.runner = [&, run = form.runner()](const jobs::JobSpec& spec, const engine::StopQuery& stop) {
    ++begun;
    while (is_held && begun >= held_from && !stop(0.0))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return run(spec, stop);
  };
  jobs::Service service(options);
  const json first = service.submit_study(kFit, fit_request(store_measurement(service, measured({4}))));
  held_from = first.at("counts").at("total").get<int>() + 1;
  while (begun < held_from) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const auto rows = service.find_results(first.at("sweep_id")).value().rows;
  ASSERT_GT(rows.size(), static_cast<std::size_t>(held_from));
  EXPECT_EQ(service.cancel_job(rows.back().at(0)).value().at("state"), "cancelled");
  EXPECT_FALSE(service.wait_for_study(kFit, first.at("id"), std::chrono::milliseconds(200)));
  is_held = false;
  const json ended = wait_for_fit(service, first.at("id"));
  EXPECT_EQ(ended.at("state"), "cancelled");
  EXPECT_EQ(ended.at("counts").at("cancelled"), 1);
  EXPECT_EQ(ended.at("counts").at("succeeded").get<std::size_t>(), rows.size() - 1);
}

TEST(Fit, GoesOnBesideJobsThatFail) {
  const TemporaryStore store;
  ClosedForm form;
  jobs::Service service(options_of(store, form));
  ordered_json request = fit_request(store_measurement(service, measured({4})));
  request["over"]["restitution"] = {{"from", 0.4}, {"to", 1}, {"start", 0.5}};
  const json ended = run_fit(service, request);
  ASSERT_EQ(ended.at("state"), "succeeded") << ended.at("error");
  EXPECT_EQ(ended.at("points").at("lost"), 1);
  EXPECT_NEAR(parameter_of(ended, "restitution").at("value").get<double>(), 0.8, 0.01);
}

// Jobs fail beside the best value as far as the differences of the first least squares reach.
TEST(Fit, SearchesOnWhereJobsBesideTheBestPointFail) {
  const TemporaryStore store;
  ClosedForm form;
  jobs::ServiceOptions options = options_of(store, form);
  options.runner = [run = form.runner()](const jobs::JobSpec& spec, const engine::StopQuery& stop) {
    const double off = std::abs(spec.parameters.restitution - 0.8);
    if (off <= 1e-4 || off >= 0.02) return run(spec, stop);
    engine::RunResult failed;
    failed.status = engine::RunStatus::kNonFinite;
    failed.detail = "no number";
    return failed;
  };
  jobs::Service service(options);
  ordered_json request = fit_request(store_measurement(service, measured({4})));
  request["over"] = {{"restitution", {{"from", 0.6}, {"to", 1}, {"start", 0.8}}}};
  request["parameters"]["clearance_mm"] = 0.3;
  const json ended = run_fit(service, request);
  ASSERT_EQ(ended.at("state"), "succeeded") << ended.at("error");
  EXPECT_NEAR(parameter_of(ended, "restitution").at("value").get<double>(), 0.8, 1e-3);
  EXPECT_FALSE(parameter_of(ended, "restitution").at("linearised").is_null()) << ended.at("remarks");
}

TEST(Fit, TakesSamplesOfJobsThatSuitTheMeasuredTimes) {
  const auto at_steps = [](std::vector<double> steps) {
    std::vector<double> time_s{0.1};
    for (std::size_t k = 0; k < 30; ++k) time_s.push_back(time_s.back() + steps[k % steps.size()]);
    return time_s;
  };
  EXPECT_EQ(jobs::find_output_rate(at_steps({0.004})), 1000);
  EXPECT_EQ(jobs::find_output_rate(at_steps({1.0 / 300.0})), 1200);
  EXPECT_EQ(jobs::find_output_rate(at_steps({1.0 / 2048.0})), 2048);
  EXPECT_EQ(jobs::find_output_rate(at_steps({0.01, 0.01, 0.15})), 1000);
  EXPECT_EQ(jobs::find_output_rate(at_steps({0.0005, 0.0005, 0.003})), 20'000);
  EXPECT_EQ(jobs::find_output_rate(at_steps({1e-6, 1e-6, 3e-6})), 1e5);
}

TEST(Fit, KeepsAMeasurementThatItNeeds) {
  const TemporaryStore store;
  ClosedForm form;
  jobs::Service service(options_of(store, form));
  const std::string measurement = store_measurement(service, measured({4}));
  const json ended = run_fit(service, fit_request(measurement));
  EXPECT_THROW((void)service.delete_measurement(measurement), jobs::WrongState);
  EXPECT_TRUE(service.delete_study(kFit, ended.at("id")));
  EXPECT_TRUE(service.delete_measurement(measurement));
}

TEST(Fit, IsRefusedIfItsMeasurementIsDeletedBeforeItIsStored) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  const std::string measurement = store.measurements.add(jobs::pack(measured({4})));
  const auto find_and_delete = [&](const std::string& id) {
    auto found = store.measurements.find(id);
    store.measurements.erase(id);
    return found;
  };
  jobs::StudyRunner runner(store, {.max_sweep_jobs = 1000, .max_queued_jobs = 1000, .threads = 1},
                           jobs::make_fit_study(store.reader, find_and_delete));
  const auto faults = faults_of([&] { (void)runner.submit(fit_request(measurement), {}); });
  EXPECT_EQ(pointers_of(faults), std::vector<std::string>{"/measurements/0/id"});
  EXPECT_TRUE(store.studies.list(jobs::kFitPrefix, "", "", 10).empty());
}

TEST(Fit, FitsNoSampleTwice) {
  const TemporaryStore store;
  ClosedForm form;
  jobs::Service service(options_of(store, form));
  ordered_json request = fit_request(store_measurement(service, measured({4, 6})));
  const ordered_json once = request["measurements"][0];
  const auto places_with = [&](const char* first, const char* second) {
    request["measurements"] = {once, once};
    request["measurements"][0].merge_patch(ordered_json::parse(first));
    request["measurements"][1].merge_patch(ordered_json::parse(second));
    return fit_faults_of(service, request);
  };
  using Places = std::set<std::string>;
  EXPECT_EQ(places_with("{}", "{}"), Places{"/measurements/1"});
  EXPECT_EQ(places_with(R"({"runs": [0]})", R"({"runs": [1, 0]})"), Places{"/measurements/1"});
  EXPECT_EQ(places_with(R"({"runs": [0]})", R"({"runs": [1]})"), Places{});
  EXPECT_EQ(places_with(R"({"fitted": [[0.1, 0.2]]})", R"({"fitted": [[0.3, 0.4]]})"), Places{});
  EXPECT_EQ(places_with(R"({"fitted": [[0.1, 0.3]]})", R"({"fitted": [[0.2, 0.4]]})"),
            Places{"/measurements/1"});
  EXPECT_EQ(places_with(R"({"time_shift_s": 0.001})", "{}"), Places{"/measurements/1"});
  EXPECT_EQ(places_with(R"({"held_back_runs": [0, 1]})", "{}"), Places{});
}

// One signal that is long enough has features. Of 50 samples there are none.
TEST(Fit, RefusesFeaturesThatNoSignalHas) {
  const TemporaryStore store;
  ClosedForm form;
  jobs::Service service(options_of(store, form));
  ordered_json request = fit_request(store_measurement(service, measured({4, 6})));
  request["basis"] = "features";
  request["measurements"][0]["held_back_runs"] = {0};
  EXPECT_EQ(fit_faults_of(service, request), std::set<std::string>{});
  request["measurements"][0]["held_back_runs"] = ordered_json::array();
  request["measurements"][0]["runs"] = {0};
  request["measurements"][0]["fitted"] = ordered_json::parse("[[0.0975, 0.3475]]");
  EXPECT_EQ(fit_faults_of(service, request), std::set<std::string>{"/basis"});
}

TEST(Fit, SaysWhichSamplesItFits) {
  const TemporaryStore store;
  ClosedForm form;
  jobs::Service service(options_of(store, form));
  ordered_json request = fit_request(store_measurement(service, measured({4, 6})));
  request["parameters"]["run_up_s"] = 40.0;
  try {
    static_cast<void>(service.submit_study(kFit, request));
    ADD_FAILURE();
  } catch (const jobs::InvalidRequest& invalid) {
    EXPECT_THAT(invalid.faults().front().detail,
                testing::AllOf(testing::HasSubstr("0 samples to be fitted"),
                               testing::HasSubstr("from run_up_s, 40 s, on"),
                               testing::HasSubstr("another run_up_s, or windows in")));
  }
}

TEST(Fit, RefusesEachFaultWithItsPlace) {
  const TemporaryStore store;
  ClosedForm form;
  jobs::Service service(options_of(store, form));
  const std::string measurement = store_measurement(service, measured({4, 6}));
  const ordered_json right = fit_request(measurement);
  const auto faults = [&](const char* patch) {
    ordered_json request = right;
    request.merge_patch(ordered_json::parse(patch));
    return fit_faults_of(service, request);
  };
  using Places = std::set<std::string>;
  EXPECT_EQ(faults(R"({"over": {}, "wrong": 1})"), Places{"/wrong"});
  EXPECT_EQ(faults(R"({"over": null})"), Places{"/over"});
  EXPECT_EQ(faults(R"({"over": {"clearance_mm": {"from": 0.5, "to": 0.1}}})"),
            Places{"/over/clearance_mm/to"});
  EXPECT_EQ(faults(R"({"over": {"clearence_mm": {"from": 0.1, "to": 0.5}}})"), Places{"/over/clearence_mm"});
  EXPECT_EQ(faults(R"({"over": {"sensor.x.gain": {"from": 1, "to": 2}}})"), Places{"/over/sensor.x.gain"});
  EXPECT_EQ(faults(R"({"over": {"runs.5.clearance_mm": {"from": 0.1, "to": 0.5}}})"),
            Places{"/over/runs.5.clearance_mm"});
  EXPECT_EQ(faults(R"({"over": {"runs.0.clearance_mm": {"from": 0.1, "to": 0.5}}})"),
            Places{"/over/runs.0.clearance_mm"});
  EXPECT_EQ(faults(R"({"over": {"radial_levels": {"from": 1, "to": 4}}})"), Places{"/over/radial_levels"});
  EXPECT_EQ(faults(R"({"budget": 40, "population": 11})"), Places{"/population"});
  EXPECT_EQ(faults(R"({"parameters": {"clearance_mm": 0.2}})"), Places{"/over/clearance_mm"});
  EXPECT_EQ(faults(R"({"measurements": []})"), Places{"/measurements"});
  EXPECT_EQ(faults(R"({"measurements": [{"id": "mea_none"}]})"), Places{"/measurements/0/id"});
  EXPECT_EQ(faults(R"({"basis": "best", "intervals": 1, "budget": 1, "samples": -1, "replicates": 0.5})"),
            (Places{"/basis", "/intervals", "/budget", "/samples", "/replicates"}));
  EXPECT_EQ(faults(R"({"parameters": {"duration_s": 0.05}})"), Places{"/measurements"});
  const auto measurement_faults = [&](const char* patch) {
    ordered_json request = right;
    request["measurements"][0].merge_patch(ordered_json::parse(patch));
    return fit_faults_of(service, request);
  };
  EXPECT_EQ(measurement_faults(R"({"runs": [2], "held_back_runs": [1]})"),
            (Places{"/measurements/0/runs/0", "/measurements/0/held_back_runs"}));
  EXPECT_EQ(measurement_faults(R"({"channels": {"slider_speed": {}}})"),
            Places{"/measurements/0/channels/slider_speed"});
  EXPECT_EQ(measurement_faults(R"({"channels": {"slider_position_m": {"noise": 0}}})"),
            Places{"/measurements/0/channels/slider_position_m/noise"});
  EXPECT_EQ(
      measurement_faults(R"({"fitted": [[1, 0]], "held_back": 3, "time_shift_s": "1"})"),
      (Places{"/measurements/0/fitted/0", "/measurements/0/held_back", "/measurements/0/time_shift_s"}));
  EXPECT_EQ(measurement_faults(R"({"held_back_runs": [0, 1]})"), Places{"/measurements"});
  EXPECT_EQ(measurement_faults(R"({"channels": {"slider_position_m": {"weight": 1e308}}})"),
            Places{"/measurements/0/channels/slider_position_m"});
}

}  // namespace
}  // namespace jobs_tests
