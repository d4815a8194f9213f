// SPDX-License-Identifier: Apache-2.0
// Searches over a service whose metric number 0 is the clearance in mm.

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

const char* const kSearch =
    R"({"name": "how far", "over": {"clearance_mm": {"from": 0.1, "to": 0.9, "tolerance": 0.02}},
  "metric": "peak_slider_acceleration_m_s2", "bound": 0.53, "sweep": {"coupler": ["rigid", "flexible"]},
       "replicates": {"count": 2}})";

std::string submit(Bench& bench) {
  const auto created = bench.call("POST", "/v1/searches", kSearch);
  EXPECT_EQ(created.status, 201) << created.body;
  EXPECT_EQ(header(created, "Location"),
            "/v1/searches/" + json::parse(created.body).at("id").get<std::string>());
  return header(created, "Location");
}

json wait_for_end(Bench& bench, const std::string& path) {
  for (int tries = 0; tries < 4000; ++tries) {
    const json search = json::parse(bench.call("GET", path).body);
    if (search.at("state") != "running") return search;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  throw std::runtime_error("the search does not end");
}

TEST(Searches, FindLimitsAndHandThemOutAsRows) {
  Bench bench;
  const std::string path = submit(bench);
  const json search = wait_for_end(bench, path);
  EXPECT_EQ(search.at("state"), "succeeded");
  ASSERT_EQ(search.at("limits").size(), 2U);
  EXPECT_NEAR(search.at("limits").at(0).at("limit").get<double>(), 0.53, 0.02);
  const json rows = json::parse(bench.call("GET", path + "/results").body);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows.at(1).at("coupler"), "flexible");
  EXPECT_EQ(rows.at(1).at("parameter"), "clearance_mm");
  EXPECT_EQ(rows.at(1).at("limit"), search.at("limits").at(1).at("limit"));
  const auto csv = bench.call("GET", path + "/results", "", {{"format", "csv"}});
  EXPECT_EQ(csv.body.substr(0, csv.body.find('\r')),
            "coupler,parameter,metric,bound,quantile,verdict,limit,limit_beyond,band_from,band_to,"
            "evaluations,monotonic,lost_reason");
  EXPECT_EQ(bench.call("GET", path + "/results", "", {{"format", "ndjson"}}).content_type,
            "application/x-ndjson");
  EXPECT_EQ(bench.call("GET", path + "/results", "", {{"format", "npz"}}).status, 422);
  const auto chosen = bench.call(
      "GET", path + "/results", "",
      {{"fields", "coupler,limit"}, {"order_by", "-coupler"}, {"verdict", "found"}, {"limit_gt", "0"}});
  const json expected = json::array({{{"coupler", "rigid"}, {"limit", rows.at(0).at("limit")}},
                                     {{"coupler", "flexible"}, {"limit", rows.at(1).at("limit")}}});
  EXPECT_EQ(json::parse(chosen.body), expected);
  EXPECT_EQ(json::parse(bench.call("GET", path + "/results", "", {{"monotonic", "false"}}).body),
            json::array());
  EXPECT_EQ(
      json::parse(bench.call("GET", path + "/results", "", {{"monotonic", "true"}, {"limit", "1"}}).body)
          .size(),
      1U);
  EXPECT_EQ(json::parse(bench.call("GET", path + "/results", "", {{"lost_reason", "no_value"}}).body),
            json::array());
  EXPECT_EQ(
      bench.call("GET", path + "/results", "", {{"limits", "1"}, {"fields", "state"}, {"monotonic_gt", "1"}})
          .status,
      422);
  EXPECT_FALSE(header(bench.call("GET", path), "ETag").empty());
  EXPECT_EQ(json::parse(bench.call("GET", "/v1/searches").body).at("items").at(0).at("id"), search.at("id"));
  // The evaluations are a sweep, which goes with the search.
  const std::string sweep = search.at("links").at("sweep");
  EXPECT_EQ(json::parse(bench.call("GET", sweep).body).at("counts"), search.at("counts"));
  EXPECT_EQ(bench.call("POST", path + "/cancel").status, 409);
  const auto refused = bench.call("DELETE", sweep);
  EXPECT_EQ(refused.status, 409);
  EXPECT_NE(refused.body.find(search.at("id").get<std::string>()), std::string::npos) << refused.body;
  EXPECT_EQ(json::parse(bench.call("GET", sweep).body).at("links").at("study"), path);
  EXPECT_EQ(bench.call("DELETE", path).status, 204);
  for (const std::string& gone : {path, path + "/results", sweep})
    EXPECT_EQ(bench.call("GET", gone).status, 404);
}

TEST(Searches, AreCancelledAndRetried) {
  Bench bench(endless_run);
  const std::string path = submit(bench);
  EXPECT_EQ(header(bench.call("GET", path), "ETag"), "");
  EXPECT_EQ(bench.call("DELETE", path).status, 409);
  EXPECT_EQ(json::parse(bench.call("POST", path + "/cancel").body).at("state"), "cancelled");
  EXPECT_EQ(json::parse(bench.call("POST", path + "/retry").body).at("state"), "running");
  EXPECT_EQ(json::parse(bench.call("POST", path + "/cancel").body).at("state"), "cancelled");
}

TEST(Searches, RefuseWhatTheyDoNotKnow) {
  Bench bench;
  const auto refused =
      bench.call("POST", "/v1/searches", R"({"over": {"coupler": {}}, "metric": 1, "bound": "low"})");
  EXPECT_EQ(refused.status, 422);
  EXPECT_EQ(json::parse(refused.body).at("errors").size(), 3U);
  EXPECT_EQ(bench.call("POST", "/v1/searches", "[").status, 400);
  for (const std::string action : {"", "/results"})
    EXPECT_EQ(bench.call("GET", "/v1/searches/sch_none" + action).status, 404);
  for (const std::string action : {"/cancel", "/retry"})
    EXPECT_EQ(bench.call("POST", "/v1/searches/sch_none" + action).status, 404);
  EXPECT_EQ(bench.call("DELETE", "/v1/searches/sch_none").status, 404);
  EXPECT_EQ(bench.call("GET", "/v1/searches", "", {{"state", "queued"}}).status, 422);
}

}  // namespace
