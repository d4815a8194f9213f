// SPDX-License-Identifier: Apache-2.0
// Analyses of results. Metric i of the known run is 100 i + clearance in mm; its crank turns 10 + k rad in
// sample k of four.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "jobs/runs/run_record.h"
#include "tests/jobs/requests/example_linkage.h"
#include "tests/server/service_fixture.h"

namespace {

using nlohmann::json;
using server_tests::Bench;
using server_tests::header;

/// A known run that is long enough for what looks at it closely: 64 samples, the crank passing its place at
/// rest every 2 pi / 0.5 of them.
engine::RunResult long_run(const jobs::JobSpec& spec, const engine::StopQuery& stop) {
  engine::RunResult result = server_tests::known_run(spec, stop);
  for (std::size_t c = 0; c < result.trajectory.columns.size(); ++c) {
    auto& column = result.trajectory.columns[c];
    column.clear();
    for (int k = 0; k < 64; ++k)
      column.push_back(c == 0   ? k / 1000.0
                       : c == 1 ? 0.5 * k
                       : c == 2 ? 500.0  // the rate of column 1
                                : static_cast<double>(c) + (k % 4));
  }
  return result;
}

json rows_of(Bench& bench, const std::string& path,
             std::vector<std::pair<std::string, std::string>> query = {}) {
  const auto response = bench.call("GET", path, "", std::move(query));
  EXPECT_EQ(response.status, 200) << response.body;
  EXPECT_FALSE(header(response, "ETag").empty());
  return json::parse(response.body);
}

TEST(Analyses, TellWhatAMetricDependsOn) {
  Bench bench;
  const std::string path = "/v1/sweeps/" + bench.run(R"({"design": {"type": "saltelli", "count": 32, "over":
    {"restitution": {"from": 0.6, "to": 0.9}, "clearance_mm": {"from": 0.1, "to": 0.5}}},
                                                        "sweep": {"coupler": ["rigid", "flexible"]}})");
  const json rows = rows_of(bench, path + "/sensitivity", {{"metric", "impact_count"}});
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows.at(0).at("parameter"), "restitution");
  EXPECT_EQ(rows.at(0).at("total"), 0.0);
  EXPECT_EQ(rows.at(1).at("parameter"), "clearance_mm");
  const json surrogate = rows_of(bench, path + "/surrogate", {{"x", "clearance_mm"}});
  ASSERT_EQ(surrogate.at("surfaces").size(), 2U);
  const json& surface = surrogate.at("surfaces").at(1);
  EXPECT_EQ(surface.at("where").at("coupler"), "flexible");
  EXPECT_EQ(surrogate.at("y"), "restitution");
  EXPECT_LT(surface.at("cross_validation_error").get<double>(), 1e-9) << "a plane";
  EXPECT_NEAR(surface.at("values").at(0).at(0).get<double>(), surface.at("x_values").at(0).get<double>(),
              1e-9);
  EXPECT_EQ(surface.at("at").size(), surface.at("points").get<std::size_t>());
  EXPECT_EQ(bench.call("GET", path + "/sensitivity", "", {{"metric", "state"}}).status, 422);
  EXPECT_EQ(bench.call("GET", path + "/surrogate", "", {{"y", "coupler"}}).status, 422);
  EXPECT_EQ(bench.call("GET", path + "/surrogate", "", {{"x", "clearance_mm"}, {"y", "clearance_mm"}}).status,
            422);
  EXPECT_NE(bench.call("GET", path + "/sensitivity", "", {{"format", "csv"}}).body.find("first_order_low"),
            std::string::npos);
}

TEST(Analyses, PairRigidAndFlexibleJobs) {
  Bench bench;
  const std::string path =
      "/v1/sweeps/" +
      bench.run(R"({"sweep": {"clearance_mm": [0.1, 0.2], "coupler": ["rigid", "flexible"]}})");
  const json rows = rows_of(bench, path + "/flexibility");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows.at(0).at("ratio"), 1.0);
  EXPECT_EQ(rows.at(0).at("verdict"), "one_run_each");
  EXPECT_EQ(bench.call("GET", path + "/sensitivity").status, 409);
  EXPECT_EQ(bench.call("GET", path + "/lyapunov").status, 409);
  const std::string rigid = "/v1/sweeps/" + bench.run(R"({"sweep": {"restitution": [0.7]}})");
  EXPECT_EQ(bench.call("GET", rigid + "/flexibility").status, 409);
  EXPECT_EQ(bench.call("GET", rigid + "/surrogate").status, 409);
}

// Rows name the law of each drive, and have no velocity where a drive takes its place.
TEST(Analyses, NameDrivesThatCasesVary) {
  Bench bench(long_run);
  const std::string path =
      "/v1/sweeps/" +
      bench.run(R"({"parameters": {"run_up_s": 0}, "sweep": {"coupler": ["rigid", "flexible"]}, "cases": [
             {"crank_drive": {"law": "run_up", "velocity_rad_s": 5}}, {"crank_velocity_rad_s": 5},
             {"crank_drive": {"law": "velocity_table", "times_s": [0, 1], "velocities_rad_s": [0, 5]}}],
             "replicates": {"count": 2}})");
  const json rows = rows_of(bench, path + "/flexibility");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows.at(0).at("crank_drive"), "run_up");
  EXPECT_TRUE(rows.at(0).at("crank_velocity_rad_s").is_null());
  EXPECT_TRUE(rows.at(1).at("crank_drive").is_null());
  for (const char* const analysis : {"/bifurcation", "/lyapunov", "/results"})
    EXPECT_GT(rows_of(bench, path + analysis).size(), 1U) << analysis;
  EXPECT_EQ(rows_of(bench, path + "/results", {{"crank_drive", "velocity_table"}}).size(), 4U);
  EXPECT_EQ(bench.call("GET", path + "/results", "", {{"crank_drive_gt", "1"}}).status, 422);
}

TEST(Analyses, CompareRigidAndFlexibleBeams) {
  Bench bench(jobs::engine_runner());
  const std::string elements = "linkage.bodies.coupler.beam.elements", mass = "linkage.bodies.rocker.mass_kg";
  json request{{"parameters", jobs_tests::example("four_bar")},
               {"sweep", {{elements, {1, 4}}, {mass, {0.4, 0.5}}}}};
  const std::string path = "/v1/sweeps/" + bench.run(request.dump());
  const json rows = rows_of(bench, path + "/flexibility");
  ASSERT_EQ(rows.size(), 2U);
  for (const json& row : rows) {
    EXPECT_EQ(row.at("along"), mass);
    EXPECT_FALSE(row.contains(elements));
    EXPECT_EQ(row.at("rigid_count"), 1);
    EXPECT_EQ(row.at("flexible_count"), 1);
    EXPECT_GT(row.at("coupler_loss_j").get<double>(), 0.0);
    EXPECT_NE(row.at("metric"), "peak_crank_acceleration_rad_s2") << "which the drive prescribes";
    EXPECT_NEAR(row.at("ratio").get<double>(), 1.0, 0.5);
    EXPECT_NE(row.at("ratio"), 1.0);
  }
  request["sweep"][elements] = {1, 3, 4};
  EXPECT_EQ(bench.call("GET", "/v1/sweeps/" + bench.run(request.dump()) + "/flexibility").status, 409);
  request["sweep"][elements] = {3, 4};
  EXPECT_EQ(bench.call("GET", "/v1/sweeps/" + bench.run(request.dump()) + "/flexibility").status, 409);
}

TEST(Analyses, LookAtMotionsOnceATurn) {
  Bench bench(long_run);
  const std::string path =
      "/v1/sweeps/" + bench.run(
                          R"({"parameters": {"run_up_s": 0}, "sweep": {"clearance_mm": [0.1, 0.2]},
             "replicates": {"count": 2}})");
  const json rows = rows_of(bench, path + "/bifurcation");
  ASSERT_EQ(rows.size(), 4U * 5) << "31.5 rad are five turns";
  EXPECT_NEAR(rows.at(0).at("t_s").get<double>(), 4.0 * 3.14159265e-3, 1e-6);
  EXPECT_EQ(rows_of(bench, path + "/bifurcation", {{"from", "0.03"}, {"channel", "contact_force_n"}}).size(),
            4U * 3);
  EXPECT_EQ(json::parse(bench.call("GET", path + "/bifurcation", "", {{"channel", "x"}}).body)
                .at("errors")
                .at(0)
                .at("pointer"),
            "/channel");
  EXPECT_EQ(bench.call("GET", path + "/bifurcation", "", {{"channel", "t_s"}}).status, 422);
  const json exponents = rows_of(bench, path + "/lyapunov");
  ASSERT_EQ(exponents.size(), 2U);
  EXPECT_EQ(exponents.at(0).at("pairs"), 1);
  EXPECT_EQ(exponents.at(0).at("pairs_diverged"), 0) << "both runs are the same";
  EXPECT_EQ(exponents.at(0).at("exponent_1_s"), 0.0);
  EXPECT_LT(exponents.at(0).at("exponent_low_1_s"), 0.0);
  EXPECT_GT(exponents.at(0).at("exponent_high_1_s"), 0.0);

  const std::string job =
      "/v1/jobs/" +
      json::parse(bench.call("GET", path + "/results").body).at(0).at("job_id").get<std::string>();
  const json section = rows_of(bench, job + "/poincare");
  EXPECT_EQ(section.at("channels"), json({"t_s", "turn", "journal_x_mm", "journal_y_mm"}));
  EXPECT_EQ(section.at("columns").at("turn").size(), 5U);
  EXPECT_EQ(json::parse(bench.call("GET", job + "/poincare", "", {{"channels", "x"}}).body)
                .at("errors")
                .at(0)
                .at("pointer"),
            "/channels/0");
  const json spectrum =
      rows_of(bench, job + "/spectrum", {{"channel", "journal_x_mm"}, {"window", "rectangular"}});
  EXPECT_EQ(spectrum.at("columns").at("frequency_hz").size(), 33U);
  // 0, 1, 2, 3 and so on: sqrt(2) at a quarter of the sampling rate.
  EXPECT_NEAR(spectrum.at("columns").at("journal_x_mm").at(16).get<double>(), 1.41421356, 1e-6);
  EXPECT_EQ(bench.call("GET", job + "/spectrum", "", {{"format", "npz"}}).body.substr(0, 2), "PK");
  EXPECT_EQ(bench.call("GET", job + "/spectrum", "", {{"to", "0.01"}}).status, 409) << "too few samples";
  const auto refused = bench.call("GET", job + "/spectrum", "", {{"channel", "x"}, {"window", "square"}});
  EXPECT_EQ(json::parse(refused.body).at("errors").size(), 2U);
}

// Every channel of the long run rises from its number by 3 in three samples and falls back: the ring's work
// by 48, the first ring's at 45 degrees.
TEST(Analyses, MapWearOnTheBearing) {
  Bench bench(long_run);
  const std::string path = "/v1/sweeps/" + bench.run(R"({"sweep": {"clearance_mm": [0, 0.2]}})");
  const json jobs = json::parse(bench.call("GET", path + "/results").body);
  const std::string wear = "/v1/jobs/" + jobs.at(1).at("job_id").get<std::string>() + "/wear";
  const json rows = rows_of(
      bench, wear, {{"sectors", "8"}, {"wear_coefficient_m2_n", "1e-14"}, {"worn_clearance_mm", "0.3"}});
  ASSERT_EQ(rows.size(), 3U * 8);
  const double area = 5e-3 * 2.0 * 3.14159265358979 / 8.0 * 16e-3 / 3.0;
  const json& worn = rows.at(1);  // from 45 to 90 degrees
  EXPECT_EQ(worn.at("sliding_work_j"), 48.0);
  EXPECT_NEAR(worn.at("depth_um").get<double>(), 1e6 * 1e-14 * 48.0 / area, 1e-9);
  EXPECT_NEAR(worn.at("life_h").get<double>() * worn.at("rate_um_h").get<double>(), 100.0, 1e-9);
  EXPECT_TRUE(rows.at(2).at("life_h").is_null());
  EXPECT_NE(bench.call("GET", wear, "", {{"format", "csv"}}).body.find("ring,position_mm,angle_rad"),
            std::string::npos);
  for (const auto& [key, value] : {std::pair{"sectors", "3"},
                                   {"sectors", "8.5"},
                                   {"wear_coefficient_m2_n", "0"},
                                   {"wear_coefficient_m2_n", "1e-5"},
                                   {"worn_clearance_mm", "0.2"}}) {
    const auto refused = bench.call("GET", wear, "", {{key, value}});
    EXPECT_EQ(refused.status, 422) << key;
    EXPECT_EQ(json::parse(refused.body).at("errors").at(0).at("pointer"), std::string("/") + key);
  }
  EXPECT_EQ(bench.call("GET", "/v1/jobs/" + jobs.at(0).at("job_id").get<std::string>() + "/wear").status, 409)
      << "an ideal joint";
}

/// A run whose peak (metric 0) grows from 10 to 15 rad/s by 8.5, 4, 3.5 and 1.25 times, as the paper prints.
/// With a restitution of 0.79 or less the first growth is 4.
engine::RunResult run_of_the_paper(const jobs::JobSpec& spec, const engine::StopQuery& stop) {
  const engine::RpsupParameters& p = spec.parameters;
  const bool fast = p.crank_velocity > 12.0, flexible = p.coupler == engine::Coupler::kFlexible;
  const double narrow =
      flexible ? (fast ? 320.0 : 80.0) : (fast ? (p.restitution < 0.795 ? 400.0 : 850.0) : 100.0);
  const double wide = flexible ? (fast ? 250.0 : 200.0) : (fast ? 700.0 : 200.0);
  engine::RunResult result = server_tests::known_run(spec, stop);
  result.metrics[0] = p.c_r == 0.0 ? (fast ? 90.0 : 40.0) : p.c_r < 0.4e-3 ? narrow : wide;
  return result;
}

TEST(Analyses, HoldAStudyAgainstThePaper) {
  Bench bench(run_of_the_paper);
  const std::string grid =
      R"("clearance_mm": [0, 0.25, 0.5], "crank_velocity_rad_s": [10, 15], "coupler": ["rigid", "flexible"])";
  const std::string id = bench.run(R"({"sweep": {)" + grid + R"(}, "replicates": {"count": 2}})");
  const std::string path = "/v1/sweeps/" + id + "/paper";
  const json rows = rows_of(bench, path);
  ASSERT_EQ(rows.size(), 9U);
  const std::vector<double> growths{8.5, 4.0, 3.5, 1.25};
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_EQ(rows.at(k).at("number"), k < 7 ? json(k + 1) : json());
    EXPECT_EQ(rows.at(k).at("holds"), k < 7) << rows.at(k);
    EXPECT_EQ(rows.at(k).at("settings"), 1);
    if (k >= 1 && k <= 4) {
      EXPECT_EQ(rows.at(k).at("found_least"), growths[k - 1]);
    }
  }
  const auto csv = bench.call("GET", path, "", {{"format", "csv"}});
  EXPECT_EQ(csv.status, 200);
  EXPECT_EQ(csv.content_type, "text/csv; charset=utf-8");
  EXPECT_EQ(csv.body.substr(0, csv.body.find('\r')),
            "statement,number,text,paper,found_least,found_largest,settings,share,holds");
  EXPECT_NE(csv.body.find("growth_rigid_0.25_mm,2,"), std::string::npos);
  EXPECT_EQ(std::ranges::count(csv.body, '\n'), 10);
  EXPECT_EQ(bench.call("GET", path, "", {{"metric", "impact_count"}}).status, 422)
      << "an unknown key of the query";

  const std::string settings = bench.run(R"({"sweep": {"restitution": [0.7, 0.8, 0.9], )" + grid + "}}");
  const json shares = rows_of(bench, "/v1/sweeps/" + settings + "/paper");
  EXPECT_EQ(shares.at(1).at("settings"), 3);
  EXPECT_EQ(shares.at(1).at("share"), 2.0 / 3.0);
  EXPECT_EQ(shares.at(1).at("holds"), false);
  EXPECT_EQ(shares.at(2).at("holds"), true);
}

TEST(Analyses, TellWhatDecidesThePapersStatements) {
  Bench bench(run_of_the_paper);
  const std::string id =
      bench.run(R"({"sweep": {"clearance_mm": [0.25], "crank_velocity_rad_s": [10, 15], "coupler": ["rigid"],
    "restitution": {"from": 0.71, "to": 0.9, "count": 20}, "friction_static": [0.1, 0.2, 0.3]}})");
  const json rows = rows_of(bench, "/v1/sweeps/" + id + "/paper");
  EXPECT_EQ(rows.at(1).at("settings"), 60);
  EXPECT_EQ(rows.at(1).at("share"), 11.0 / 20.0) << "0.80 to 0.90 of 0.71 to 0.90";
  EXPECT_GT(rows.at(1).at("index.restitution").get<double>(), 0.8);
  EXPECT_EQ(rows.at(1).at("index.friction_static"), 0.0);
  EXPECT_TRUE(rows.at(2).at("index.restitution").is_null());
  EXPECT_TRUE(rows.at(2).at("holds").is_null()) << "no flexible coupler";
}

TEST(Analyses, NeedTheAxesOfThePaper) {
  Bench bench;
  const json axes{
      {"clearance_mm", {0.25, 0.5}}, {"crank_velocity_rad_s", {10, 15}}, {"coupler", {"rigid", "flexible"}}};
  for (const auto& [missing, values] : axes.items()) {
    json sweep = axes;
    sweep.erase(missing);
    const auto refused =
        bench.call("GET", "/v1/sweeps/" + bench.run(json{{"sweep", sweep}}.dump()) + "/paper");
    EXPECT_EQ(refused.status, 409) << missing;
    EXPECT_NE(refused.body.find("does not vary " + missing), std::string::npos) << refused.body;
  }
}

// A job of another linkage has no value of a parameter that belongs to this one.
TEST(Analyses, LeaveJobsOfAnotherLinkageApart) {
  Bench bench;
  const std::string path =
      "/v1/sweeps/" + bench.run(R"({"cases": [{"rod_length_m": 0.19}, {"rod_length_m": 0.2},
    {"linkage": {"bodies": {"bob": {"mass_kg": 1}}, "joints": {"pivot": {"kind": "revolute", "from": "ground",
                                   "to": "bob", "at_m": [0.1, 0, 0],
     "drive": {"law": "run_up", "velocity_rad_s": 1}}}}}]})");
  const json surrogate = rows_of(bench, path + "/surrogate", {{"metric", "impact_count"}});
  ASSERT_EQ(surrogate.at("inputs").size(), 1U);
  EXPECT_EQ(surrogate.at("inputs").at(0).at("parameter"), "rod_length_m");
  ASSERT_EQ(surrogate.at("surfaces").size(), 2U);
  EXPECT_EQ(surrogate.at("surfaces").at(0).at("points"), 2);
  EXPECT_EQ(surrogate.at("surfaces").at(1).at("points"), 0);
  for (const char* const analysis : {"/report", "/results"})
    EXPECT_EQ(bench.call("GET", path + analysis).status, 200) << analysis;
}

TEST(Analyses, SayWhichOnlyRpsupHas) {
  Bench bench(jobs::engine_runner());
  const std::string sweep =
      "/v1/sweeps/" + bench.run(R"({"parameters": {"duration_s": 0.05, "run_up_s": 0.01, "linkage":
    {"bodies": {"bob": {"mass_kg": 1, "centre_of_mass_m": [0.5, 0, 0]}},
                                   "joints": {"pivot": {"kind": "revolute", "from": "ground", "to": "bob"}}}},
    "sweep": {"linkage.bodies.bob.mass_kg": [1, 2]}, "replicates": {"count": 2}})");
  const std::string job =
      "/v1/jobs/" +
      json::parse(bench.call("GET", sweep + "/results").body).at(0).at("job_id").get<std::string>();
  const std::vector<std::pair<std::string, std::string>> refused{
      {sweep + "/bifurcation", "say which channels to take"},
      {job + "/poincare", "say which channels to take"},
      {sweep + "/lyapunov", "has no joint with clearance"},
      {job + "/wear", "no joint of this job has a journal that slides"}};
  for (const auto& [path, why] : refused) {
    const auto response = bench.call("GET", path);
    EXPECT_EQ(response.status, 409) << path;
    EXPECT_NE(response.body.find(why), std::string::npos) << response.body;
  }
  EXPECT_EQ(json::parse(bench.call("GET", job + "/spectrum", "", {{"channel", "x"}}).body)
                .at("errors")
                .at(0)
                .at("pointer"),
            "/channel");
}

TEST(Analyses, RefuseMotionsThatWereNotKept) {
  Bench bench;
  const std::string id =
      bench.run(R"({"sweep": {"clearance_mm": [0.1]}, "replicates": {"count": 2}, "keep": "metrics"})");
  for (const char* const analysis : {"/lyapunov", "/bifurcation"}) {
    const auto refused = bench.call("GET", "/v1/sweeps/" + id + analysis);
    EXPECT_EQ(refused.status, 409) << analysis;
    EXPECT_NE(refused.body.find("keep"), std::string::npos) << refused.body;
  }
  const std::string job =
      json::parse(bench.call("GET", "/v1/sweeps/" + id + "/results").body).at(0).at("job_id");
  for (const char* const of_job : {"/trajectory", "/spectrum", "/poincare"}) {
    const auto missing = bench.call("GET", "/v1/jobs/" + job + of_job);
    EXPECT_EQ(missing.status, 404) << of_job;
    EXPECT_NE(missing.body.find("keep"), std::string::npos) << missing.body;
  }
}

// A crank that turns every 0.05 s, less half a run-up of 0.02 s, with a pendulum on a pin with play.
TEST(Analyses, TakeSectionsAndExponentsOfDescribedLinkages) {
  Bench bench(jobs::engine_runner());
  const std::string sweep =
      "/v1/sweeps/" + bench.run(R"({"parameters": {"duration_s": 0.22, "run_up_s": 0.02, "linkage":
    {"bodies": {"crank": {"mass_kg": 1, "inertia_kg_m2": [0.01, 0.01, 0.01]},
                "bob": {"mass_kg": 1, "centre_of_mass_m": [0.1, 0, 0], "inertia_kg_m2": [0.001, 0.01, 0.01]}},
     "joints": {"wheel": {"kind": "revolute", "from": "ground", "to": "crank",
                          "drive": {"law": "run_up", "velocity_rad_s": 125.66370614359172}},
                "pin": {"kind": "revolute", "from": "crank", "to": "bob", "at_m": [0.05, 0, 0],
                        "clearance": {"clearance_mm": 0.1}}}}},
    "sweep": {"restitution": [0.5, 0.9]}, "replicates": {"count": 2}})");
  const json rows = rows_of(bench, sweep + "/bifurcation", {{"from", "0"}});
  EXPECT_EQ(rows.size(), 16U) << "a passage every 0.05 s of four jobs";
  EXPECT_TRUE(rows.at(0).contains("pin_journal_x_mm")) << rows.at(0);
  const json exponents = rows_of(bench, sweep + "/lyapunov");
  ASSERT_EQ(exponents.size(), 2U);
  EXPECT_EQ(exponents.at(0).at("pairs"), 1);
  // All that have a metric by default have the same one, which no drive prescribes.
  const std::string metric = json::parse(bench.call("GET", sweep + "/surrogate").body).at("metric");
  EXPECT_EQ(metric.find("wheel"), std::string::npos) << metric;
  const json results = json::parse(bench.call("GET", sweep + "/results").body);
  EXPECT_DOUBLE_EQ(results.at(0).at("replicates_mean").get<double>(),
                   0.5 * (results.at(0).at(metric).get<double>() + results.at(1).at(metric).get<double>()));
  const std::string job =
      "/v1/jobs/" +
      json::parse(bench.call("GET", sweep + "/results").body).at(0).at("job_id").get<std::string>();
  const json section = rows_of(bench, job + "/poincare");
  ASSERT_EQ(section.at("columns").at("t_s").size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    const double passage = 0.01 + 0.05 * static_cast<double>(k + 1);
    EXPECT_NEAR(section.at("columns").at("t_s").at(k).get<double>(), passage, 1e-6);
    EXPECT_LT(std::hypot(section.at("columns").at("pin_journal_x_mm").at(k).get<double>(),
                         section.at("columns").at("pin_journal_y_mm").at(k).get<double>()),
              0.15);
  }
  const json other = rows_of(bench, job + "/poincare", {{"angle", "pin_rad"}, {"channels", "wheel_rad_s"}});
  EXPECT_EQ(other.at("channels"), json({"t_s", "turn", "wheel_rad_s"}));
  const auto refused = bench.call("GET", job + "/poincare", "", {{"angle", "wheel_rad_s"}});
  EXPECT_EQ(refused.status, 422);
  EXPECT_EQ(json::parse(refused.body).at("errors").at(0).at("pointer"), "/angle");
}

TEST(Analyses, AgreeForRpsupAndItsDescription) {
  const json described = jobs_tests::example("rpsup").at("linkage");
  Bench bench(jobs::engine_runner());
  std::vector<json> exponents, sections, wear;
  for (const bool is_described : {false, true}) {
    json parameters{{"duration_s", 1.5}, {"run_up_s", 0.3}};
    if (is_described) parameters["linkage"] = described;
    const json request{
        {"parameters", parameters}, {"sweep", {{"restitution", {0.95}}}}, {"replicates", {{"count", 2}}}};
    const std::string sweep = "/v1/sweeps/" + bench.run(request.dump());
    exponents.push_back(rows_of(bench, sweep + "/lyapunov").at(0));
    const json rows = json::parse(bench.call("GET", sweep + "/results").body);
    const std::string job = "/v1/jobs/" + rows.at(0).at("job_id").get<std::string>();
    sections.push_back(rows_of(bench, job + "/poincare").at("columns"));
    wear.push_back(rows_of(bench, job + "/wear", {{"sectors", "12"}, {"worn_clearance_mm", "0.3"}}));
    const auto of_other = bench.call("GET", job + "/wear", "", {{"joint", "slider"}});
    EXPECT_EQ(json::parse(of_other.body).at("errors").at(0).at("pointer"), "/joint");
  }
  EXPECT_EQ(exponents[0].at("pairs"), 1);
  EXPECT_NEAR(exponents[0].at("exponent_1_s").get<double>(),
              exponents[1].at("exponent_1_s").get<double>(), 1e-4);
  ASSERT_EQ(sections[0].at("t_s").size(), 2U);
  ASSERT_EQ(sections[1].at("t_s").size(), 2U);
  for (std::size_t k = 0; k < 2; ++k)
    for (const char* const channel : {"journal_x_mm", "journal_y_mm"})
      EXPECT_NEAR(sections[0].at(channel).at(k).get<double>(),
                  sections[1].at(std::string("bearing_") + channel).at(k).get<double>(), 1e-6);
  ASSERT_EQ(wear[0].size(), 36U);
  ASSERT_EQ(wear[1].size(), 36U);
  double deepest = 0.0;
  for (const json& row : wear[0]) deepest = std::max(deepest, row.at("depth_um").get<double>());
  EXPECT_GT(deepest, 0.0);
  for (std::size_t k = 0; k < wear[0].size(); ++k)
    EXPECT_NEAR(wear[0].at(k).at("depth_um").get<double>(), wear[1].at(k).at("depth_um").get<double>(),
                1e-3 * deepest);
}

// Each joint has its own bearing; a ball in a socket and a block in a slot have no bore.
TEST(Analyses, MapTheWearOfEachJointWithABore) {
  Bench bench(jobs::engine_runner());
  const auto run_of = [&](const char* linkage) {
    json parameters = jobs_tests::example(linkage);
    parameters["duration_s"] = 0.15;
    const std::string sweep = "/v1/sweeps/" + bench.run(json{{"parameters", parameters}}.dump());
    const json rows = json::parse(bench.call("GET", sweep + "/results").body);
    return "/v1/jobs/" + rows.at(0).at("job_id").get<std::string>() + "/wear";
  };
  const std::string crank = run_of("slider_crank");
  const json first = rows_of(bench, crank, {{"sectors", "4"}});
  ASSERT_EQ(first.size(), 4U) << "one ring";
  EXPECT_EQ(first, rows_of(bench, crank, {{"joint", "crank_pin"}, {"sectors", "4"}}));
  EXPECT_NE(first, rows_of(bench, crank, {{"joint", "slider_pin"}, {"sectors", "4"}}));
  EXPECT_EQ(bench.call("GET", crank, "", {{"worn_clearance_mm", "0.1"}, {"joint", "crank_pin"}}).status, 422);
  EXPECT_EQ(bench.call("GET", crank, "", {{"joint", "guide"}}).status, 422);
  EXPECT_EQ(bench.call("GET", run_of("loose_socket")).status, 409);
}

TEST(Analyses, AreOfWhatIsThere) {
  Bench bench;
  for (const std::string analysis :
       {"sensitivity", "surrogate", "flexibility", "paper", "bifurcation", "lyapunov", "report"}) {
    EXPECT_EQ(bench.call("GET", "/v1/sweeps/swp_none/" + analysis).status, 404);
  }
  for (const std::string analysis : {"spectrum", "poincare", "wear"})
    EXPECT_EQ(bench.call("GET", "/v1/jobs/job_none/" + analysis).status, 404);
}

}  // namespace
