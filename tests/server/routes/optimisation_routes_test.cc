// SPDX-License-Identifier: Apache-2.0
// Routes of optimisations, on a service whose metric number 0 is the clearance.

#include <chrono>
#include <stdexcept>
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

const char* const kOptimisation = R"({"name": "tight", "parameters": {"duration_s": 1, "run_up_s": 0},
  "over": {"clearance_mm": {"from": 0.1, "to": 0.4}},
  "objectives": [{"metric": "peak_slider_acceleration_m_s2"}], "budget": 24, "starts": 2, "population": 6})";

json wait_for_optimum(Bench& bench, const std::string& path) {
  for (int tries = 0; tries < 4000; ++tries) {
    const json study = json::parse(bench.call("GET", path).body);
    if (study.at("state") != "running") return study;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  throw std::runtime_error("the optimisation does not end");
}

TEST(Optimisations, HandOutTheirCandidatesAsRows) {
  Bench bench;
  const auto created = bench.call("POST", "/v1/optimisations", kOptimisation);
  ASSERT_EQ(created.status, 201) << created.body;
  const std::string path = header(created, "Location");
  EXPECT_EQ(path, "/v1/optimisations/" + json::parse(created.body).at("id").get<std::string>());
  const json study = wait_for_optimum(bench, path);
  EXPECT_EQ(study.at("state"), "succeeded") << study;
  const json rows = json::parse(bench.call("GET", path + "/results").body);
  EXPECT_GE(rows.size(), 12U);
  EXPECT_LE(rows.size(), 24U);
  EXPECT_EQ(rows.at(0).at("clearance_mm"), rows.at(0).at("peak_slider_acceleration_m_s2"));
  const auto least = bench.call("GET", path + "/results", "",
                                {{"order_by", "peak_slider_acceleration_m_s2"}, {"limit", "1"}});
  const json best = json::parse(least.body);
  EXPECT_EQ(best.at(0).at("clearance_mm"), study.at("best").at("values").at("clearance_mm"));
  EXPECT_EQ(best.at(0).at("on_front"), true);
  const auto csv = bench.call("GET", path + "/results", "", {{"format", "csv"}});
  const std::string columns =
      "candidate,start,state,lost_reason,on_front,job_id,clearance_mm,peak_slider_acceleration_m_s2";
  EXPECT_EQ(csv.body.substr(0, columns.size()), columns);
  EXPECT_FALSE(header(bench.call("GET", path), "ETag").empty());
  EXPECT_EQ(json::parse(bench.call("GET", "/v1/optimisations").body).at("items").at(0).at("id"),
            study.at("id"));
  const std::string sweep = study.at("links").at("sweep");
  EXPECT_EQ(json::parse(bench.call("GET", sweep).body).at("links").at("study"), path);
  const auto refused = bench.call("DELETE", sweep);
  EXPECT_EQ(refused.status, 409);
  EXPECT_NE(refused.body.find(study.at("id").get<std::string>()), std::string::npos);
  EXPECT_EQ(bench.call("DELETE", path).status, 204);
  EXPECT_EQ(bench.call("GET", path).status, 404);
  EXPECT_EQ(bench.call("GET", sweep).status, 404);
}

TEST(Optimisations, AreCancelledAndRetried) {
  Bench bench(endless_run);
  const std::string path = header(bench.call("POST", "/v1/optimisations", kOptimisation), "Location");
  EXPECT_EQ(bench.call("GET", path + "/events").status, 200);
  EXPECT_EQ(bench.call("DELETE", path).status, 409);
  EXPECT_EQ(json::parse(bench.call("POST", path + "/cancel").body).at("state"), "cancelled");
  EXPECT_EQ(json::parse(bench.call("POST", path + "/retry").body).at("state"), "running");
  EXPECT_EQ(bench.call("POST", path + "/cancel").status, 200);
}

TEST(Optimisations, RefuseWhatIsNotUnderstood) {
  Bench bench;
  const auto refused = bench.call("POST", "/v1/optimisations", R"({"over": {}, "objectve": 2})");
  EXPECT_EQ(refused.status, 422);
  EXPECT_EQ(json::parse(refused.body).at("errors").size(), 3U) << refused.body;
  EXPECT_EQ(bench.call("POST", "/v1/optimisations", "[").status, 400);
  for (const std::string action : {"", "/results", "/events"})
    EXPECT_EQ(bench.call("GET", "/v1/optimisations/opt_none" + action).status, 404);
  for (const std::string action : {"/cancel", "/retry"})
    EXPECT_EQ(bench.call("POST", "/v1/optimisations/opt_none" + action).status, 404);
}

}  // namespace
