// SPDX-License-Identifier: Apache-2.0
// Measurements over HTTP: forms of bodies, resource, samples, refusals.

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/server/service_fixture.h"

namespace {

using nlohmann::json;
using server_tests::Bench;
using server_tests::header;
using QueryPairs = std::vector<std::pair<std::string, std::string>>;

const char* const kCsvOfLab = "time_s,acc,force_n\n0,1.5,-2\n0.001,-1.5,0.5\n0.0025,0,4\n";
const char* const kJsonOfLab = R"({"name": "lab", "channels": [{"name": "force_n", "sign": -1}], "runs": [
  {"parameters": {"clearance_mm": 0.25}, "time_s": [0, 1], "values": {"force_n": [3, 4]}},
  {"time_s": [0, 1, 2], "values": {"force_n": [5, 6, 7]}}]})";

server::Response post_measured(Bench& bench, const std::string& body, const std::string& content_type,
                               QueryPairs query = {}, const std::string& key = "") {
  server::Request request{.method = "POST",
                          .path = "/v1/measurements",
                          .query = std::move(query),
                          .accept = {},
                          .body = body,
                          .id = "test-1"};
  request.content_type = content_type;
  if (!key.empty()) request.idempotency_key = key;
  return bench.call(request);
}

std::string measured_path(Bench& bench, const server::Response& created) {
  EXPECT_EQ(created.status, 201) << created.body;
  const std::string path = header(created, "Location");
  EXPECT_EQ(path, "/v1/measurements/" + json::parse(created.body).at("id").get<std::string>());
  EXPECT_EQ(json::parse(bench.call("GET", path).body), json::parse(created.body));
  return path;
}

TEST(MeasurementRoutes, TakeCsvAndGiveItBack) {
  Bench bench;
  const auto created =
      post_measured(bench, kCsvOfLab, "text/csv; charset=utf-8",
                    {{"name", "bench 1"}, {"channels", "acc:slider_acceleration_m_s2,force_n"}});
  const std::string path = measured_path(bench, created);
  const json resource = json::parse(created.body);
  EXPECT_EQ(resource.at("name"), "bench 1");
  EXPECT_EQ(resource.at("samples"), 3);
  EXPECT_EQ(resource.at("channels").at(0).at("name"), "slider_acceleration_m_s2");
  EXPECT_EQ(resource.at("channels").at(0).at("unit"), "m/s²");
  EXPECT_EQ(resource.at("channels").at(0).at("column"), "acc");
  EXPECT_EQ(resource.at("links").at("data"), path + "/data");
  const auto csv = bench.call("GET", path + "/data", "", {{"format", "csv"}});
  EXPECT_EQ(csv.body, "t_s,slider_acceleration_m_s2,force_n\r\n0,1.5,-2\r\n0.001,-1.5,0.5\r\n0.0025,0,4\r\n");
  EXPECT_NE(header(csv, "Content-Disposition").find("measurement-mea_"), std::string::npos);
  // An answer can be sent again, as CSV and as NPZ.
  const auto again = post_measured(bench, csv.body, "text/csv");
  const auto npz = bench.call("GET", path + "/data", "", {{"format", "npz"}});
  const auto from_npz = post_measured(bench, npz.body, "application/x-npz");
  for (const auto* copy : {&again, &from_npz}) {
    const std::string other = measured_path(bench, *copy);
    EXPECT_EQ(bench.call("GET", other + "/data").body, bench.call("GET", path + "/data").body);
  }
}

TEST(MeasurementRoutes, TakeWhatIsKnownOfSensorsAndRunBesideCsv) {
  Bench bench;
  const std::string sensors = R"({"force_n": {"sign": -1, "delay_s": 0.002}})";
  const auto created = post_measured(bench, kCsvOfLab, "text/csv",
                                     {{"channels", "force_n"},
                                      {"sensors", sensors},
                                      {"parameters", R"({"crank_velocity_rad_s": 10})"}});
  const json resource = json::parse(bench.call("GET", measured_path(bench, created)).body);
  EXPECT_EQ(resource.at("channels").at(0).at("sign"), -1);
  EXPECT_EQ(resource.at("channels").at(0).at("delay_s"), 0.002);
  EXPECT_EQ(resource.at("runs").at(0).at("parameters"), (json{{"crank_velocity_rad_s", 10}}));
  const auto refusals = [&](const QueryPairs& query, const char* type, const char* body) {
    const auto refused = post_measured(bench, body, type, query);
    EXPECT_EQ(refused.status, 422) << refused.body;
    return json::parse(refused.body).at("errors").at(0).at("pointer").get<std::string>();
  };
  for (const char* const bad : {"", "x", "[1]", "{\"a\": 1, \"a\": 2}"})
    for (const char* const key : {"sensors", "parameters"})
      EXPECT_EQ(refusals({{"channels", "force_n"}, {key, bad}}, "text/csv", kCsvOfLab), std::string("/") + key);
  EXPECT_EQ(refusals({{"sensors", sensors}}, "application/json", kJsonOfLab), "/sensors");
}

TEST(MeasurementRoutes, TakeJsonOfSeveralRuns) {
  Bench bench;
  const std::string path = measured_path(bench, post_measured(bench, kJsonOfLab, ""));
  const json resource = json::parse(bench.call("GET", path).body);
  EXPECT_EQ(resource.at("runs").at(0).at("parameters"), (json{{"clearance_mm", 0.25}}));
  EXPECT_EQ(resource.at("channels").at(0).at("sign"), -1);
  const auto run = bench.call("GET", path + "/data", "", {{"run", "1"}, {"from", "1"}});
  EXPECT_EQ(json::parse(run.body).at("columns"), (json{{"t_s", {1, 2}}, {"force_n", {6, 7}}}));
  const auto unclear = bench.call("GET", path + "/data");
  EXPECT_EQ(unclear.status, 422);
  EXPECT_EQ(json::parse(unclear.body).at("errors").at(0).at("pointer"), "/run");
  EXPECT_EQ(bench.call("GET", path + "/data", "", {{"run", "2"}}).status, 422);
}

TEST(MeasurementRoutes, HaveAnETagAndAListing) {
  Bench bench;
  const std::string first = measured_path(bench, post_measured(bench, kJsonOfLab, "application/json"));
  const std::string second = measured_path(bench, post_measured(bench, kJsonOfLab, "application/json"));
  for (const std::string& path : {first, first + "/data"}) {
    server::Request request{.method = "GET", .path = path, .query = {}, .accept = {}, .body = {}, .id = "t"};
    if (path != first) request.query = {{"run", "0"}};
    const std::string etag = header(bench.call(request), "ETag");
    EXPECT_FALSE(etag.empty()) << path;
    request.if_none_match = etag;
    EXPECT_EQ(bench.call(request).status, 304) << path;
  }
  const json page = json::parse(bench.call("GET", "/v1/measurements", "", {{"limit", "1"}}).body);
  EXPECT_EQ(page.at("items").at(0).at("links").at("self"), second);
  const json next =
      json::parse(bench
                      .call("GET", "/v1/measurements", "",
                            {{"cursor", page.at("next_cursor").get<std::string>()}, {"fields", "id,name"}})
                      .body);
  EXPECT_EQ(next.at("items").size(), 1U);
  EXPECT_EQ(next.at("items").at(0).size(), 2U);
  EXPECT_EQ(bench.call("GET", "/v1/measurements", "", {{"state", "queued"}}).status, 422);
  EXPECT_EQ(bench.call("DELETE", first).status, 204);
  EXPECT_EQ(bench.call("DELETE", first).status, 404);
  EXPECT_EQ(bench.call("GET", first).status, 404);
  EXPECT_EQ(bench.call("GET", first + "/data").status, 404);
}

TEST(MeasurementRoutes, AnswerAKeyTwiceWithOneMeasurement) {
  Bench bench;
  const auto first = post_measured(bench, kJsonOfLab, "", {}, "key-1");
  EXPECT_EQ(json::parse(post_measured(bench, kJsonOfLab, "", {}, "key-1").body), json::parse(first.body));
  EXPECT_EQ(post_measured(bench, "time_s,force_n\n0,1\n1,2\n", "text/csv", {}, "key-1").status, 422);
  EXPECT_EQ(json::parse(bench.call("GET", "/v1/measurements").body).at("items").size(), 1U);
}

TEST(MeasurementRoutes, RefuseWithThePlaceOfTheFault) {
  Bench bench;
  const auto csv =
      post_measured(bench, "time_s,acc\n0,1\n1,\"1,5\"\n", "text/csv", {{"channels", "acc:force_n"}});
  EXPECT_EQ(csv.status, 422);
  EXPECT_EQ(json::parse(csv.body).at("errors").at(0).at("detail"),
            "line 3, column 2 (acc): \"1,5\" is no number; write a decimal point");
  const auto wrong = post_measured(
      bench, R"({"channels": [{"name": "force_n"}], "runs": [{"parameters": {"clearance_mm": -1},
      "time_s": [0, 1], "values": {"force_n": [1, NaN]}}]})",
      "application/json");
  EXPECT_EQ(wrong.status, 422);
  const json errors = json::parse(wrong.body).at("errors");
  EXPECT_EQ(errors.at(0).at("pointer"), "/runs/0/parameters/clearance_mm");
  EXPECT_EQ(errors.at(1).at("pointer"), "/runs/0/values/force_n/1");
  EXPECT_EQ(post_measured(bench, "PK", "application/octet-stream").status, 422);
  EXPECT_EQ(post_measured(bench, "[", "application/json").status, 400);
  EXPECT_EQ(post_measured(bench, kCsvOfLab, "text/plain").status, 415);
  EXPECT_EQ(post_measured(bench, kJsonOfLab, "", {{"name", "x"}}).status, 422);
  EXPECT_EQ(post_measured(bench, kCsvOfLab, "text/csv", {{"columns", "x"}}).status, 422);
}

}  // namespace
