// SPDX-License-Identifier: Apache-2.0
// Reports of sweeps: metric i of the known run is 100 i + clearance in mm.
#include "server/report/report.h"

#include <cstddef>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/server/service_fixture.h"

namespace {

using nlohmann::json;
using server_tests::Bench;
using server_tests::header;

TEST(Report, StandsByItself) {
  Bench bench;
  const std::string id = bench.run(R"({"name": "it's <b>bold</b>",
    "sweep": {"restitution": [0.8], "clearance_mm": [0.1, 0.2], "coupler": ["rigid", "flexible"]},
                                      "replicates": {"count": 2}})");
  const auto response = bench.call("GET", "/v1/sweeps/" + id + "/report");
  ASSERT_EQ(response.status, 200) << response.body;
  EXPECT_EQ(response.content_type, "text/html; charset=utf-8");
  const std::string& page = response.body;
  for (const char* const forbidden : {"<script", "style=", "<b>", "src=", "href=\"http", "url("})
    EXPECT_EQ(page.find(forbidden), std::string::npos) << forbidden;
  for (const char* const wanted : {"<svg", "Effect of flexibility", "Provenance", "it's &lt;b&gt;bold"})
    EXPECT_NE(page.find(wanted), std::string::npos) << wanted;
  // The policy names the style by its hash, which stands in the page, too, for when it has been saved.
  const std::string policy = header(response, "Content-Security-Policy");
  const std::string hash = policy.substr(policy.find("'sha256-"), 8 + 44 + 1);
  EXPECT_NE(page.find(hash), std::string::npos);
}

TEST(Report, ShowsTheMetricsOfADescribedLinkage) {
  Bench bench;
  const std::string id = bench.run(
      R"({"parameters": {"linkage": {"bodies": {"bob": {"mass_kg": 1, "centre_of_mass_m": [0.5, 0, 0]}},
    "joints": {"pivot": {"kind": "revolute", "axis": "y", "from": "ground", "to": "bob",
         "damping_n_m_s_rad": 0.1}}}, "duration_s": 0.1},
    "sweep": {"linkage.joints.pivot.damping_n_m_s_rad": [0.1, 0.2]}})");
  const auto response = bench.call("GET", "/v1/sweeps/" + id + "/report");
  ASSERT_EQ(response.status, 200) << response.body;
  EXPECT_NE(response.body.find("Peak pivot acceleration [rad/s²]"), std::string::npos) << response.body;
  EXPECT_EQ(response.body.find("slider"), std::string::npos);
}

/// The part of a page before a heading.
std::string before(const std::string& page, const std::string& heading) {
  return page.substr(0, page.find("<h2>" + heading));
}

// 25 velocities, 12 clearances, 2 couplers: the metric grows with the clearance, so the last one is largest.
TEST(Report, BeginsWithTheLargestOfManyCombinations) {
  Bench bench;
  const std::string id = bench.run(R"({"name": "grid", "sweep": {
      "crank_velocity_rad_s": {"from": 5, "to": 15, "count": 25},
      "clearance_mm": {"from": 0.05, "to": 0.6, "count": 12}, "coupler": ["rigid", "flexible"]}})");
  const auto response = bench.call("GET", "/v1/sweeps/" + id + "/report");
  ASSERT_EQ(response.status, 200) << response.body;
  const std::string& page = response.body;
  EXPECT_LT(page.size(), 1'000'000U);
  const std::string first = before(page, "Figures");
  EXPECT_NE(first.find("Largest peak slider acceleration: <strong>"), std::string::npos) << first;
  EXPECT_NE(first.find("clearance 0.6 mm"), std::string::npos) << first;
  EXPECT_NE(first.find("One run each"), std::string::npos) << first;
  EXPECT_NE(first.find("<a href=\"../../../#/jobs/job_"), std::string::npos) << first;
  // Two heat maps of 25 times 12 cells; charts with twelve lines at most, that of the largest among them.
  std::size_t cells = 0;
  for (std::size_t at = page.find("height=\"20.0\""); at != std::string::npos;
       at = page.find("height=\"20.0\"", at + 1))
    ++cells;
  EXPECT_EQ(cells, 600U);
  for (const char* const line : {">0.05 mm, rigid<", ">0.6 mm, rigid<", ">0.05 mm, flexible<"})
    EXPECT_NE(page.find(line), std::string::npos) << line;
  EXPECT_NE(page.find("12 of 24 combinations are drawn"), std::string::npos);
  for (const char* const wanted : {"<main>", "0.05 to 0.6 mm, 12 values", "rigid, flexible",
                                   "whether the flexible link helps is not known"})
    EXPECT_NE(page.find(wanted), std::string::npos) << wanted;
  EXPECT_EQ(page.find("Appendix"), std::string::npos);
}

TEST(Report, ShowsTheChosenMetricAndAxisAndAllRows) {
  Bench bench;
  const std::string path =
      "/v1/sweeps/" +
      bench.run(R"({"sweep": {"clearance_mm": [0.1, 0.2], "crank_velocity_rad_s": [5, 6, 7]}})") + "/report";
  const auto shown = bench.call(
      "GET", path, "", {{"metric", "impact_count"}, {"x", "crank_velocity_rad_s"}, {"rows", "true"}});
  ASSERT_EQ(shown.status, 200) << shown.body;
  EXPECT_NE(shown.body.find("Largest impact count"), std::string::npos);
  EXPECT_NE(shown.body.find("Means over crank velocity"), std::string::npos);
  EXPECT_NE(shown.body.find("Appendix: all jobs"), std::string::npos);
  for (const auto& [key, value] : {std::pair{"metric", "beauty"}, {"x", "coupler"}, {"rows", "1"}})
    EXPECT_EQ(bench.call("GET", path, "", {{key, value}}).status, 422) << key;
}

TEST(Report, TellsTheTimeOfEachPeak) {
  Bench bench;
  const std::string path =
      "/v1/sweeps/" + bench.run(R"({"sweep": {"clearance_mm": [0.1, 0.2]}})") + "/report";
  const auto table = engine::metric_table();
  for (std::size_t i = 0; i + 1 < table.size(); ++i) {
    const std::string& peak = table[i].key;
    if (!table[i + 1].key.ends_with("_time_s")) continue;
    const std::string page = bench.call("GET", path, "", {{"metric", peak}}).body;
    const std::string time = std::to_string(100 * (i + 1)) + ".2";
    EXPECT_NE(page.find(" at " + time + " s of the run"), std::string::npos) << peak;
    EXPECT_NE(page.find("Time [s]"), std::string::npos) << peak;
  }
}

TEST(Report, CountsFailuresByTheirReasons) {
  Bench bench([](const jobs::JobSpec& spec, const engine::StopQuery& stop) {
    engine::RunResult result = server_tests::known_run(spec, stop);
    if (spec.parameters.c_r > 0.00025) result.status = engine::RunStatus::kLockUp;
    return result;
  });
  const std::string id = bench.run(R"({"sweep": {"clearance_mm": [0.1, 0.2, 0.3, 0.4]}})");
  const std::string page = bench.call("GET", "/v1/sweeps/" + id + "/report").body;
  EXPECT_NE(page.find("<strong>2</strong> of 4 jobs failed: 2 by lock_up."), std::string::npos) << page;
}

TEST(Report, KeepsTheOrderOfAxesAndQuotesForTheShell) {
  const json sweep = json::parse(R"({"axes": ["restitution", "clearance_mm"],
    "request": {"name": "it's", "sweep": {"clearance_mm": [1], "restitution": [2]}}})");
  EXPECT_EQ(
      server::report::make_command(server::report::request_in_order(sweep)),
      R"(curl -s -d '{"name":"it'\''s","sweep":{"restitution":[2],"clearance_mm":[1]}}' "${RPSUP_URL:-http://127.0.0.1:8080}/v1/sweeps")");
}

}  // namespace
