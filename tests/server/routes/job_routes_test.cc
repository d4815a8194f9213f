// SPDX-License-Identifier: Apache-2.0
#include "server/routes/job_routes.h"

#include <chrono>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/server/service_fixture.h"

namespace {

using nlohmann::json;
using server_tests::Bench;
using server_tests::endless_run;
using server_tests::header;

/// Submits one job and waits for its end.
std::string run_job(Bench& bench, const std::string& parameters) {
  const auto created = bench.call("POST", "/v1/jobs", parameters);
  EXPECT_EQ(created.status, 201) << created.body;
  const std::string place = header(created, "Location");
  for (int tries = 0; tries < 2000; ++tries) {
    const json job = json::parse(bench.call("GET", place).body);
    if (job.at("state") != "queued" && job.at("state") != "running") return job.at("id");
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ADD_FAILURE() << "the job does not end";
  return "";
}

TEST(PostJob, RunsToItsResource) {
  Bench bench;
  const std::string id = run_job(bench, R"({"clearance_mm": 0.3})");
  const json job = json::parse(bench.call("GET", "/v1/jobs/" + id).body);
  EXPECT_EQ(job.at("state"), "succeeded");
  EXPECT_EQ(job.at("parameters").at("clearance_mm"), 0.3);
  // A default of the model, filled in.
  EXPECT_EQ(job.at("parameters").at("restitution"), 0.9);
  const auto metrics = engine::metric_table();
  EXPECT_NEAR(job.at("metrics").at(metrics[2].key).get<double>(), 200.3, 1e-9);
  EXPECT_EQ(json::parse(bench.call("GET", "/v1/jobs").body).at("items").at(0).at("id"), id);
}

TEST(PostJob, NamesEveryFault) {
  Bench bench;
  const auto response = bench.call("POST", "/v1/jobs", R"({"clearance_mm": -1, "coupler": "soft"})");
  EXPECT_EQ(response.status, 422);
  EXPECT_EQ(json::parse(response.body).at("errors").size(), 2U);
}

TEST(CancelJob, EndsWhatRuns) {
  Bench bench(endless_run);
  const auto created = bench.call("POST", "/v1/jobs", "{}");
  ASSERT_EQ(created.status, 201) << created.body;
  const std::string place = header(created, "Location");
  EXPECT_EQ(bench.call("POST", place + "/cancel").status, 200);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  std::string state;
  while (state != "cancelled" && std::chrono::steady_clock::now() < deadline) {
    state = json::parse(bench.call("GET", place).body).at("state");
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(state, "cancelled");
}

TEST(DeleteJob, DeletesOneOfNoSweep) {
  Bench bench;
  const json sweep = json::parse(bench.call("POST", "/v1/sweeps", R"({"sweep": {"clearance_mm": [0.1]}})").body);
  const std::string results = "/v1/sweeps/" + sweep.at("id").get<std::string>() + "/results";
  const std::string of_sweep = json::parse(bench.call("GET", results).body).at(0).at("job_id");
  EXPECT_EQ(bench.call("DELETE", "/v1/jobs/" + of_sweep).status, 409);
  const std::string place = "/v1/jobs/" + run_job(bench, R"({"crank_velocity_rad_s": 7})");
  EXPECT_EQ(bench.call("DELETE", place).status, 204);
  EXPECT_EQ(bench.call("GET", place).status, 404);
  EXPECT_EQ(bench.call("DELETE", place).status, 404);
}

TEST(GetTrajectory, GivesTheChannelsAndTimesAskedFor) {
  Bench bench;
  const std::string path = "/v1/jobs/" + run_job(bench, "{}") + "/trajectory";
  const auto response = bench.call(
      "GET", path, "", {{"channels", "slider_acceleration_m_s2"}, {"from", "0.001"}, {"to", "0.002"}});
  ASSERT_EQ(response.status, 200) << response.body;
  const json trajectory = json::parse(response.body);
  EXPECT_EQ(trajectory.at("channels"), json::parse(R"(["t_s", "slider_acceleration_m_s2"])"));
  EXPECT_EQ(trajectory.at("columns").at("t_s"), json::parse("[0.001, 0.002]"));
  // known_run: sample k of channel c is 10 c + k.
  const auto& samples = trajectory.at("columns").at("slider_acceleration_m_s2");
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[1].get<double>() - samples[0].get<double>(), 1.0);
}

TEST(GetTrajectory, GivesEveryChannelAsCsv) {
  Bench bench;
  const std::string path = "/v1/jobs/" + run_job(bench, "{}") + "/trajectory";
  const auto response = bench.call("GET", path, "", {{"format", "csv"}});
  ASSERT_EQ(response.status, 200);
  EXPECT_EQ(response.body.substr(0, response.body.find(',')), "t_s");
  const json all = json::parse(bench.call("GET", path).body);
  EXPECT_EQ(all.at("channels").size(), engine::channel_table({}).size());
}

TEST(GetTrajectory, RefusesAFaultyQuery) {
  Bench bench;
  const std::string path = "/v1/jobs/" + run_job(bench, "{}") + "/trajectory";
  EXPECT_EQ(bench.call("GET", path, "", {{"channels", "t_s,no_such_channel"}}).status, 422);
  EXPECT_EQ(bench.call("GET", path, "", {{"channel", "t_s"}}).status, 422);
  EXPECT_EQ(bench.call("GET", path, "", {{"from", "soon"}}).status, 422);
  EXPECT_EQ(bench.call("GET", path, "", {{"format", "xml"}}).status, 422);
}

TEST(GetTrajectory, TellsAJobWithoutOneFromNoJob) {
  Bench bench(endless_run);
  const std::string place = header(bench.call("POST", "/v1/jobs", "{}"), "Location");
  const auto none_yet = bench.call("GET", place + "/trajectory");
  EXPECT_EQ(none_yet.status, 404);
  EXPECT_NE(none_yet.body.find("has no trajectory"), std::string::npos);
  const auto no_job = bench.call("GET", "/v1/jobs/none/trajectory");
  EXPECT_EQ(no_job.status, 404);
  EXPECT_NE(no_job.body.find("there is no job"), std::string::npos);
}

TEST(GetParameters, IsASchemaWithUnits) {
  Bench bench;
  const auto response = bench.call("GET", "/v1/parameters");
  EXPECT_EQ(response.status, 200);
  const json schema = json::parse(response.body);
  EXPECT_EQ(schema.at("properties").at("clearance_mm").at("default"), 0.25);
  EXPECT_EQ(schema.at("properties").at("coupler").at("enum"), json::parse(R"(["rigid", "flexible"])"));
}

TEST(JobRoutes, AnswerUnknownIdsWith404) {
  Bench bench;
  EXPECT_EQ(bench.call("GET", "/v1/jobs/none").status, 404);
  EXPECT_EQ(bench.call("POST", "/v1/jobs/none/cancel").status, 404);
}

}  // namespace
