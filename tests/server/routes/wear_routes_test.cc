// SPDX-License-Identifier: Apache-2.0
// Wear studies over a service whose rings slide with 1 J in each millisecond, whatever the bore.

#include <algorithm>
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

const char* const kStudy =
    R"({"name": "worn", "parameters": {"duration_s": 1, "run_up_s": 0}, "worn_clearance_mm": 0.253})";

std::string submit_wear(Bench& bench) {
  const auto created = bench.call("POST", "/v1/wear-studies", kStudy);
  EXPECT_EQ(created.status, 201) << created.body;
  EXPECT_EQ(header(created, "Location"),
            "/v1/wear-studies/" + json::parse(created.body).at("id").get<std::string>());
  return header(created, "Location");
}

json wait_for_wear_end(Bench& bench, const std::string& path) {
  for (int tries = 0; tries < 4000; ++tries) {
    const json study = json::parse(bench.call("GET", path).body);
    if (study.at("state") != "running") return study;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  throw std::runtime_error("the study does not end");
}

TEST(WearStudies, WearTheBoreAndHandOutItsCyclesAsRows) {
  Bench bench;
  const std::string path = submit_wear(bench);
  const json study = wait_for_wear_end(bench, path);
  EXPECT_EQ(study.at("state"), "succeeded") << study;
  EXPECT_EQ(study.at("verdict"), "clearance_reached");
  const json rows = json::parse(bench.call("GET", path + "/results").body);
  ASSERT_EQ(rows.size(), study.at("cycles").size());
  ASSERT_GE(rows.size(), 4U);  // 3 um in steps of one
  EXPECT_NEAR(rows.back().at("clearance_mm").get<double>(), 0.253, 1e-9);
  EXPECT_EQ(rows.back().at("peak_slider_acceleration_m_s2"), 0.25)
      << "metric number 0 is the clearance of the round bore";
  const auto csv = bench.call("GET", path + "/results", "", {{"format", "csv"}});
  const std::string columns =
      "cycle,job_id,hours,step_hours,deepest_um,deepest_position_mm,deepest_angle_rad,clearance_mm,rate_um_h,"
      "rate_change,"
      "worn_volume_mm3,peak_slider_acceleration_m_s2,";
  EXPECT_EQ(csv.body.substr(0, columns.size()), columns);
  const json deep =
      json::parse(bench
                      .call("GET", path + "/results", "",
                            {{"fields", "cycle,deepest_um"}, {"deepest_um_ge", "2"}, {"order_by", "-cycle"}})
                      .body);
  ASSERT_EQ(deep.size(), rows.size() - 2);
  EXPECT_EQ(deep.at(0), (json{{"cycle", rows.size()}, {"deepest_um", rows.back().at("deepest_um")}}));
  EXPECT_FALSE(header(bench.call("GET", path), "ETag").empty());
  EXPECT_EQ(json::parse(bench.call("GET", "/v1/wear-studies").body).at("items").at(0).at("id"),
            study.at("id"));
  // Its jobs are those of a sweep, which shows each bore by its largest depth, and goes with the study.
  const std::string sweep = study.at("links").at("sweep");
  const json jobs = json::parse(bench.call("GET", sweep + "/results").body);
  EXPECT_EQ(jobs.at(0).at("wear_depth_um"), 0.0);
  EXPECT_EQ(jobs.back().at("wear_depth_um"), study.at("cycles").back().at("deepest_um"));
  const json job =
      json::parse(bench.call("GET", "/v1/jobs/" + jobs.back().at("job_id").get<std::string>()).body);
  EXPECT_EQ(job.at("parameters").at("wear_depth_um"), study.at("cycles").back().at("wear_depth_um"));
  EXPECT_EQ(bench.call("GET", job.at("links").at("self").get<std::string>() + "/wear").status, 200);
  EXPECT_EQ(bench.call("POST", path + "/cancel").status, 409);
  EXPECT_EQ(bench.call("DELETE", path).status, 204);
  EXPECT_EQ(bench.call("GET", sweep).status, 404);
}

TEST(WearStudies, AreCancelledAndRetried) {
  Bench bench(endless_run);
  const std::string path = submit_wear(bench);
  EXPECT_EQ(bench.call("DELETE", path).status, 409);
  EXPECT_EQ(json::parse(bench.call("POST", path + "/cancel").body).at("state"), "cancelled");
  EXPECT_EQ(json::parse(bench.call("POST", path + "/retry").body).at("state"), "running");
  EXPECT_EQ(bench.call("POST", path + "/cancel").status, 200);
}

TEST(WearStudies, RefuseWhatTheyDoNotKnow) {
  Bench bench;
  const auto refused = bench.call("POST", "/v1/wear-studies", R"({"sectors": 1, "hour": 2})");
  EXPECT_EQ(refused.status, 422);
  EXPECT_EQ(json::parse(refused.body).at("errors").size(), 3U) << refused.body;
  EXPECT_EQ(bench.call("POST", "/v1/wear-studies", "[").status, 400);
  for (const std::string action : {"", "/results"})
    EXPECT_EQ(bench.call("GET", "/v1/wear-studies/wst_none" + action).status, 404);
  for (const std::string action : {"/cancel", "/retry"})
    EXPECT_EQ(bench.call("POST", "/v1/wear-studies/wst_none" + action).status, 404);
  EXPECT_EQ(bench.call("DELETE", "/v1/wear-studies/wst_none").status, 404);
  EXPECT_EQ(bench.call("GET", "/v1/wear-studies", "", {{"state", "queued"}}).status, 422);
}

}  // namespace
