// SPDX-License-Identifier: Apache-2.0
// Searches on a service whose first metric is sqrt(1000 crank_velocity + c_r).

#include <chrono>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "engine/simulate_linkage.h"
#include "jobs/base/errors.h"
#include "jobs/requests/parameters.h"
#include "jobs/service.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using jobs::StudyKind;
using nlohmann::json;
using nlohmann::ordered_json;

/// From 1 to 9 in steps of 2, then the step that holds the limit halved eight times: 2 / 2^8 < 0.01.
ordered_json request_for(double crank_velocity) {
  const double bound = std::sqrt(1000.0 * crank_velocity);
  return {{"name", "fast"}, {"parameters", {{"clearance_mm", 0}}},
      {"over", {{"crank_velocity_rad_s", {{"from", 1}, {"to", 9}, {"tolerance", 0.01}}}}},
          {"metric", engine::metric_table()[0].key}, {"bound", bound}};
}

json wait_for_end(const jobs::Service& service, const std::string& id) {
  for (int tries = 0; tries < 4000; ++tries) {
    json search = service.find_study(StudyKind::kSearch, id).value();
    if (search.at("state") != "running") return search;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  throw std::runtime_error("the search does not end");
}

json list(const jobs::Service& service, const std::string& state, const std::string& fields = "") {
  jobs::PageQuery query;
  query.state = state;
  query.fields = fields;
  return service.list_studies(StudyKind::kSearch, query).at("items");
}

std::set<std::string> search_faults_of(jobs::Service& service, const ordered_json& request) {
  try {
    (void)service.submit_study(StudyKind::kSearch, request);
  } catch (const jobs::InvalidRequest& invalid) {
    std::set<std::string> pointers;
    for (const jobs::Fault& fault : invalid.faults()) pointers.insert(fault.pointer);
    return pointers;
  }
  return {};
}

TEST(Search, FindsTheLimitWithTheExpectedNumberOfRuns) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 2));
  const json begun = service.submit_study(StudyKind::kSearch, request_for(5.3));
  EXPECT_EQ(begun.at("most_evaluations"), 13);
  const json ended = wait_for_end(service, begun.at("id"));
  EXPECT_EQ(ended.at("state"), "succeeded");
  EXPECT_EQ(ended.at("progress"), 1.0);
  EXPECT_EQ(ended.at("counts").at("succeeded"), 13);
  EXPECT_EQ(engine.begun_speeds().size(), 13U);
  const json& limit = ended.at("limits").at(0);
  EXPECT_EQ(limit.at("verdict"), "found");
  EXPECT_LE(limit.at("limit").get<double>(), 5.3);
  EXPECT_GT(limit.at("limit_beyond").get<double>(), 5.3);
  EXPECT_LE(limit.at("limit_beyond").get<double>() - limit.at("limit").get<double>(), 0.01);
  EXPECT_EQ(limit.at("points").size(), 13U);
  EXPECT_TRUE(limit.at("monotonic").get<bool>());
  // Every evaluation is a job of a sweep like any other, and a result that others use.
  const auto results = service.find_results(ended.at("sweep_id")).value();
  EXPECT_EQ(results.rows.size(), 13U);
  const json again =
      wait_for_end(service, service.submit_study(StudyKind::kSearch, request_for(5.3)).at("id"));
  EXPECT_EQ(again.at("limits").at(0).at("limit"), limit.at("limit"));
  EXPECT_EQ(engine.begun_speeds().size(), 13U) << "nothing is computed twice";
}

TEST(Search, LooksForALimitForEachCombinationOfTheAxes) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 2));
  ordered_json request = request_for(5.3);
  request["sweep"] = {{"coupler", {"rigid", "flexible"}}, {"restitution", {0.8, 0.9}}};
  request["replicates"] = {{"count", 3}};
  const json ended = wait_for_end(service, service.submit_study(StudyKind::kSearch, request).at("id"));
  ASSERT_EQ(ended.at("limits").size(), 4U);
  for (const json& limit : ended.at("limits")) {
    EXPECT_EQ(limit.at("verdict"), "found");
    EXPECT_NEAR(limit.at("limit").get<double>(), 5.3, 0.01);
    EXPECT_EQ(limit.at("points").at(0).at("count"), 3);
    EXPECT_EQ(limit.at("points").at(0).at("within"), 3);
    // Three of three: with 90 % confidence more than 0.05^(1/3) of all replicates.
    EXPECT_NEAR(limit.at("points").at(0).at("part_within_low").get<double>(), std::cbrt(0.05), 1e-9);
    EXPECT_EQ(limit.at("points").at(0).at("part_within_high"), 1.0);
  }
  EXPECT_EQ(ended.at("limits").at(1).at("coupler"), "rigid");
  EXPECT_EQ(ended.at("limits").at(1).at("restitution"), 0.9);
  EXPECT_EQ(ended.at("counts").at("total"), 4 * 13 * 3);
  const auto table = service.find_study_table(StudyKind::kSearch, ended.at("id")).value();
  EXPECT_EQ(table.columns.at(0), "coupler");
  EXPECT_EQ(table.rows.size(), 4U);
  EXPECT_TRUE(table.ended);
}

TEST(Search, WaitsForTheJobsThatEachValueHas) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 2));
  ordered_json request = request_for(5.3);
  request["sweep"] = {{"coupler", {"rigid", "flexible"}}};
  request["replicates"] = {{"count", 3}, {"only", {{"coupler", {"rigid"}}}}};
  const json ended = wait_for_end(service, service.submit_study(StudyKind::kSearch, request).at("id"));
  EXPECT_EQ(ended.at("state"), "succeeded");
  for (const json& limit : ended.at("limits")) EXPECT_EQ(limit.at("verdict"), "found");
  EXPECT_EQ(ended.at("counts").at("total"), 13 * 3 + 13);
}

TEST(Search, GoesOnAfterARestart) {
  const TemporaryStore store;
  FakeEngine engine;
  std::string id;
  {
    jobs::Service service(options_of(store, engine, 1));
    engine.hold();
    id = service.submit_study(StudyKind::kSearch, request_for(5.3)).at("id");
    engine.await_running(1);
  }
  engine.release();
  jobs::Service service(options_of(store, engine, 1));
  EXPECT_EQ(wait_for_end(service, id).at("limits").at(0).at("verdict"), "found");
}

TEST(Search, IsCancelledAndTakenUpAgain) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  engine.hold();
  const std::string id = service.submit_study(StudyKind::kSearch, request_for(5.3)).at("id");
  engine.await_running(1);
  EXPECT_THROW(service.delete_study(StudyKind::kSearch, id), jobs::WrongState);
  EXPECT_EQ(service.cancel_study(StudyKind::kSearch, id).value().at("state"), "cancelled");
  EXPECT_EQ(service.cancel_study(StudyKind::kSearch, id).value().at("counts").at("cancelled"), 5);
  engine.release();
  EXPECT_EQ(service.retry_study(StudyKind::kSearch, id).value().at("state"), "running");
  EXPECT_EQ(wait_for_end(service, id).at("state"), "succeeded");
  EXPECT_THROW(service.cancel_study(StudyKind::kSearch, id), jobs::WrongState);
  const std::string sweep = service.find_study(StudyKind::kSearch, id).value().at("sweep_id");
  EXPECT_TRUE(service.delete_study(StudyKind::kSearch, id));
  EXPECT_FALSE(service.find_study(StudyKind::kSearch, id).has_value());
  EXPECT_FALSE(service.find_sweep(sweep).has_value());
  EXPECT_FALSE(service.delete_study(StudyKind::kSearch, id));
}

/// Begins a search, and cancels the job of its last first value, which is beyond the limit. The engine holds.
json begin_with_a_cancelled_job(jobs::Service& service, FakeEngine& engine) {
  engine.hold();
  json begun = service.submit_study(StudyKind::kSearch, request_for(5.3));
  engine.await_running(1);
  const json& last = begun.at("limits").at(0).at("points").at(4);
  EXPECT_EQ(service.cancel_job(last.at("job_ids").at(0)).value().at("state"), "cancelled");
  return begun;
}

TEST(Search, IsRetriedWhileItRuns) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  const json begun = begin_with_a_cancelled_job(service, engine);
  const json retried = service.retry_study(StudyKind::kSearch, begun.at("id")).value();
  EXPECT_EQ(retried.at("counts").at("cancelled"), 0);
  engine.release();
  EXPECT_EQ(wait_for_end(service, begun.at("id")).at("state"), "succeeded");
}

TEST(Search, AddsNoJobsOnceOneIsCancelled) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  const json begun = begin_with_a_cancelled_job(service, engine);
  engine.release();
  const json ended = wait_for_end(service, begun.at("id"));
  EXPECT_EQ(ended.at("state"), "cancelled");
  EXPECT_EQ(ended.at("counts").at("succeeded"), 4);
  EXPECT_EQ(ended.at("counts").at("total"), 5);
}

// A study that was cancelled without its jobs would have them computed for nothing.
TEST(Search, IsCancelledWithItsJobsOrNotAtAll) {
  const TemporaryStore store;
  FakeEngine engine;
  engine.hold();
  std::string id;
  {
    jobs::Service service(options_of(store, engine, 1));
    id = service.submit_study(StudyKind::kSearch, request_for(5.3)).at("id");
  }
  execute_sql(store.file(),
              "CREATE TRIGGER refusal BEFORE UPDATE ON jobs WHEN new.state = 'cancelled' "
              "BEGIN SELECT RAISE(ABORT, 'no job is cancelled'); END");
  jobs::Service service(options_of(store, engine, 1));
  EXPECT_THROW(service.cancel_study(StudyKind::kSearch, id), jobs::StorageError);
  EXPECT_EQ(service.find_study(StudyKind::kSearch, id).value().at("state"), "running");
}

// Its evaluations are its result: without them nothing is left of it.
TEST(Search, KeepsItsSweep) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  const std::string id = service.submit_study(jobs::StudyKind::kSearch, request_for(5.3)).at("id");
  const std::string sweep = wait_for_end(service, id).at("sweep_id");
  try {
    (void)service.delete_sweep(sweep);
    ADD_FAILURE() << "the sweep is deleted";
  } catch (const jobs::WrongState& refused) {
    EXPECT_NE(std::string(refused.what()).find(id), std::string::npos) << refused.what();
  }
  EXPECT_TRUE(service.find_study(jobs::StudyKind::kSearch, id).has_value());
  EXPECT_EQ(service.find_sweep(sweep).value().at("study_id"), id);
  EXPECT_EQ(service.find_sweep(sweep).value().at("links").at("study"), "/v1/searches/" + id);
  const std::string other = service.submit_sweep({{"parameters", {{"clearance_mm", 0}}}}).at("id");
  const json listed = service.list_sweeps({}).at("items");
  ASSERT_EQ(listed.size(), 2U);
  EXPECT_EQ(listed.at(0).at("id"), other);
  EXPECT_EQ(listed.at(0).at("study_id"), nullptr);
  EXPECT_EQ(listed.at(0).at("links").at("study"), nullptr);
  EXPECT_EQ(listed.at(1).at("study_id"), id);
}

TEST(Search, TakesWhatIsAddedToItsSweepByHand) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  engine.hold();
  const json begun = service.submit_study(StudyKind::kSearch, request_for(5.3));
  engine.await_running(1);
  EXPECT_EQ(service
                .extend_sweep(begun.at("sweep_id"),
                              ordered_json::parse(R"({"cases": [{"crank_velocity_rad_s": 5.2}]})"))
                .value()
                .at("counts")
                .at("total"),
            6);
  engine.release();
  const json limit = wait_for_end(service, begun.at("id")).at("limits").at(0);
  EXPECT_EQ(limit.at("verdict"), "found");
  EXPECT_NEAR(limit.at("limit").get<double>(), 5.3, 0.01);
  EXPECT_EQ(limit.at("points").at(2).at("value"), 5.0);
  EXPECT_EQ(limit.at("points").at(3).at("value"), 5.2) << "from there on there was less to halve";
}

TEST(Search, GoesOnWithWhatIsAddedToItsSweepAfterItsEnd) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  const json ended = wait_for_end(
      service, service.submit_study(StudyKind::kSearch, request_for(5.3)).at("id"));
  engine.hold();
  (void)service.extend_sweep(ended.at("sweep_id"),
                             ordered_json::parse(R"({"cases": [{"crank_velocity_rad_s": 5.2}]})"));
  const json extended = service.find_study(StudyKind::kSearch, ended.at("id")).value();
  EXPECT_EQ(extended.at("state"), "running");
  EXPECT_EQ(extended.at("limits").at(0).at("verdict"), "open");
  engine.release();
  const json again = wait_for_end(service, ended.at("id"));
  EXPECT_EQ(again.at("state"), "succeeded");
  EXPECT_EQ(again.at("limits").at(0).at("limit"), ended.at("limits").at(0).at("limit"));
  EXPECT_EQ(again.at("limits").at(0).at("points").size(), 14U);
}

TEST(Search, IsStoredOnceUnderOneKey) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  const json first = service.submit_study(StudyKind::kSearch, request_for(5.3), "key-1");
  EXPECT_EQ(first.at("state"), "running");
  (void)wait_for_end(service, first.at("id"));
  EXPECT_EQ(service.submit_study(StudyKind::kSearch, request_for(5.3), "key-1"), first);
  EXPECT_THROW((void)service.submit_study(StudyKind::kSearch, request_for(5.4), "key-1"),
               jobs::InvalidRequest);
  EXPECT_EQ(list(service, "").size(), 1U);
  // Computed jobs are known when the next search begins. The answer is kept as it is at the beginning.
  const json second = service.submit_study(StudyKind::kSearch, request_for(5.3), "key-2");
  EXPECT_EQ(second.at("state"), "running");
  EXPECT_EQ(second.at("counts").at("succeeded"), 5);
  EXPECT_EQ(second.at("limits").at(0).at("points").at(0).at("pending"), 1);
}

TEST(Search, IsWaitedFor) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  engine.hold();
  const std::string id = service.submit_study(StudyKind::kSearch, request_for(5.3)).at("id");
  EXPECT_FALSE(service.wait_for_study(StudyKind::kSearch, id, std::chrono::milliseconds(20)));
  EXPECT_FALSE(service.wait_for_study(StudyKind::kSearch, "sch_none", std::chrono::hours(1)));
  EXPECT_FALSE(service.wait_for_study(StudyKind::kWear, id, std::chrono::hours(1)));
  engine.release();
  EXPECT_TRUE(service.wait_for_study(StudyKind::kSearch, id, std::chrono::seconds(300)));
  EXPECT_EQ(service.find_study(StudyKind::kSearch, id).value().at("state"), "succeeded");
}

// The fake engine fails at a restitution of 0.5.
TEST(Search, SaysWhichCombinationIsLostToAFailedJob) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 2));
  ordered_json request = request_for(5.3);
  request["sweep"] = {{"restitution", {0.5, 0.9}}};
  const json ended = wait_for_end(service, service.submit_study(StudyKind::kSearch, request).at("id"));
  EXPECT_EQ(ended.at("state"), "failed");
  const json& lost = ended.at("limits").at(0);
  EXPECT_EQ(lost.at("verdict"), "lost");
  EXPECT_EQ(lost.at("lost_reason"), "non_finite");
  EXPECT_EQ(lost.at("points").at(0).at("lost_reason"), "non_finite");
  EXPECT_EQ(ended.at("limits").at(1).at("verdict"), "found");
  EXPECT_EQ(ended.at("limits").at(1).at("lost_reason"), nullptr);
}

// The second metric applies to none of the fake engine's jobs.
TEST(Search, SaysThatItsMetricDoesNotApply) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 2));
  ordered_json request = request_for(5.3);
  request["metric"] = engine::metric_table()[1].key;
  const std::string id = service.submit_study(StudyKind::kSearch, request).at("id");
  const json ended = wait_for_end(service, id);
  EXPECT_EQ(ended.at("counts").at("succeeded"), 5);
  EXPECT_EQ(ended.at("limits").at(0).at("verdict"), "lost");
  EXPECT_EQ(ended.at("limits").at(0).at("lost_reason"), "no_value");
  const jobs::ResultTable table = service.find_study_table(StudyKind::kSearch, id).value();
  ASSERT_EQ(table.columns.back(), "lost_reason");
  EXPECT_EQ(table.rows.at(0).back(), "no_value");
}

// Run-ups are 0 or at least 1e-6 s: both ends fit, the middle does not.
TEST(Search, GoesOnBesideAValueThatDoesNotFit) {
  const TemporaryStore store;
  jobs::ServiceOptions options = options_of(store, 2);
  options.runner = [](const jobs::JobSpec& spec, const engine::StopQuery&, const auto&...) {
    engine::RunResult result;
    const bool exceeds = spec.parameters.run_up > 0.0 && spec.parameters.restitution < 0.85;
    result.metrics.assign(engine::metric_table().size(), exceeds ? 2.0 : 0.0);
    return result;
  };
  jobs::Service service(options);
  const ordered_json request{{"over", {{"run_up_s", {{"from", 0}, {"to", 1.5e-6}, {"first", 2}}}}},
                             {"metric", engine::metric_table()[0].key},
                             {"bound", 1},
                             {"sweep", {{"restitution", {0.8, 0.9}}}}};
  const json ended = wait_for_end(service, service.submit_study(StudyKind::kSearch, request).at("id"));
  EXPECT_EQ(ended.at("state"), "failed");
  EXPECT_EQ(ended.at("error"), nullptr);
  EXPECT_EQ(ended.at("counts").at("succeeded"), 4);
  const json& lost = ended.at("limits").at(0);
  EXPECT_EQ(lost.at("verdict"), "lost");
  EXPECT_EQ(lost.at("lost_reason"), "invalid_parameters");
  EXPECT_EQ(lost.at("points").at(1).at("lost"), 1);
  EXPECT_EQ(ended.at("limits").at(1).at("verdict"), "never_exceeded");
}

TEST(Search, IsRefusedWithEveryFault) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  EXPECT_EQ(search_faults_of(service, ordered_json::object()),
            (std::set<std::string>{"/over", "/metric", "/bound"}));
  ordered_json request = request_for(5.3);
  request["over"]["crank_velocity_rad_s"] = {
      {"from", 1}, {"to", 5000}, {"tolerance", 0}, {"first", 1}, {"steps", 3}};
  request["metric"] = "peak";
  request["quantile"] = 1.5;
  request["sweep"] = {{"restitution", {2}}};
  request["bounds"] = 1;
  EXPECT_EQ(search_faults_of(service, request),
            (std::set<std::string>{"/bounds", "/over/crank_velocity_rad_s/steps",
                                   "/over/crank_velocity_rad_s/tolerance", "/over/crank_velocity_rad_s/first",
                                   "/metric", "/quantile", "/sweep/restitution/0"}));
  request = request_for(5.3);
  request["sweep"] = {{"crank_velocity_rad_s", {5}}};
  EXPECT_EQ(search_faults_of(service, request), std::set<std::string>{"/over/crank_velocity_rad_s"});
  request = request_for(5.3);
  request["replicates"] = {{"count", 5000}};
  EXPECT_EQ(search_faults_of(service, request), std::set<std::string>{"/over/crank_velocity_rad_s"})
      << "65,000 jobs";
  // The clearance is less than the bearing's radius, which only both together show.
  request = {{"over", {{"clearance_mm", {{"from", 1}, {"to", 6}}}}},
             {"metric", engine::metric_table()[0].key},
             {"bound", 1}};
  EXPECT_EQ(search_faults_of(service, request), std::set<std::string>{"/over/clearance_mm"});
  request["over"] = {{"bristle_stiffness_1_m", {{"from", 1e-310}, {"to", 1e9}, {"scale", "log"}}}};
  EXPECT_EQ(search_faults_of(service, request), std::set<std::string>{"/over/bristle_stiffness_1_m/to"});
  EXPECT_TRUE(list(service, "").empty());
}

// A token of digits is no place in a list of that length.
TEST(Search, IsRefusedOverNumbersOfNoDescription) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  for (const std::string path : {"linkage.bodies.rod.mass_kg", "linkage.01", "linkage.3000", "linkage.-",
                                 "linkage.123456789012345678901"}) {
    ordered_json request = request_for(5.3);
    request["over"] = {{path, {{"from", 0}, {"to", 1}}}};
    EXPECT_EQ(search_faults_of(service, request), std::set<std::string>{"/over/" + path});
    request = request_for(5.3);
    request["sweep"] = {{path, {1, 2}}};
    EXPECT_EQ(search_faults_of(service, request), std::set<std::string>{"/sweep/" + path});
  }
}

ordered_json request_over_a_pendulum() {
  const ordered_json linkage = ordered_json::parse(R"({
    "bodies": {"rod": {"mass_kg": 1, "centre_of_mass_m": [0, 0, -0.5]}},
    "joints": {"pin": {"kind": "revolute", "axis": "y", "from": "ground", "to": "rod"}}})");
  return {{"parameters", {{"linkage", linkage}}},
          {"over", {{"linkage.bodies.rod.mass_kg", {{"from", 1}, {"to", 9}, {"tolerance", 0.01}}}}},
          {"metric", jobs::metric_table(json{{"linkage", json(linkage)}}).at(0).key},
          {"bound", 2.5}};
}

// Numbers of a description are searched for each value of another parameter, by a metric of the linkage.
TEST(Search, LooksForTheLimitOfANumberOfADescription) {
  const TemporaryStore store;
  jobs::ServiceOptions options = options_of(store, 2);
  options.runner = [](const jobs::JobSpec& spec, const engine::StopQuery&, const auto&...) {
    engine::RunResult result;
    const engine::LinkageTables tables = engine::linkage_tables(spec.linkage.value());
    const engine::LinkageBody& rod = spec.linkage->bodies.at(0);
    // Above 2.5 from 5.3 kg on with the lighter gravity, from 2.65 kg on with the heavier one.
    result.metrics.assign(tables.metrics.size(), rod.mass * spec.linkage->gravity_W.norm() / 9.81 * 2.5 / 5.3);
    return result;
  };
  jobs::Service service(options);
  ordered_json request = request_over_a_pendulum();
  request["sweep"] = {{"gravity_m_s2", {9.81, 19.62}}};
  const json ended = wait_for_end(service, service.submit_study(StudyKind::kSearch, request).at("id"));
  ASSERT_EQ(ended.at("state"), "succeeded") << ended;
  ASSERT_EQ(ended.at("limits").size(), 2U);
  EXPECT_NEAR(ended.at("limits").at(0).at("limit").get<double>(), 5.3, 0.01);
  EXPECT_NEAR(ended.at("limits").at(1).at("limit").get<double>(), 2.65, 0.01);
  EXPECT_EQ(ended.at("parameter"), "linkage.bodies.rod.mass_kg");
}

// A search halves its interval: of whole numbers it looks at those beside the middle.
TEST(Search, LooksAtWholeNumbersOfADescription) {
  const TemporaryStore store;
  jobs::ServiceOptions options = options_of(store, 2);
  options.runner = [](const jobs::JobSpec& spec, const engine::StopQuery&, const auto&...) {
    engine::RunResult result;
    result.metrics.assign(engine::linkage_tables(spec.linkage.value()).metrics.size(),
                          spec.linkage->bodies.at(0).elements);
    return result;
  };
  jobs::Service service(options);
  ordered_json request = request_over_a_pendulum();
  request["parameters"]["linkage"]["bodies"]["rod"] = {
      {"mass_kg", 1}, {"beam", {{"length_m", 1}, {"diameter_mm", 9}}}};
  request["over"] = {{"linkage.bodies.rod.beam.elements", {{"from", 2}, {"to", 20}, {"tolerance", 0.5}}}};
  request["bound"] = 6.5;
  const json ended = wait_for_end(service, service.submit_study(StudyKind::kSearch, request).at("id"));
  ASSERT_EQ(ended.at("state"), "succeeded") << ended;
  EXPECT_EQ(ended.at("limits").at(0).at("limit"), 6) << ended;
  EXPECT_EQ(ended.at("limits").at(0).at("limit_beyond"), 7) << ended;
}

TEST(Search, OfADescribedLinkageIsRefusedWithEveryFault) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  ordered_json request = request_over_a_pendulum();
  request["metric"] = "peak_slider_acceleration_m_s2";
  EXPECT_EQ(search_faults_of(service, request), std::set<std::string>{"/metric"});
  request = request_over_a_pendulum();
  request["over"] = {{"linkage.bodies.rod.mass_kg", {{"from", 1}, {"to", -9}}}};
  EXPECT_EQ(search_faults_of(service, request), std::set<std::string>{"/over/linkage.bodies.rod.mass_kg"});
  request = request_over_a_pendulum();
  request["sweep"] = {{"linkage.bodies.rod.mass_kg", {1, 2}}};
  EXPECT_EQ(search_faults_of(service, request), std::set<std::string>{"/over/linkage.bodies.rod.mass_kg"});
  request = request_over_a_pendulum();
  request["replicates"] = {{"count", 0}};
  EXPECT_EQ(search_faults_of(service, request), std::set<std::string>{"/replicates/count"});
  request = request_over_a_pendulum();
  request["over"] = {{"linkage.bodies.rod.length", {{"from", 1}, {"to", 9}}}};
  request.erase("sweep");
  EXPECT_EQ(search_faults_of(service, request), std::set<std::string>{"/over/linkage.bodies.rod.length"})
      << "no number of a body";
}

TEST(Search, IsListedByItsState) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  const std::string id = service.submit_study(StudyKind::kSearch, request_for(5.3)).at("id");
  (void)wait_for_end(service, id);
  EXPECT_EQ(list(service, "succeeded").at(0).at("id"), id);
  EXPECT_TRUE(list(service, "running").empty());
  EXPECT_THROW((void)list(service, "queued"), jobs::InvalidRequest);
  EXPECT_EQ(list(service, "", "id,metric").at(0).size(), 2U);
}

}  // namespace
}  // namespace jobs_tests
