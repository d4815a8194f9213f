// SPDX-License-Identifier: Apache-2.0
#include "server/routes/job_routes.h"

#include <chrono>
#include <cmath>
#include <cstddef>
#include <string>
#include <thread>
#include <vector>

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

TEST(Assembly, GivesTheFirstPoseOfEveryLink) {
  Bench bench(jobs::engine_runner());
  const char* const pendulum = R"({"parameters": {"linkage": {
    "bodies": {"arm": {"mass_kg": 1, "centre_of_mass_m": [0.5, 0, 0]}},
    "joints": {"pivot": {"kind": "revolute", "axis": "z", "from": "ground", "to": "arm", "at_m": [1, 2, 3],
                         "start_rad": 1.5707963267948966}}}}})";
  const auto answer = bench.call("POST", "/v1/linkages/assembly", pendulum);
  ASSERT_EQ(answer.status, 200) << answer.body;
  const json assembly = json::parse(answer.body);
  EXPECT_EQ(assembly.at("undriven_freedoms"), 1);
  const auto pose = assembly.at("poses").at("arm").get<std::vector<double>>();
  const std::vector<double> expected{1, 2, 3, 0, 0, std::sqrt(0.5), std::sqrt(0.5)};
  ASSERT_EQ(pose.size(), expected.size());
  for (std::size_t i = 0; i < pose.size(); ++i) EXPECT_NEAR(pose[i], expected[i], 1e-6) << i;
  EXPECT_TRUE(json::parse(bench.call("GET", "/v1/jobs").body).at("items").empty());
}

// A four-bar linkage: three freedoms of joints that carry bodies, less two of a planar loop.
json four_bar(const json& first_joint) {
  json linkage = json::parse(R"({
    "bodies": {"crank": {"mass_kg": 1, "centre_of_mass_m": [0.1, 0, 0]},
               "coupler": {"mass_kg": 1, "centre_of_mass_m": [0.2, 0, 0]},
               "rocker": {"mass_kg": 1, "centre_of_mass_m": [0.15, 0, 0]}},
    "joints": {"a": {"kind": "revolute", "from": "ground", "to": "crank"},
               "b": {"kind": "revolute", "from": "crank", "to": "coupler", "at_m": [0.2, 0, 0], "guess_rad": 0.9},
               "c": {"kind": "revolute", "from": "coupler", "to": "rocker", "at_m": [0.5, 0, 0], "guess_rad": 1.6},
               "d": {"kind": "revolute", "from": "ground", "to": "rocker", "at_m": [0.5, 0, 0],
                     "to_at_m": [0.4, 0, 0], "closes_loop": true}}})");
  linkage.at("joints").at("a").update(first_joint);
  return {{"parameters", {{"linkage", linkage}}}};
}

TEST(Assembly, CountsTheFreedomsThatNoDriveMoves) {
  Bench bench(jobs::engine_runner());
  const auto count = [&](const json& first_joint) {
    const auto answer = bench.call("POST", "/v1/linkages/assembly", four_bar(first_joint).dump());
    EXPECT_EQ(answer.status, 200) << answer.body;
    return answer.status == 200 ? json::parse(answer.body).at("undriven_freedoms") : json();
  };
  EXPECT_EQ(count({{"guess_rad", 0.0}}), 1);
  EXPECT_EQ(count({{"drive", {{"law", "run_up"}, {"velocity_rad_s", 1}}}}), 0);
}

TEST(Assembly, CountsNoBendingAsAFreedom) {
  Bench bench(jobs::engine_runner());
  json request = four_bar({{"guess_rad", 0.0}});
  request["parameters"]["linkage"]["bodies"]["coupler"] = {
      {"mass_kg", 1}, {"beam", {{"length_m", 0.5}, {"diameter_mm", 10}, {"elements", 4}}}};
  const auto answer = bench.call("POST", "/v1/linkages/assembly", request.dump());
  ASSERT_EQ(answer.status, 200) << answer.body;
  EXPECT_EQ(json::parse(answer.body).at("undriven_freedoms"), 1);
}

// The poses are those with which a run begins.
TEST(Assembly, IsTheFirstSampleOfAJob) {
  Bench bench(jobs::engine_runner());
  const std::string parameters = R"({"clearance_mm": 0.25, "duration_s": 0.01, "run_up_s": 0.005})";
  const auto answer = bench.call("POST", "/v1/linkages/assembly", R"({"parameters": )" + parameters + "}");
  ASSERT_EQ(answer.status, 200) << answer.body;
  const json assembly = json::parse(answer.body);
  EXPECT_TRUE(assembly.at("undriven_freedoms").is_null());
  const std::string id = run_job(bench, parameters);
  const json columns = json::parse(bench.call("GET", "/v1/jobs/" + id + "/trajectory").body).at("columns");
  std::size_t compared = 0;
  for (const auto& [link, pose] : assembly.at("poses").items()) {
    EXPECT_NEAR(pose.at(0).get<double>(), columns.at("pose_" + link + "_x_m").at(0).get<double>(), 1e-7)
        << link;
    EXPECT_NEAR(pose.at(6).get<double>(), columns.at("pose_" + link + "_qw").at(0).get<double>(), 1e-7)
        << link;
    ++compared;
  }
  EXPECT_GE(compared, 5U);
}

TEST(Assembly, NamesTheFaultsOfADescription) {
  Bench bench(jobs::engine_runner());
  const auto pointer_of = [&](const std::string& body) {
    const auto refused = bench.call("POST", "/v1/linkages/assembly", body);
    EXPECT_EQ(refused.status, 422) << refused.body;
    return json::parse(refused.body).at("errors").at(0).at("pointer").get<std::string>();
  };
  EXPECT_EQ(pointer_of("{}"), "");
  EXPECT_EQ(pointer_of(R"({"parameters": {"clearance_mm": -1}})"), "/parameters/clearance_mm");
  EXPECT_EQ(pointer_of(R"({"parameters": {"linkage": {"bodies": {"arm": {"mass_kg": 1}},
              "joints": {"pivot": {"kind": "hinge", "from": "ground", "to": "arm"}}}}})"),
            "/parameters/linkage/joints/pivot/kind");
  // Two links of 1 m do not reach over 3 m.
  EXPECT_EQ(pointer_of(R"({"parameters": {"linkage": {"bodies": {"a": {"mass_kg": 1}, "b": {"mass_kg": 1}},
              "joints": {"one": {"kind": "revolute", "from": "ground", "to": "a"},
                         "two": {"kind": "revolute", "from": "a", "to": "b", "at_m": [1, 0, 0]},
                         "three": {"kind": "revolute", "from": "ground", "to": "b", "at_m": [3, 0, 0],
                                   "to_at_m": [1, 0, 0], "closes_loop": true}}}}})"),
            "/parameters/linkage/joints/three");
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
  const json sweep =
      json::parse(bench.call("POST", "/v1/sweeps", R"({"sweep": {"clearance_mm": [0.1]}})").body);
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
