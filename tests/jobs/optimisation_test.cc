// SPDX-License-Identifier: Apache-2.0
// Optimisations on a service whose first metric is sqrt(1000 crank_velocity + c_r), and whose jobs fail where
// restitution is 0.5.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "jobs/base/errors.h"
#include "jobs/service.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using jobs::StudyKind;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr StudyKind kKind = StudyKind::kOptimisation;

const std::string& metric() { return engine::metric_table()[0].key; }

ordered_json least_request() {
  return {{"name", "least"},
          {"parameters", {{"clearance_mm", 0}}},
          {"over", {{"crank_velocity_rad_s", {{"from", 1}, {"to", 9}}}}},
          {"objectives", {{{"metric", metric()}}}},
          {"budget", 120},
          {"starts", 2},
          {"seed", 3}};
}

json wait_for_study(const jobs::Service& service, const std::string& id) {
  for (int tries = 0; tries < 4000; ++tries) {
    json study = service.find_study(kKind, id).value();
    if (study.at("state") != "running") return study;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  throw std::runtime_error("the optimisation does not end");
}

json run(jobs::Service& service, const ordered_json& request) {
  return wait_for_study(service, service.submit_study(kKind, request).at("id"));
}

std::set<std::string> optimisation_faults_of(jobs::Service& service, const ordered_json& request) {
  try {
    (void)service.submit_study(kKind, request);
  } catch (const jobs::InvalidRequest& invalid) {
    std::set<std::string> pointers;
    for (const jobs::Fault& fault : invalid.faults()) pointers.insert(fault.pointer);
    return pointers;
  }
  return {};
}

TEST(Optimisation, FindsTheLeastValueFromEachStart) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 2));
  const json ended = run(service, least_request());
  EXPECT_EQ(ended.at("state"), "succeeded");
  EXPECT_EQ(ended.at("method"), "cma_es");
  EXPECT_NEAR(ended.at("best").at("values").at("crank_velocity_rad_s").get<double>(), 1.0, 0.01);
  EXPECT_NEAR(ended.at("best").at("metrics").at(metric()).get<double>(), std::sqrt(1000.0), 0.2);
  EXPECT_EQ(ended.at("best_repeats"), 2);
  EXPECT_EQ(ended.at("front").size(), 1U);
  EXPECT_EQ(ended.at("progress"), 1.0);
  EXPECT_EQ(ended.at("candidates").at("pending"), 0);
  const auto rows = service.find_study_table(kKind, ended.at("id")).value().rows.size();
  EXPECT_EQ(ended.at("candidates").at("feasible"), rows);
  EXPECT_LE(rows, 120U);
  EXPECT_EQ(engine.begun_speeds().size(), rows) << "nothing is computed twice";
}

TEST(Optimisation, FindsTheLargestValueWithinABound) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 2));
  ordered_json request = least_request();
  request["objectives"][0]["goal"] = "maximise";
  request["bounds"] = {{{"metric", metric()}, {"maximum", std::sqrt(5000.0)}}};
  const json ended = run(service, request);
  const double best = ended.at("best").at("values").at("crank_velocity_rad_s");
  EXPECT_LE(best, 5.0);
  EXPECT_NEAR(best, 5.0, 0.1);
  EXPECT_GT(ended.at("candidates").at("infeasible"), 0);
}

TEST(Optimisation, TakesTheWorstOverAxesAndReplicates) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 2));
  ordered_json request = least_request();
  request["over"] = {{"clearance_mm", {{"from", 0.1}, {"to", 0.2}}}};
  request.erase("parameters");
  request["sweep"] = {{"crank_velocity_rad_s", {2, 3}}};
  request["replicates"] = {{"count", 2}};
  request["budget"] = 24;
  const json ended = run(service, request);
  EXPECT_EQ(ended.at("best").at("job_ids").size(), 4U);
  // The metric of the stronger of two speeds.
  EXPECT_NEAR(ended.at("best").at("metrics").at(metric()).get<double>(), std::sqrt(3000.0), 0.1);
  request["objectives"][0]["quantile"] = 0.0;
  const json least = run(service, request);
  EXPECT_NEAR(least.at("best").at("metrics").at(metric()).get<double>(), std::sqrt(2000.0), 0.1);
  // The same part of the jobs is as good where large values are.
  request["objectives"][0]["goal"] = "maximise";
  request["objectives"][0]["quantile"] = 1.0;
  const json all = run(service, request);
  request["objectives"][0].erase("quantile");
  EXPECT_EQ(run(service, request).at("best").at("metrics"), all.at("best").at("metrics"));
  request["objectives"][0]["quantile"] = 0.0;
  EXPECT_GT(run(service, request).at("best").at("metrics").at(metric()).get<double>(),
            all.at("best").at("metrics").at(metric()).get<double>() + 1.0);
}

TEST(Optimisation, WaitsForTheJobsThatEachCandidateHas) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 2));
  ordered_json request = least_request();
  request["over"] = {{"clearance_mm", {{"from", 0.1}, {"to", 0.2}}}};
  request.erase("parameters");
  request["sweep"] = {{"crank_velocity_rad_s", {2, 3}}};
  request["replicates"] = {{"count", 3}, {"only", {{"crank_velocity_rad_s", {3}}}}};
  request["budget"] = 24;
  EXPECT_EQ(run(service, request).at("best").at("job_ids").size(), 4U);
}

TEST(Optimisation, AddsItsCasesByItself) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 2));
  const json ended = run(service, least_request());
  EXPECT_THROW(service.extend_sweep(ended.at("sweep_id"), {{"cases", {{{"crank_velocity_rad_s", 20}}}}}),
               jobs::WrongState);
}

TEST(Optimisation, PassesByJobsThatFail) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 2));
  ordered_json request = least_request();
  request["sweep"] = {{"restitution", {0.5}}};
  request["budget"] = 12;
  const json lost = run(service, request);
  EXPECT_EQ(lost.at("state"), "failed");
  EXPECT_NE(lost.at("error").get<std::string>().find("non_finite"), std::string::npos);
  EXPECT_EQ(lost.at("best"), nullptr);
  EXPECT_EQ(lost.at("lost_reasons").at("non_finite"), lost.at("candidates").at("lost"));
}

TEST(Optimisation, PassesByParametersThatDoNotFitTogether) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 2));
  ordered_json request = least_request();
  request["parameters"] = {{"bearing_radius_mm", 1.5}, {"crank_velocity_rad_s", 2}};
  request["over"] = {{"clearance_mm", {{"from", 0.5}, {"to", 3.0}}}};
  request["budget"] = 24;
  const json ended = run(service, request);
  EXPECT_EQ(ended.at("state"), "succeeded");
  EXPECT_GT(ended.at("lost_reasons").at("invalid_parameters"), 0);
  EXPECT_LT(ended.at("best").at("values").at("clearance_mm").get<double>(), 1.5);
  request["over"] = {{"clearance_mm", {{"from", 2.0}, {"to", 3.0}}}};
  EXPECT_EQ(optimisation_faults_of(service, request), (std::set<std::string>{"/over/clearance_mm"}));
}

TEST(Optimisation, GivesTheFrontOfSeveralObjectives) {
  const TemporaryStore store;
  jobs::Service service(options_of(store, 2));
  const ordered_json request{{"parameters", {{"duration_s", 0.2}, {"run_up_s", 0.1}, {"clearance_mm", 0}}},
                             {"over", {{"crank_velocity_rad_s", {{"from", 2}, {"to", 12}}}}},
                             {"objectives",
                              {{{"metric", "peak_slider_acceleration_m_s2"}},
                               {{"metric", "peak_crank_torque_n_m"}, {"goal", "maximise"}}}},
                             {"population", 8},
                             {"budget", 40}};
  const std::string id = service.submit_study(kKind, request).at("id");
  const json ended = wait_for_study(service, id);
  ASSERT_EQ(ended.at("state"), "succeeded") << ended.at("error");
  EXPECT_EQ(ended.at("method"), "nsga2");
  EXPECT_EQ(ended.at("best"), nullptr);
  EXPECT_EQ(ended.at("best_repeats"), nullptr);
  ASSERT_GT(ended.at("front").size(), 3U);
  for (const json& a : ended.at("front")) {
    for (const json& b : ended.at("front")) {
      const auto value = [](const json& one, const char* key) {
        return one.at("metrics").at(key).get<double>();
      };
      const bool better =
          value(a, "peak_slider_acceleration_m_s2") < value(b, "peak_slider_acceleration_m_s2");
      const bool stronger = value(a, "peak_crank_torque_n_m") > value(b, "peak_crank_torque_n_m");
      EXPECT_FALSE(better && stronger) << a << b;
    }
  }
}

TEST(Optimisation, VariesNumbersOfADescribedLinkage) {
  const TemporaryStore store;
  jobs::Service service(options_of(store, 2));
  const ordered_json pendulum{
      {"name", "pendulum"},
      {"bodies",
       {{"bob", {{"mass_kg", 1}, {"centre_of_mass_m", {0.5, 0, 0}}, {"inertia_kg_m2", {0.01, 0.02, 0.02}}}}}},
      {"joints", {{"pin", {{"kind", "revolute"}, {"from", "ground"}, {"to", "bob"}}}}}};
  ordered_json request{{"parameters", {{"linkage", pendulum}, {"duration_s", 0.5}, {"run_up_s", 0.1}}},
                       {"over", {{"linkage.bodies.bob.mass_kg", {{"from", 0.5}, {"to", 2.0}}}}},
                       {"objectives", {{{"metric", "peak_pin_reaction_n"}}}},
                       {"budget", 18},
                       {"starts", 1}};
  const json ended = run(service, request);
  ASSERT_EQ(ended.at("state"), "succeeded") << ended.at("error");
  // The reaction of the pin is proportional to the mass.
  EXPECT_LT(ended.at("best").at("values").at("linkage.bodies.bob.mass_kg").get<double>(), 0.7);
  request["objectives"][0]["metric"] = metric();
  EXPECT_EQ(optimisation_faults_of(service, request), (std::set<std::string>{"/objectives/0/metric"}));
  request["objectives"][0]["metric"] = "peak_pin_reaction_n";
  request["over"] = {{"linkage.bodies.bob.weight", {{"from", 0.5}, {"to", 2.0}}}};
  EXPECT_TRUE(optimisation_faults_of(service, request).contains("/over/linkage.bodies.bob.weight"));
}

TEST(Optimisation, GoesOnAfterARestartWithoutRepeatingAJob) {
  json whole;
  {
    const TemporaryStore store;
    FakeEngine engine;
    jobs::Service service(options_of(store, engine, 1));
    whole = run(service, least_request());
  }
  const TemporaryStore store;
  FakeEngine engine;
  std::string id;
  {
    jobs::Service service(options_of(store, engine, 1));
    id = service.submit_study(kKind, least_request()).at("id");
    while (engine.begun_speeds().size() < 20) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  jobs::Service service(options_of(store, engine, 1));
  const json ended = wait_for_study(service, id);
  EXPECT_EQ(ended.at("best").at("values"), whole.at("best").at("values"));
  EXPECT_EQ(ended.at("starts"), whole.at("starts"));
  // A run that the end of the service has stopped begins again.
  EXPECT_LE(engine.begun_speeds().size(), ended.at("counts").at("total").get<std::size_t>() + 1);
}

ordered_json local_request(const char* method) {
  ordered_json request = least_request();
  request["method"] = method;
  request["over"]["crank_velocity_rad_s"]["start"] = 7;
  return request;
}

TEST(Optimisation, FindsTheLeastValueByALocalSearch) {
  json whole;
  {
    const TemporaryStore store;
    FakeEngine engine;
    jobs::Service service(options_of(store, engine, 2));
    whole = run(service, local_request("nelder_mead"));
    EXPECT_EQ(whole.at("state"), "succeeded");
    EXPECT_EQ(whole.at("method"), "nelder_mead");
    EXPECT_EQ(whole.at("population"), json());
    EXPECT_NEAR(whole.at("best").at("values").at("crank_velocity_rad_s").get<double>(), 1.0, 0.01);
    for (const json& start : whole.at("starts")) EXPECT_EQ(start.at("end"), "converged");
    EXPECT_TRUE(std::ranges::count(engine.begun_speeds(), 7.0) == 1);
  }
  // The same after a restart, and no job is computed twice but for the one that the end has stopped.
  const TemporaryStore store;
  FakeEngine engine;
  std::string id;
  {
    jobs::Service service(options_of(store, engine, 1));
    id = service.submit_study(kKind, local_request("nelder_mead")).at("id");
    while (engine.begun_speeds().size() < 5) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  jobs::Service service(options_of(store, engine, 1));
  const json ended = wait_for_study(service, id);
  EXPECT_EQ(ended.at("starts"), whole.at("starts"));
  EXPECT_LE(engine.begun_speeds().size(), ended.at("counts").at("total").get<std::size_t>() + 1);
}

TEST(Optimisation, FollowsQuadraticModelsOfTwoVariables) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 2));
  ordered_json request = local_request("bobyqa");
  request["over"]["crank_length_m"] = {{"from", 0.1}, {"to", 0.2}};
  const json ended = run(service, request);
  EXPECT_EQ(ended.at("state"), "succeeded") << ended.at("error");
  EXPECT_EQ(ended.at("method"), "bobyqa");
  EXPECT_NEAR(ended.at("best").at("values").at("crank_velocity_rad_s").get<double>(), 1.0, 0.02);
}

TEST(Optimisation, IsCancelledRetriedAndDeleted) {
  const TemporaryStore store;
  FakeEngine engine;
  engine.hold();
  jobs::Service service(options_of(store, engine, 1));
  const std::string id = service.submit_study(kKind, least_request()).at("id");
  EXPECT_THROW(service.delete_study(kKind, id), jobs::WrongState);
  EXPECT_EQ(service.cancel_study(kKind, id).value().at("state"), "cancelled");
  const json cancelled = service.find_study(kKind, id).value();
  for (const json& start : cancelled.at("starts")) EXPECT_EQ(start.at("end"), "stopped");
  engine.release();
  EXPECT_EQ(service.retry_study(kKind, id).value().at("state"), "running");
  const json ended = wait_for_study(service, id);
  EXPECT_EQ(ended.at("state"), "succeeded");
  EXPECT_THROW(service.delete_sweep(ended.at("sweep_id")), jobs::WrongState);
  EXPECT_TRUE(service.delete_study(kKind, id));
  EXPECT_FALSE(service.find_study(kKind, id).has_value());
  EXPECT_FALSE(service.find_sweep(ended.at("sweep_id")).has_value());
}

// The ids of jobs that are added while the service runs are not known before they end.
TEST(Optimisation, WaitsForItsJobsOnceOneIsCancelled) {
  const TemporaryStore store;
  FakeEngine engine;
  std::atomic<int> begun = 0, held_from = 0;
  jobs::ServiceOptions options = options_of(store, engine, 1);
  options.runner = [&, fake = engine.runner()](const jobs::JobSpec& spec, const engine::StopQuery& stop) {
    if (++begun == held_from) engine.hold();
    return fake(spec, stop);
  };
  engine.hold();
  jobs::Service service(options);
  ordered_json request = least_request();
  request["starts"] = 1;
  const json first = service.submit_study(kKind, request);
  held_from = first.at("counts").at("total").get<int>() + 1;
  engine.release();
  while (begun < held_from) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  const auto rows = service.find_results(first.at("sweep_id")).value().rows;
  ASSERT_GT(rows.size(), static_cast<std::size_t>(held_from));
  EXPECT_EQ(service.cancel_job(rows.back().at(0)).value().at("state"), "cancelled");
  EXPECT_FALSE(service.wait_for_study(kKind, first.at("id"), std::chrono::milliseconds(200)));
  engine.release();
  const json ended = wait_for_study(service, first.at("id"));
  EXPECT_EQ(ended.at("state"), "cancelled");
  EXPECT_EQ(ended.at("counts").at("cancelled"), 1);
  EXPECT_EQ(ended.at("counts").at("succeeded").get<std::size_t>(), rows.size() - 1);
}

TEST(Optimisation, NamesEveryFaultOfARequest) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  const auto faults = [&](const std::string& key, const ordered_json& value) {
    ordered_json request = least_request();
    request[key] = value;
    return optimisation_faults_of(service, request);
  };
  using Pointers = std::set<std::string>;
  EXPECT_EQ(faults("ovr", 1), Pointers{"/ovr"});
  EXPECT_EQ(faults("over", ordered_json::object()), Pointers{"/over"});
  EXPECT_EQ(faults("over", {{"coupler", {{"from", 1}, {"to", 2}}}}), Pointers{"/over/coupler"});
  EXPECT_EQ(faults("over", {{"clearance_mm", {{"from", 0.1}, {"to", 0.2}}}}), Pointers{"/over/clearance_mm"});
  EXPECT_EQ(faults("over", {{"crank_velocity_rad_s", {{"from", 3}, {"to", 2}}}}),
            Pointers{"/over/crank_velocity_rad_s/to"});
  EXPECT_EQ(faults("over", {{"crank_velocity_rad_s", {{"from", 1}, {"to", 2}, {"start", 3}}}}),
            Pointers{"/over/crank_velocity_rad_s/start"});
  EXPECT_EQ(faults("objectives", ordered_json::array()), Pointers{"/objectives"});
  EXPECT_EQ(faults("objectives", {{{"metric", "peak"}}}), Pointers{"/objectives/0/metric"});
  EXPECT_EQ(faults("objectives", {{{"metric", metric()}, {"goal", "least"}}}),
            Pointers{"/objectives/0/goal"});
  EXPECT_EQ(faults("objectives", {{{"metric", metric()}}, {{"metric", metric()}}}),
            Pointers{"/objectives/1/metric"});
  EXPECT_EQ(faults("bounds", {{{"metric", metric()}}}), Pointers{"/bounds/0"});
  EXPECT_EQ(faults("bounds", {{{"metric", metric()}, {"maximum", "1"}}}), Pointers{"/bounds/0/maximum"});
  EXPECT_EQ(faults("bounds", {{{"metric", metric()}, {"maximum", 1}, {"quantile", 2}}}),
            Pointers{"/bounds/0/quantile"});
  EXPECT_EQ(faults("bounds", {{{"metric", metric()}, {"maximum", 1}, {"quantile", 0.5}},
                              {{"metric", metric()}, {"maximum", 2}}}),
            Pointers{"/bounds/1"});
  EXPECT_EQ(faults("budget", 1000000), Pointers{"/budget"});
  EXPECT_EQ(faults("budget", 6), Pointers{"/budget"});
  EXPECT_EQ(faults("population", 3), Pointers{"/population"});
  EXPECT_EQ(faults("starts", 0), Pointers{"/starts"});
  EXPECT_EQ(faults("method", "simplex"), Pointers{"/method"});
  EXPECT_EQ(faults("method", "nsga2"), Pointers{"/method"}) << "of several objectives";
  EXPECT_EQ(faults("method", 3), Pointers{"/method"});
  EXPECT_EQ(faults("method", "bobyqa"), Pointers{"/method"}) << "of two variables or more";
  ordered_json local = least_request();
  local["method"] = "nelder_mead";
  local["population"] = 8;
  EXPECT_EQ(optimisation_faults_of(service, local), Pointers{"/population"});
  local.erase("population");
  local["budget"] = 5;
  EXPECT_EQ(optimisation_faults_of(service, local), Pointers{"/budget"});
  local["budget"] = 200;
  local["over"] = {{"radial_elements", {{"from", 20}, {"to", 90}}}};
  EXPECT_TRUE(optimisation_faults_of(service, local).contains("/method"));
  local["method"] = "bobyqa";
  local["over"] = {{"crank_velocity_rad_s", {{"from", 1}, {"to", 9}}},
                   {"crank_length_m", {{"from", 0.1}, {"to", 0.2}}}};
  EXPECT_EQ(optimisation_faults_of(service, local), Pointers{});
  local["bounds"] = {{{"metric", metric()}, {"maximum", 1}}};
  EXPECT_EQ(optimisation_faults_of(service, local), Pointers{"/method"});
  local.erase("bounds");
  local["objectives"].push_back({{"metric", "peak_contact_force_n"}});
  EXPECT_EQ(optimisation_faults_of(service, local), Pointers{"/method"});
  EXPECT_EQ(faults("sweep", {{"crank_velocity_rad_s", {1, 2}}}), Pointers{"/over/crank_velocity_rad_s"});
}

}  // namespace
}  // namespace jobs_tests
