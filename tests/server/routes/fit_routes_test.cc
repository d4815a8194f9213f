// SPDX-License-Identifier: Apache-2.0
// Routes of fits, on a service whose slider is at clearance times cos 4 t, both in mm.

#include <chrono>
#include <cmath>
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

engine::RunResult run_cosine(const jobs::JobSpec& spec, const engine::StopQuery& /*stop_requested*/) {
  engine::RunResult result;
  result.trajectory.channels = {{.key = "t_s", .help = "Time"},
                                {.key = "slider_position_m", .help = "Position"}};
  result.trajectory.columns.resize(2);
  for (int k = 0; k <= 200; ++k) {
    const double t = k / 100.0;
    result.trajectory.columns[0].push_back(t);
    result.trajectory.columns[1].push_back(1e3 * spec.parameters.c_r * std::cos(4.0 * t));
  }
  result.metrics.assign(engine::metric_table().size(), 1.0);
  return result;
}

/// Stores a measurement of a clearance of 0.3 mm and makes the request of a fit to it.
std::string make_fit_request(Bench& bench) {
  json time = json::array();
  json values = json::array();
  for (int k = 0; k < 150; ++k) {
    time.push_back(k / 100.0);
    values.push_back(0.3 * std::cos(0.04 * k) + (k % 2 == 0 ? 1e-3 : -1e-3));
  }
  const json measurement{{"channels", {{{"name", "slider_position_m"}}}},
                         {"runs", {{{"time_s", time}, {"values", {{"slider_position_m", values}}}}}}};
  const auto stored = bench.call("POST", "/v1/measurements", measurement.dump());
  EXPECT_EQ(stored.status, 201) << stored.body;
  return json{{"over", {{"clearance_mm", {{"from", 0.1}, {"to", 0.5}}}}},
              {"budget", 250},
              {"parameters", {{"run_up_s", 0.1}}},
              {"measurements", {{{"id", json::parse(stored.body).at("id")}, {"held_back", {{1.2, 1.5}}}}}}}
      .dump();
}

json wait_for_fit(Bench& bench, const std::string& path) {
  for (int tries = 0; tries < 4000; ++tries) {
    const json study = json::parse(bench.call("GET", path).body);
    if (study.at("state") != "running") return study;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  throw std::runtime_error("the fit does not end");
}

TEST(Fits, HandOutTheirValuesPointsAndSignals) {
  Bench bench(run_cosine);
  const auto created = bench.call("POST", "/v1/fits", make_fit_request(bench));
  ASSERT_EQ(created.status, 201) << created.body;
  const std::string path = header(created, "Location");
  EXPECT_EQ(path, "/v1/fits/" + json::parse(created.body).at("id").get<std::string>());
  const json fit = wait_for_fit(bench, path);
  ASSERT_EQ(fit.at("state"), "succeeded") << fit;
  EXPECT_NEAR(fit.at("parameters")[0].at("value").get<double>(), 0.3, 1e-3);
  const json rows = json::parse(bench.call("GET", path + "/results").body);
  EXPECT_EQ(rows.size(), fit.at("points").at("succeeded").get<std::size_t>());
  const auto csv = bench.call("GET", path + "/results", "", {{"format", "csv"}});
  const std::string columns = "point,stage,state,lost_reason,sum_of_squares,job_id,clearance_mm";
  EXPECT_EQ(csv.body.substr(0, columns.size()), columns);
  const std::string signals = fit.at("links").at("signals");
  EXPECT_EQ(json::parse(bench.call("GET", signals).body).size(), 150U);
  const json held_back =
      json::parse(bench.call("GET", signals, "", {{"use", "held_back"}, {"fields", "t_s,residual"}}).body);
  EXPECT_EQ(held_back.size(), 30U);
  EXPECT_NEAR(held_back.at(0).at("residual").get<double>(), 0.0, 3e-3);
  EXPECT_FALSE(header(bench.call("GET", path), "ETag").empty());
  EXPECT_EQ(json::parse(bench.call("GET", "/v1/fits").body).at("items").at(0).at("id"), fit.at("id"));
  const std::string sweep = fit.at("links").at("sweep");
  EXPECT_EQ(json::parse(bench.call("GET", sweep).body).at("links").at("study"), path);
  const auto refused = bench.call("DELETE", sweep);
  EXPECT_EQ(refused.status, 409);
  EXPECT_NE(refused.body.find(fit.at("id").get<std::string>()), std::string::npos);
  const std::string measurement = "/v1/measurements/" + fit.at("measurement_ids")[0].get<std::string>();
  EXPECT_EQ(bench.call("DELETE", measurement).status, 409);
  EXPECT_EQ(bench.call("DELETE", path).status, 204);
  EXPECT_EQ(bench.call("GET", path).status, 404);
  EXPECT_EQ(bench.call("DELETE", measurement).status, 204);
}

TEST(Fits, AreCancelledAndRetried) {
  Bench bench(endless_run);
  const std::string path = header(bench.call("POST", "/v1/fits", make_fit_request(bench)), "Location");
  EXPECT_EQ(bench.call("GET", path + "/events").status, 200);
  EXPECT_EQ(bench.call("DELETE", path).status, 409);
  EXPECT_EQ(json::parse(bench.call("POST", path + "/cancel").body).at("state"), "cancelled");
  EXPECT_EQ(json::parse(bench.call("GET", path + "/signals").body), json::array());
  EXPECT_EQ(json::parse(bench.call("POST", path + "/retry").body).at("state"), "running");
  EXPECT_EQ(bench.call("POST", path + "/cancel").status, 200);
}

TEST(Fits, RefuseWhatIsNotUnderstood) {
  Bench bench;
  const auto refused = bench.call("POST", "/v1/fits", R"({"over": {}, "measurments": 2})");
  EXPECT_EQ(refused.status, 422);
  EXPECT_EQ(json::parse(refused.body).at("errors").size(), 2U) << refused.body;
  EXPECT_EQ(bench.call("POST", "/v1/fits", "[").status, 400);
  for (const std::string action : {"", "/results", "/signals", "/events"})
    EXPECT_EQ(bench.call("GET", "/v1/fits/fit_none" + action).status, 404);
  for (const std::string action : {"/cancel", "/retry"})
    EXPECT_EQ(bench.call("POST", "/v1/fits/fit_none" + action).status, 404);
}

}  // namespace
