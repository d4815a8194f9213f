// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

#include "jobs/base/errors.h"
#include "jobs/base/program_info.h"
#include "jobs/requests/parameters.h"
#include "jobs/results/csv.h"
#include "jobs/service.h"
#include "tests/jobs/request_support.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

std::size_t service_column(const jobs::ResultTable& table, const std::string& name) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), name);
  EXPECT_NE(found, table.columns.end()) << name;
  return static_cast<std::size_t>(found - table.columns.begin());
}

TEST(Service, ComputesASweepAndShowsIt) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 2));
  const char* request =
      R"({"name": "paper", "sweep": {"crank_velocity_rad_s": [5, 10], "clearance_mm": [0.5, 0.25]},
         "replicates": {"count": 2}})";
  const std::string id = submitted(service, request);
  const json sweep = finished(service, id);
  EXPECT_EQ(sweep.at("state"), "succeeded");
  EXPECT_EQ(
      sweep.at("counts"),
      json_of(R"({"queued": 0, "running": 0, "succeeded": 8, "failed": 0, "cancelled": 0, "total": 8})"));
  EXPECT_EQ(sweep.at("progress"), 1.0);
  EXPECT_EQ(sweep.at("eta_s"), 0.0);
  EXPECT_EQ(sweep.at("name"), "paper");
  EXPECT_EQ(sweep.at("request"), json_of(request));
  EXPECT_EQ(sweep.at("axes"), json_of(R"(["crank_velocity_rad_s", "clearance_mm"])"));
  EXPECT_EQ(sweep.at("links"), (json{{"self", "/v1/sweeps/" + id},
                                     {"results", "/v1/sweeps/" + id + "/results"},
                                     {"events", "/v1/sweeps/" + id + "/events"},
                                     {"cancel", "/v1/sweeps/" + id + "/cancel"},
                                     {"retry", "/v1/sweeps/" + id + "/retry"},
                                     {"extend", "/v1/sweeps/" + id + "/extend"},
                                     {"move", "/v1/sweeps/" + id + "/move"},
                                     {"study", nullptr}}));
  for (const char* time : {"created_at", "started_at", "ended_at"}) {
    std::string form = sweep.at(time);
    std::replace_if(form.begin(), form.end(), [](char c) { return c >= '0' && c <= '9'; }, 'd');
    EXPECT_EQ(form, "dddd-dd-ddTdd:dd:dd.dddZ") << time;
  }

  const jobs::ResultTable table = service.find_results(id).value();
  EXPECT_EQ(
      (std::vector<std::string>(table.columns.begin(), table.columns.begin() + 5)),
      (std::vector<std::string>{"job_id", "state", "replicate", "crank_velocity_rad_s", "clearance_mm"}));
  EXPECT_EQ(table.columns.size(), 5 + engine::metric_table().size());
  ASSERT_EQ(table.rows.size(), 8U);
  EXPECT_EQ((std::vector<json>(table.rows[5].begin() + 1, table.rows[5].begin() + 5)),
            (std::vector<json>{"succeeded", 1, 10.0, 0.5}));
  const std::string metric = engine::metric_table()[0].key;
  // what the fake engine makes of it
  EXPECT_EQ(table.rows[5][service_column(table, metric)], std::sqrt(10.0e3 + 0.5e-3));
  EXPECT_TRUE(table.rows[5][6].is_null());                                      // not a number there
}

TEST(Service, ShowsAJobWithAllItsParameters) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  const std::string sweep = submitted(service, R"({"sweep": {"clearance_mm": [0.5]}})");
  finished(service, sweep);
  const json job = service.find_job(first_job(service, sweep)).value();
  EXPECT_EQ(job.at("state"), "succeeded");
  EXPECT_EQ(job.at("sweep_id"), sweep);
  EXPECT_FALSE(job.contains("replicate"));
  EXPECT_EQ(job.at("parameters"), jobs::complete_parameters({{"clearance_mm", 0.5}}, ""));
  EXPECT_EQ(job.at("metrics").size(), engine::metric_table().size());
  for (const auto& info : engine::metric_table()) {
    EXPECT_EQ(job.at("metrics").at(info.key).is_number_integer(), info.integer) << info.key;
  }
  EXPECT_TRUE(job.at("error").is_null());
  EXPECT_EQ(job.at("run").at("attempts"), 1);
  EXPECT_EQ(job.at("run").at("reused"), false);
  EXPECT_FALSE(job.at("run").at("host").get<std::string>().empty());
  EXPECT_EQ(job.at("run").at("program").size(), 4U);
  EXPECT_EQ(job.at("run").at("program").at("engine"), std::string(jobs::kEngineVersion));
  EXPECT_GE(job.at("run").at("wall_time_s").get<double>(), 0.0);
  EXPECT_EQ(job.at("links").at("sweep"), "/v1/sweeps/" + sweep);
}

// A former version took it: its results stay readable.
TEST(Service, ShowsResultsOfARequestThatIsRefusedNow) {
  const TemporaryStore store;
  FakeEngine engine;
  std::string id;
  {
    jobs::Service service(options_of(store, engine, 2));
    id = submitted(service, R"({"sweep": {"crank_velocity_rad_s": [5, 10]}})");
    finished(service, id);
  }
  execute_sql(store.file(), "UPDATE sweeps SET request = json_set(request, '$.parameters', json('{\"linkage\": 5}'))");
  jobs::Service service(options_of(store, engine, 2));
  const auto results = service.find_results(id).value();
  EXPECT_EQ(results.rows.size(), 2U);
  EXPECT_NE(std::ranges::find(results.columns, "peak_slider_acceleration_m_s2"), results.columns.end());
}

TEST(Service, TakesSingleJobs) {
  const TemporaryStore store;
  FakeEngine engine;
  engine.hold();
  jobs::Service service(options_of(store, engine, 1));
  const json job = service.submit_job({{"clearance_mm", 0.5}});
  EXPECT_TRUE(job.at("sweep_id").is_null());
  EXPECT_TRUE(job.at("links").at("sweep").is_null());
  EXPECT_TRUE(job.at("metrics").is_null());
  EXPECT_EQ(pointers_of(faults_of([&] {
              (void)service.submit_job({{"clearance_mm", -1}});
            })),
            (std::vector<std::string>{"/clearance_mm"}));
  engine.await_running(1);
  EXPECT_EQ(service.find_job(job.at("id")).value().at("state"), "running");
  engine.release();
}

TEST(Service, ComputesIdenticalJobsOnce) {
  const TemporaryStore store;
  FakeEngine engine;
  engine.hold();
  jobs::Service service(options_of(store, engine, 2));
  const char* request = R"({"sweep": {"crank_velocity_rad_s": [5]}})";
  const std::string first = submitted(service, request);
  const std::string second = submitted(service, request);
  engine.await_running(1);
  engine.release();
  finished(service, first);
  finished(service, second);
  const std::string third = submitted(service, request);
  EXPECT_EQ(service.find_sweep(third).value().at("state"), "succeeded");
  EXPECT_EQ(engine.begun_speeds().size(), 1U);
  EXPECT_EQ(service.find_job(first_job(service, second)).value().at("run").at("reused"), true);
  const std::string forced =
      submitted(service, R"({"sweep": {"crank_velocity_rad_s": [5]}, "reuse": false})");
  finished(service, forced);
  EXPECT_EQ(engine.begun_speeds().size(), 2U);
}

TEST(Service, StartsASmallSweepBesideALargeOneAsSoonAsAThreadIsFree) {
  const TemporaryStore store;
  FakeEngine engine;
  engine.hold();
  jobs::Service service(options_of(store, engine, 1));
  const std::string large = submitted(service, R"({"sweep": {"crank_velocity_rad_s": [1, 2, 3, 4, 5, 6]}})");
  engine.await_running(1);
  const std::string small = submitted(service, R"({"sweep": {"crank_velocity_rad_s": [100]}})");
  engine.release();
  finished(service, small);
  finished(service, large);
  EXPECT_EQ(engine.begun_speeds(), (std::vector<double>{1, 100, 2, 3, 4, 5, 6}));
}

TEST(Service, LeavesASweepRunningWhenAJobFails) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  const std::string id = submitted(service, R"({"sweep": {"restitution": [0.5, 0.4, 0.9]}})");
  const json sweep = finished(service, id);
  EXPECT_EQ(sweep.at("state"), "failed");
  EXPECT_EQ(sweep.at("counts").at("failed"), 2);
  EXPECT_EQ(sweep.at("counts").at("succeeded"), 1);
  const auto rows = service.find_results(id).value().rows;
  const json numerical = service.find_job(rows[0][0]).value();
  EXPECT_EQ(numerical.at("error"),
            json_of(R"({"reason": "non_finite", "detail": "the fake state is no number", "t_s": 1.0})"));
  EXPECT_TRUE(numerical.at("metrics").is_null());
  EXPECT_TRUE(service.find_trajectory(rows[0][0], {}).has_value());  // as far as it came
  const json thrown = service.find_job(rows[1][0]).value();
  EXPECT_EQ(thrown.at("error").at("reason"), "internal");
  EXPECT_EQ(thrown.at("error").at("detail"), "the fake engine broke");
  EXPECT_TRUE(thrown.at("error").at("t_s").is_null());
  EXPECT_FALSE(service.find_trajectory(rows[1][0], {}).has_value());
  // The same in a table, for those who ask.
  const auto table = service
                         .find_results(id, {.fields = "restitution,error_reason,error_detail,duration_s",
                                            .filters = {},
                                            .order_by = {},
                                            .limit = {}})
                         .value();
  EXPECT_EQ(
      json(table.rows),
      json_of(
          R"([[0.5, "non_finite", "the fake state is no number", 5.0], [0.4, "internal",
             "the fake engine broke", 5.0],
                                          [0.9, null, null, 5.0]])"));
}

TEST(Service, PutsRunningJobsBackWhenItStopsAndGoesOnWhenItStarts) {
  const TemporaryStore store;
  FakeEngine engine;
  engine.hold();
  std::string id;
  {
    jobs::Service service(options_of(store, engine, 2));
    id = submitted(service, R"({"sweep": {"crank_velocity_rad_s": [1, 2, 3]}})");
    engine.await_running(2);
    const std::uint64_t before = service.activity();
    service.stop();
    EXPECT_GE(service.activity(), before + 3);  // of the stop, and of each job that is put back
    EXPECT_EQ(service.find_sweep(id).value().at("counts").at("queued"), 3);
    EXPECT_THROW((void)service.submit_sweep(request_of("{}")), jobs::Stopped);
    EXPECT_THROW((void)service.submit_job(json::object()), jobs::Stopped);
  }
  engine.release();
  const jobs::Service service(options_of(store, engine, 2));
  EXPECT_EQ(finished(service, id).at("counts").at("succeeded"), 3);
}

/// All that a sweep computed, without what is about the runs.
std::string outcome_of(int threads, const char* request) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, threads));
  const std::string id = submitted(service, request);
  finished(service, id);
  jobs::ResultTable table = service.find_results(id).value();
  std::string outcome;
  for (auto& row : table.rows) {
    outcome += jobs::to_csv(service.find_trajectory(row.at(0), {}).value());
    row.at(0) = nullptr;
  }
  return outcome + jobs::to_csv(table);
}

TEST(Service, GivesTheSameBytesOnOneThreadAndOnTwo) {
  const char* request =
      R"({"sweep": {"crank_velocity_rad_s": [1, 2, 3, 4, 5], "clearance_mm": [0, 0.1, 0.2]}})";
  const std::string one = outcome_of(1, request);
  EXPECT_GT(one.size(), 1000U);
  EXPECT_EQ(one, outcome_of(2, request));
}

TEST(Service, CutsTrajectories) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  const std::string sweep = submitted(service, "{}");
  finished(service, sweep);
  const std::string job = first_job(service, sweep);
  const auto all = service.find_trajectory(job, {}).value();
  ASSERT_EQ(all.columns[0].size(), 11U);
  const auto part =
      service.find_trajectory(job, {.channels = {"slider_position_m"}, .from = 0.25, .to = 0.5}).value();
  EXPECT_EQ(part.columns[0], (std::vector<double>{0.3, 0.4, 0.5}));  // both ends included
  EXPECT_EQ(part.columns[1], (std::vector<double>(all.columns[1].begin() + 3, all.columns[1].begin() + 6)));
  EXPECT_EQ(service.find_trajectory(job, {.channels = {"t_s"}, .from = {}, .to = 0.0}).value().columns,
            (std::vector<std::vector<double>>{{0.0}}));
  EXPECT_TRUE(
      service.find_trajectory(job, {.channels = {}, .from = 7.0, .to = {}}).value().columns[1].empty());
  EXPECT_FALSE(service.find_trajectory("job_none", {}).has_value());
  EXPECT_EQ(pointers_of(faults_of([&] {
              (void)service.find_trajectory(job, {.channels = {"t_s", "x"}, .from = 2.0, .to = 1.0});
            })),
            (std::vector<std::string>{"/channels/1", "/to"}));
}

TEST(Service, ListsInPagesNewestFirst) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  std::vector<std::string> ids;
  for (int i = 1; i <= 5; ++i) {
    ids.push_back(submitted(
        service, (R"({"name": "n", "sweep": {"restitution": [)" + std::to_string(i == 2 ? 0.5 : 0.6) + "]}}")
                     .c_str()));
    finished(service, ids.back());
  }
  std::vector<std::string> listed;
  std::string cursor;
  int pages = 0;
  do {
    const json page = service.list_sweeps({.state = "", .limit = 2, .cursor = cursor});
    for (const json& item : page.at("items")) {
      listed.push_back(item.at("id"));
      EXPECT_FALSE(item.contains("request"));
      EXPECT_TRUE(item.contains("counts"));
    }
    cursor = page.at("next_cursor");
    ++pages;
  } while (!cursor.empty() && pages < 10);
  EXPECT_EQ(pages, 3);
  EXPECT_EQ(listed, (std::vector<std::string>(ids.rbegin(), ids.rend())));
  EXPECT_EQ(service.list_sweeps({.state = "", .limit = 5, .cursor = ""}).at("next_cursor"), "");
  const json failed = service.list_sweeps({.state = "failed", .limit = 10, .cursor = ""});
  ASSERT_EQ(failed.at("items").size(), 1U);
  EXPECT_EQ(failed.at("items")[0].at("id"), ids[1]);
  const json some_jobs = service.list_jobs({.state = "succeeded", .limit = 3, .cursor = ""});
  EXPECT_EQ(some_jobs.at("items").size(), 3U);
  EXPECT_FALSE(some_jobs.at("items")[0].contains("parameters"));
  const json rest =
      service.list_jobs({.state = "succeeded", .limit = 3, .cursor = some_jobs.at("next_cursor")});
  EXPECT_EQ(rest.at("items").size(), 1U);
  EXPECT_EQ(rest.at("next_cursor"), "");
  EXPECT_EQ(
      pointers_of(faults_of([&] { (void)service.list_jobs({.state = "odd", .limit = 0, .cursor = "'"}); })),
      (std::vector<std::string>{"/cursor", "/limit", "/state"}));
}

TEST(Service, EstimatesTheTimeThatIsLeft) {
  const TemporaryStore store;
  FakeEngine engine;
  engine.hold();
  jobs::Service service(options_of(store, engine, 1));
  const std::string id = submitted(service, R"({"sweep": {"crank_velocity_rad_s": [1, 2]}})");
  engine.await_running(1);
  EXPECT_TRUE(service.find_sweep(id).value().at("eta_s").is_null());
  EXPECT_EQ(service.find_sweep(id).value().at("progress"), 0.0);
  engine.release();
}

TEST(Service, WaitsForNoLongerThanItIsTold) {
  const TemporaryStore store;
  FakeEngine engine;
  engine.hold();
  jobs::Service service(options_of(store, engine, 1));
  const std::string id = submitted(service, "{}");
  EXPECT_FALSE(service.wait_for_sweep(id, 20ms));
  EXPECT_FALSE(service.wait_for_sweep("swp_none", 20s));
  engine.release();
  EXPECT_TRUE(service.wait_for_sweep(id, std::chrono::milliseconds::max()));
}

TEST(Service, StoresNothingOfAFaultyRequest) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  EXPECT_THROW((void)service.submit_sweep(request_of(R"({"sweep": {"clearance_mm": [0, 9]}})")),
               jobs::InvalidRequest);
  EXPECT_EQ(service.list_jobs({}).at("items").size(), 0U);
}

TEST(Service, ComputesNothingBeforeItIsTold) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::ServiceOptions options = options_of(store, engine, 2);
  options.start = jobs::Start::kWhenTold;
  jobs::Service service(options);
  const std::string id =
      service.submit_sweep(json::parse(R"({"sweep": {"crank_velocity_rad_s": [5, 6, 7]}})")).at("id");
  EXPECT_FALSE(service.wait_for_sweep(id, std::chrono::milliseconds(50)));
  EXPECT_TRUE(engine.begun_speeds().empty());
  service.start();
  service.start();  // once more changes nothing
  EXPECT_TRUE(service.wait_for_sweep(id, std::chrono::seconds(300)));
  EXPECT_EQ(engine.begun_speeds().size(), 3U);
}

}  // namespace
}  // namespace jobs_tests
