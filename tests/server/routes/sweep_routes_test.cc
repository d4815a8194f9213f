// SPDX-License-Identifier: Apache-2.0
#include "server/routes/sweep_routes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/server/service_fixture.h"

namespace {

using nlohmann::json;
using server_tests::Bench;
using server_tests::endless_run;
using server_tests::header;

const char* const kSmallSweep =
    R"({"name": "small", "sweep": {"clearance_mm": [0.1, 0.25], "coupler": ["rigid", "flexible"]}})";

TEST(PostSweep, AnswersWithTheResourceAndItsPlace) {
  Bench bench;
  const auto created = bench.call("POST", "/v1/sweeps", kSmallSweep);
  ASSERT_EQ(created.status, 201) << created.body;
  const json sweep = json::parse(created.body);
  EXPECT_EQ(sweep.at("name"), "small");
  EXPECT_EQ(header(created, "Location"), "/v1/sweeps/" + sweep.at("id").get<std::string>());
  const auto found = bench.call("GET", header(created, "Location"));
  EXPECT_EQ(found.status, 200);
  EXPECT_EQ(json::parse(found.body).at("id"), sweep.at("id"));
}

TEST(PostSweep, NamesEveryFault) {
  Bench bench;
  const auto response = bench.call(
      "POST", "/v1/sweeps", R"({"parameters": {"nonsense": 1}, "sweep": {"clearance_mm": [0.1, -1, "a"]}})");
  ASSERT_EQ(response.status, 422);
  std::set<std::string> pointers;
  const json problem = json::parse(response.body);
  for (const auto& error : problem.at("errors")) pointers.insert(error.at("pointer").get<std::string>());
  EXPECT_EQ(pointers, (std::set<std::string>{"/parameters/nonsense", "/sweep/clearance_mm/1",
                                             "/sweep/clearance_mm/2"}));
  EXPECT_TRUE(json::parse(bench.call("GET", "/v1/sweeps").body).at("items").empty());
}

TEST(PostSweep, SweepsTheLinksThatBend) {
  Bench bench;
  const char* const request =
      R"({"parameters": {"cross_length_mm": 50}, "sweep": {"crank": ["rigid", "flexible"], "cross": ["rigid",
         "flexible"]}})";
  const std::string path = "/v1/sweeps/" + bench.run(request);
  const json rows = json::parse(bench.call("GET", path + "/results").body);
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[2].at("crank"), "flexible");
  EXPECT_EQ(rows[2].at("cross"), "rigid");
  const auto refused =
      bench.call("POST", "/v1/sweeps", R"({"sweep": {"cross": ["rigid", "flexible"], "rod_elements": [1]}})");
  EXPECT_EQ(refused.status, 422);
  EXPECT_EQ(json::parse(refused.body).at("errors").at(0).at("pointer"), "/sweep/rod_elements/0");
  const auto without_length = bench.call("POST", "/v1/jobs", R"({"cross": "flexible"})");
  EXPECT_EQ(without_length.status, 422);
  EXPECT_EQ(json::parse(without_length.body).at("errors").at(0).at("pointer"), "/cross_length_mm");
}

// JSON has no such number, but the json module of Python writes it.
TEST(PostSweep, NamesThePlaceOfANotANumber) {
  Bench bench;
  const auto response =
      bench.call("POST", "/v1/sweeps",
                 R"({"parameters": {"clearance_mm": NaN}, "sweep": {"restitution": [0.9, Infinity]}})");
  ASSERT_EQ(response.status, 422);
  std::map<std::string, std::string> details;
  const json problem = json::parse(response.body);
  for (const auto& error : problem.at("errors"))
    details[error.at("pointer").get<std::string>()] = error.at("detail").get<std::string>();
  EXPECT_EQ(details, (std::map<std::string, std::string>{
                         {"/parameters/clearance_mm", "must be a number in [0, 1000) mm"},
                         {"/sweep/restitution/1", "must be a number in [0, 1]"}}));
  EXPECT_TRUE(json::parse(bench.call("GET", "/v1/sweeps").body).at("items").empty());
}

TEST(PostSweep, RefusesWhatIsNoJson) {
  Bench bench;
  EXPECT_EQ(bench.call("POST", "/v1/sweeps", "name=paper").status, 400);
  EXPECT_EQ(bench.call("POST", "/v1/sweeps", "").status, 400);
  EXPECT_EQ(bench.call("POST", "/v1/sweeps", std::string(100'000, '[')).status, 400);
  EXPECT_EQ(bench.call("POST", "/v1/sweeps", "[]").status, 422);
  EXPECT_EQ(bench.call("POST", "/v1/sweeps", kSmallSweep, {{"dry_run", "1"}}).status, 422);
}

std::set<std::string> pointers_in(const server::Response& refused) {
  std::set<std::string> pointers;
  const json problem = json::parse(refused.body);
  for (const auto& error : problem.at("errors")) pointers.insert(error.at("pointer").get<std::string>());
  return pointers;
}

TEST(DryRun, TellsTheCostAndStoresNothing) {
  Bench bench;
  const auto ask = [&](const std::string& request) {
    const auto answer = bench.call("POST", "/v1/sweeps", request, {{"dry_run", "true"}});
    EXPECT_EQ(answer.status, 200) << answer.body;
    return json::parse(answer.body);
  };
  const json before = ask(kSmallSweep);
  EXPECT_EQ(before.at("jobs"), 4);
  EXPECT_EQ(before.at("new_jobs"), 4);
  EXPECT_EQ(before.at("stored_jobs"), 0);
  EXPECT_TRUE(before.at("seconds").is_null()) << "no job of these kinds has been computed";
  EXPECT_EQ(before.at("unmeasured_kinds").size(), 2U);
  EXPECT_TRUE(json::parse(bench.call("GET", "/v1/sweeps").body).at("items").empty());
  bench.run(kSmallSweep);
  const json after = ask(kSmallSweep);
  EXPECT_EQ(after.at("new_jobs"), 0);
  EXPECT_EQ(after.at("stored_jobs"), 4);
  EXPECT_EQ(after.at("seconds"), 0.0);
  const json more = ask(R"({"sweep": {"clearance_mm": [0.1, 0.3, 0.3001], "coupler": ["rigid"]}})");
  EXPECT_EQ(more.at("stored_jobs"), 1);
  EXPECT_EQ(more.at("measured_jobs"), 2);
  EXPECT_GT(more.at("seconds"), 0.0);
  EXPECT_GT(more.at("bytes"), 0.0);
  const json bare =
      ask(R"({"keep": "metrics", "sweep": {"clearance_mm": [0.1, 0.3], "coupler": ["rigid"]}})");
  EXPECT_LT(bare.at("bytes"), more.at("bytes"));
  EXPECT_GT(bare.at("free_bytes"), 0);
  EXPECT_EQ(ask(R"({"reuse": false, "sweep": {"clearance_mm": [0.1]}})").at("new_jobs"), 1);
}

TEST(DryRun, NamesEveryFaultOfTheRequest) {
  Bench bench;
  const auto refused = bench.call("POST", "/v1/sweeps", R"({"sweep": {"clearance_mm": [0.1, -1, "a"]}})",
                                  {{"dry_run", "true"}});
  ASSERT_EQ(refused.status, 422);
  EXPECT_EQ(pointers_in(refused), (std::set<std::string>{"/sweep/clearance_mm/1", "/sweep/clearance_mm/2"}));
}

TEST(DescribeSweep, ChangesWhatPeopleHaveWritten) {
  Bench bench;
  const std::string path = "/v1/sweeps/" + bench.run(kSmallSweep);
  const json before = json::parse(bench.call("GET", path).body);
  EXPECT_EQ(before.at("notes"), "");
  EXPECT_EQ(before.at("tags"), json::array());
  const auto changed = bench.call("PATCH", path, R"({"notes": "rig 2", "tags": ["dry", "pin B", "dry"]})");
  ASSERT_EQ(changed.status, 200) << changed.body;
  const json after = json::parse(bench.call("GET", path).body);
  EXPECT_EQ(json::parse(changed.body), after);
  EXPECT_EQ(after.at("name"), "small");
  EXPECT_EQ(after.at("notes"), "rig 2");
  EXPECT_EQ(after.at("tags"), json({"dry", "pin B"}));
  EXPECT_EQ(after.at("request"), before.at("request"));
  EXPECT_EQ(bench.call("PATCH", path, R"({"name": "", "tags": []})").status, 200);
  const json item = json::parse(bench.call("GET", "/v1/sweeps").body).at("items").at(0);
  EXPECT_EQ(item.at("name"), "");
  EXPECT_EQ(item.at("tags"), json::array());
  EXPECT_EQ(item.at("notes"), "rig 2");
}

TEST(DescribeSweep, NamesEveryFaultAndChangesNothing) {
  Bench bench;
  const std::string path = "/v1/sweeps/" + bench.run(kSmallSweep);
  const auto refused = bench.call("PATCH", path,
                                  json{{"name", 1},
                                       {"note", "x"},
                                       {"notes", std::string(10'001, 'a')},
                                       {"tags", {"good", "", 3, std::string(51, 'a')}}}
                                      .dump());
  ASSERT_EQ(refused.status, 422) << refused.body;
  EXPECT_EQ(pointers_in(refused),
            (std::set<std::string>{"/name", "/note", "/notes", "/tags/1", "/tags/2", "/tags/3"}));
  for (const char* const body : {"{}", "[]", R"("name")", R"({"tags": "dry"})"})
    EXPECT_EQ(bench.call("PATCH", path, body).status, 422) << body;
  EXPECT_EQ(bench.call("PATCH", path, "name").status, 400);
  EXPECT_EQ(json::parse(bench.call("GET", path).body).at("name"), "small");
  EXPECT_EQ(bench.call("PATCH", "/v1/sweeps/swp_none", R"({"name": "x"})").status, 404);
  EXPECT_EQ(bench.call("PATCH", "/v1/jobs/job_none", R"({"name": "x"})").status, 405);
}

TEST(GetSweeps, PagesFromTheNewest) {
  Bench bench;
  const std::string first = bench.run(R"({"name": "first", "sweep": {"clearance_mm": [0.1]}})");
  const std::string second = bench.run(R"({"name": "second", "sweep": {"clearance_mm": [0.2]}})");
  const json page = json::parse(bench.call("GET", "/v1/sweeps", "", {{"limit", "1"}}).body);
  ASSERT_EQ(page.at("items").size(), 1U);
  EXPECT_EQ(page.at("items")[0].at("id"), second);
  const std::string cursor = page.at("next_cursor");
  ASSERT_FALSE(cursor.empty());
  const json rest =
      json::parse(bench.call("GET", "/v1/sweeps", "", {{"limit", "1"}, {"cursor", cursor}}).body);
  EXPECT_EQ(rest.at("items").at(0).at("id"), first);
  const json failed = json::parse(bench.call("GET", "/v1/sweeps", "", {{"state", "failed"}}).body);
  EXPECT_TRUE(failed.at("items").empty());
}

TEST(GetSweeps, RefusesAFaultyQuery) {
  Bench bench;
  for (const auto& [key, value] :
       {std::pair{"limit", "0"}, {"limit", "10001"}, {"limit", "ten"}, {"state", "done"}, {"page", "2"}}) {
    const auto response = bench.call("GET", "/v1/sweeps", "", {{key, value}});
    EXPECT_EQ(response.status, 422) << key << "=" << value;
    EXPECT_EQ(json::parse(response.body).at("errors").at(0).at("pointer"), std::string("/") + key);
  }
}

TEST(GetResults, AreTheSameInBothForms) {
  Bench bench;
  const std::string path = "/v1/sweeps/" + bench.run(kSmallSweep) + "/results";
  const json rows = json::parse(bench.call("GET", path).body);
  ASSERT_EQ(rows.size(), 4U);
  // The last axis is the fastest.
  EXPECT_EQ(rows[1].at("clearance_mm"), 0.1);
  EXPECT_EQ(rows[1].at("coupler"), "flexible");
  EXPECT_EQ(rows[2].at("clearance_mm"), 0.25);
  EXPECT_EQ(rows[2].at("coupler"), "rigid");
  const auto metrics = engine::metric_table();
  // known_run: metric i is 100 i + the clearance.
  EXPECT_NEAR(rows[2].at(metrics[1].key).get<double>(), 100.25, 1e-9);
  EXPECT_TRUE(rows[2].at(metrics.back().key).is_null());

  const auto csv = bench.call("GET", path, "", {}, "text/csv");
  EXPECT_EQ(csv.content_type, "text/csv; charset=utf-8");
  EXPECT_EQ(csv.body, bench.call("GET", path, "", {{"format", "csv"}}).body);
  EXPECT_EQ(std::count(csv.body.begin(), csv.body.end(), '\n'), 5);
  EXPECT_EQ(csv.body.substr(0, csv.body.find(',')), "job_id");
  EXPECT_NE(csv.body.find(rows[2].at("job_id").get<std::string>()), std::string::npos);
}

/// A run whose peak is 1000 times the stiffness scale. Perturbed runs at a clearance of 0.25 mm fail.
engine::RunResult stiffness_run(const jobs::JobSpec& spec, const engine::StopQuery& stop_requested) {
  engine::RunResult result = server_tests::known_run(spec, stop_requested);
  const double scale = spec.parameters.contact_stiffness_scale;
  result.metrics.at(0) = 1000.0 * scale;
  if (scale != 1.0 && spec.parameters.c_r > 0.2e-3) result.status = engine::RunStatus::kNonFinite;
  return result;
}

/// Statistics in a row of the replicates of its set.
json statistics_of(const json& row) {
  json statistics;
  for (const char* const key : {"count", "mean", "spread", "min", "max"})
    statistics[key] = row.at(std::string("replicates_") + key);
  return statistics;
}

TEST(GetResults, CarryTheStatisticsOfReplicates) {
  Bench bench(stiffness_run);
  const std::string path =
      "/v1/sweeps/" +
      bench.run(
          R"({"sweep": {"clearance_mm": [0.1, 0.25]}, "replicates": {"count": 3, "perturbation": 0.1}})") +
      "/results";
  const json rows = json::parse(bench.call("GET", path).body);
  ASSERT_EQ(rows.size(), 6U);
  std::vector<double> peaks;
  for (std::size_t i = 0; i < 3; ++i) peaks.push_back(rows[i].at("peak_slider_acceleration_m_s2"));
  for (const json& row : rows) {
    for (const auto& [key, value] : row.items()) EXPECT_TRUE(value.is_primitive()) << key;
  }
  const json first = statistics_of(rows[0]);
  EXPECT_EQ(first.at("count"), 3);
  EXPECT_EQ(first.at("min"), *std::min_element(peaks.begin(), peaks.end()));
  EXPECT_EQ(first.at("max"), *std::max_element(peaks.begin(), peaks.end()));
  EXPECT_NEAR(first.at("mean").get<double>(), (peaks[0] + peaks[1] + peaks[2]) / 3.0, 1e-9);
  // Of three values a, b, c the sample variance is the mean of the squared differences of pairs, halved.
  const double ab = peaks[0] - peaks[1], bc = peaks[1] - peaks[2], ca = peaks[2] - peaks[0];
  EXPECT_GT(std::abs(ab), 1.0);
  EXPECT_NEAR(first.at("spread").get<double>(), std::sqrt((ab * ab + bc * bc + ca * ca) / 6.0), 1e-9);
  EXPECT_EQ(statistics_of(rows[2]), first);
  EXPECT_EQ(rows[4].at("state"), "failed");
  EXPECT_EQ(statistics_of(rows[4]),
            json::parse(R"({"count": 1, "mean": 1000, "spread": null, "min": 1000, "max": 1000})"));

  const std::string csv = bench.call("GET", path, "", {{"format", "csv"}}).body;
  const std::string head = csv.substr(0, csv.find("\r\n"));
  EXPECT_TRUE(
      head.ends_with("," + engine::metric_table().back().key +
                     ",replicates_count,replicates_mean,replicates_spread,replicates_min,replicates_max"))
      << head;
  EXPECT_TRUE(csv.ends_with(",1,1000,,1000,1000\r\n")) << csv;
  EXPECT_NE(csv.find(",3," + first.at("mean").dump() + "," + first.at("spread").dump() + ","),
            std::string::npos)
      << csv;
}

TEST(GetResults, CarryNoStatisticsWithoutReplicates) {
  Bench bench;
  const std::string path = "/v1/sweeps/" + bench.run(kSmallSweep) + "/results";
  EXPECT_EQ(bench.call("GET", path).body.find("replicate"), std::string::npos);
  EXPECT_EQ(bench.call("GET", path, "", {{"format", "csv"}}).body.find("replicate"), std::string::npos);
}

TEST(CancelSweep, EndsWhatRuns) {
  Bench bench(endless_run);
  const std::string id = bench.submit(kSmallSweep);
  const auto busy = bench.call("DELETE", "/v1/sweeps/" + id);
  EXPECT_EQ(busy.status, 409) << busy.body;
  EXPECT_EQ(bench.call("POST", "/v1/sweeps/" + id + "/cancel").status, 200);
  EXPECT_TRUE(bench.service().wait_for_sweep(id, std::chrono::seconds(300)));
  EXPECT_EQ(json::parse(bench.call("GET", "/v1/sweeps/" + id).body).at("state"), "cancelled");
  EXPECT_EQ(bench.call("DELETE", "/v1/sweeps/" + id).status, 204);
  EXPECT_EQ(bench.call("DELETE", "/v1/sweeps/" + id).status, 404);
}

TEST(CancelSweep, RefusesWhatHasSucceeded) {
  Bench bench;
  const std::string id = bench.run(R"({"sweep": {"clearance_mm": [0.1]}})");
  EXPECT_EQ(bench.call("POST", "/v1/sweeps/" + id + "/cancel").status, 409);
}

TEST(SweepRoutes, AnswerUnknownIdsWith404) {
  Bench bench;
  EXPECT_EQ(bench.call("GET", "/v1/sweeps/none").status, 404);
  EXPECT_EQ(bench.call("GET", "/v1/sweeps/none/results").status, 404);
  EXPECT_EQ(bench.call("POST", "/v1/sweeps/none/cancel").status, 404);
  EXPECT_EQ(bench.call("DELETE", "/v1/sweeps/none").status, 404);
}

}  // namespace
