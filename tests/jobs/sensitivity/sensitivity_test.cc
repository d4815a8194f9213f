// SPDX-License-Identifier: Apache-2.0
#include "jobs/sensitivity/sensitivity.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "jobs/base/errors.h"
#include "jobs/requests/sampled_designs.h"
#include "jobs/results/table_groups.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

struct Ended {
  json sweep;
  jobs::ResultTable results;
};

/// Runs a sweep on the fake engine, whose metric number 0 is sqrt(1000 crank_velocity + c_r).
Ended run_sensitivity(const ordered_json& request) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 2));
  const std::string id = service.submit_sweep(request).at("id");
  EXPECT_TRUE(service.wait_for_sweep(id, std::chrono::seconds(60)));
  return {service.find_sweep(id).value(), service.find_results(id).value()};
}

ordered_json design_of(const std::string& type) {
  // The order is not that of the alphabet: restitution, which does nothing here, comes before the speed.
  ordered_json design{
      {"type", type},
      {"over",
       {{"restitution", {{"from", 0.6}, {"to", 0.9}}}, {"crank_velocity_rad_s", {{"from", 4}, {"to", 9}}}}}};
  design[type == "morris" ? "trajectories" : "count"] = type == "morris" ? 6 : 16;
  return {
      {"design", design}, {"sweep", {{"coupler", {"rigid", "flexible"}}}}, {"replicates", {{"count", 2}}}};
}

json effect_cell(const jobs::ResultTable& table, std::size_t row, const std::string& column) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), column);
  EXPECT_NE(found, table.columns.end()) << column;
  return table.rows.at(row).at(static_cast<std::size_t>(found - table.columns.begin()));
}

const std::string& peak() { return engine::metric_table()[0].key; }

TEST(Sensitivity, FindsTheOneParameterThatMatters) {
  const Ended ended = run_sensitivity(design_of("saltelli"));
  EXPECT_EQ(ended.results.rows.size(), 16U * 4 * 2 * 2);
  const auto table = calc_sensitivity(ended.sweep, ended.results, peak());
  ASSERT_EQ(table.rows.size(), 4U) << "two parameters, two couplers";
  for (std::size_t group = 0; group < 4; group += 2) {
    EXPECT_EQ(effect_cell(table, group, "parameter"), "restitution");
    EXPECT_EQ(effect_cell(table, group, "total"), 0.0);
    EXPECT_EQ(effect_cell(table, group, "noise"), 0.0);
    EXPECT_EQ(effect_cell(table, group, "blocks"), 16);
    // All of the variance, in each of its samples; those of 16 blocks differ by 1.96 / 4 of a mean at most.
    EXPECT_EQ(effect_cell(table, group + 1, "parameter"), "crank_velocity_rad_s");
    EXPECT_NEAR(effect_cell(table, group + 1, "total").get<double>(), 1.0, 0.25);
    EXPECT_GT(effect_cell(table, group + 1, "first_order_high").get<double>(), 1.0);
    EXPECT_LT(effect_cell(table, group + 1, "first_order_low").get<double>(), 1.0);
  }
  EXPECT_EQ(effect_cell(table, 0, "coupler"), "rigid");
  EXPECT_EQ(effect_cell(table, 2, "coupler"), "flexible");
}

// Along the grid of 4 levels the effect of the speed v is (sqrt(1000 (v + 2/3 5)) - sqrt(1000 v)) / (2/3)
// with v = 4 or 5.667.
TEST(Sensitivity, HasTheElementaryEffectsOfTheWholeRange) {
  const Ended ended = run_sensitivity(design_of("morris"));
  const auto table = calc_sensitivity(ended.sweep, ended.results, peak());
  ASSERT_EQ(table.rows.size(), 4U);
  EXPECT_EQ(effect_cell(table, 0, "effect_size"), 0.0);
  const auto effect = [](double v) { return 1.5 * (std::sqrt(1e3 * (v + 10.0 / 3.0)) - std::sqrt(1e3 * v)); };
  const double size = effect_cell(table, 1, "effect_size");
  EXPECT_LE(size, effect(4.0) * (1 + 1e-6));
  EXPECT_GE(size, effect(4.0 + 5.0 / 3.0) * (1 - 1e-6));
  EXPECT_EQ(effect_cell(table, 1, "effect_mean"), size);
  EXPECT_EQ(effect_cell(table, 1, "metric"), peak());
}

// The grid has four levels, of which two fall on one value here and there. The metric is linear in the numbers of these values.
TEST(Sensitivity, HasTheElementaryEffectsOfAList) {
  ordered_json request = design_of("morris");
  for (const json& speeds : {json{4, 9}, json{4, 6.25, 9}}) {
    request["design"]["over"]["crank_velocity_rad_s"] = speeds;
    const Ended ended = run_sensitivity(request);
    const auto table = calc_sensitivity(ended.sweep, ended.results, peak());
    EXPECT_NEAR(effect_cell(table, 1, "effect_size").get<double>(), std::sqrt(9e3) - std::sqrt(4e3), 1e-3);
    EXPECT_NEAR(effect_cell(table, 1, "effect_deviation").get<double>(), 0.0, 1e-3);
  }
}

// Rounded to whole numbers, the step of one trajectory is 0 with the first seed, and of both with the other.
TEST(Sensitivity, HasNoEffectsOfFewerThanTwoSteps) {
  ordered_json request = ordered_json::parse(R"({"design": {"type": "morris", "trajectories": 2, "levels": 6,
      "over": {"radial_levels": {"from": 1, "to": 2, "scale": "log"}}}})");
  for (const int seed : {1, 9}) {
    request["design"]["seed"] = seed;
    const Ended ended = run_sensitivity(request);
    const auto table = calc_sensitivity(ended.sweep, ended.results, peak());
    ASSERT_EQ(table.rows.size(), 1U);
    EXPECT_EQ(effect_cell(table, 0, "blocks"), 2) << seed;
    for (const char* const column : {"effect_mean", "effect_size", "effect_size_low", "effect_deviation"})
      EXPECT_EQ(effect_cell(table, 0, column), nullptr) << seed;
  }
}

// Replicates of some points alone: the others' rows are not taken for theirs.
TEST(Sensitivity, KnowsWhichPointsHaveReplicates) {
  ordered_json request = design_of("saltelli");
  request.erase("sweep");
  request["design"]["over"] = {{"coupler", {"rigid", "flexible"}}, {"crank_velocity_rad_s", {{"from", 4}, {"to", 9}}}};
  request.erase("replicates");
  const Ended plain = run_sensitivity(request);
  request["replicates"] = {{"count", 3}, {"only", {{"coupler", {"flexible"}}}}};
  const Ended some = run_sensitivity(request);
  EXPECT_GT(some.results.rows.size(), plain.results.rows.size());
  const auto expected = calc_sensitivity(plain.sweep, plain.results, peak());
  const auto table = calc_sensitivity(some.sweep, some.results, peak());
  ASSERT_EQ(table.rows.size(), expected.rows.size());
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    for (const char* const column : {"first_order", "total", "total_low", "mean", "blocks"})
      EXPECT_EQ(effect_cell(table, row, column), effect_cell(expected, row, column)) << column;
}

// Where nothing but scatter is, all of the variance of single runs lies between replicates.
TEST(Sensitivity, TakesScatterForNoise) {
  Ended ended = run_sensitivity(design_of("saltelli"));
  const auto metric = static_cast<std::size_t>(
      std::find(ended.results.columns.begin(), ended.results.columns.end(), peak()) - ended.results.columns.begin());
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  for (auto& row : ended.results.rows) row.at(metric) = normal(generator);
  const auto table = calc_sensitivity(ended.sweep, ended.results, peak());
  for (std::size_t row = 0; row < table.rows.size(); ++row) EXPECT_GT(effect_cell(table, row, "noise").get<double>(), 0.75);
}

// The fake engine fails at a restitution of 0.5: of those blocks nothing is used.
TEST(Sensitivity, LeavesOutBlocksWithoutValues) {
  ordered_json request = design_of("saltelli");
  request["design"]["over"]["restitution"] = {0.5, 0.6, 0.7, 0.8, 0.9, 0.95};
  const Ended ended = run_sensitivity(request);
  const auto table = calc_sensitivity(ended.sweep, ended.results, peak());
  const int missing = effect_cell(table, 1, "blocks_missing");
  EXPECT_GT(missing, 0);
  EXPECT_EQ(effect_cell(table, 1, "blocks").get<int>() + missing, 16);
  EXPECT_GT(effect_cell(table, 1, "total").get<double>(), 0.5);
}

TEST(Sensitivity, NeedsItsDesignAndAMetric) {
  const Ended ended = run_sensitivity({{"sweep", {{"crank_velocity_rad_s", {5, 6}}}}});
  EXPECT_THROW((void)calc_sensitivity(ended.sweep, ended.results, peak()), jobs::WrongState);
  EXPECT_THROW((void)calc_sensitivity(ended.sweep, ended.results, "state"), jobs::InvalidRequest);
}

std::set<std::string> sensitivity_faults_of(const ordered_json& design) {
  const TemporaryStore store;
  FakeEngine engine;
  jobs::Service service(options_of(store, engine, 1));
  try {
    (void)service.submit_sweep({{"design", design}});
  } catch (const jobs::InvalidRequest& invalid) {
    std::set<std::string> pointers;
    for (const jobs::Fault& fault : invalid.faults()) pointers.insert(fault.pointer);
    return pointers;
  }
  return {};
}

TEST(Sensitivity, HasDesignsThatRefuseWhatTheyDoNotKnow) {
  const ordered_json over{{"restitution", {{"from", 0.6}, {"to", 0.9}}}};
  EXPECT_EQ(sensitivity_faults_of({{"type", "morris"}, {"trajectories", 1}, {"levels", 3}, {"over", over}}),
      (std::set<std::string>{"/design/trajectories", "/design/levels"}));
  EXPECT_EQ(sensitivity_faults_of({{"type", "saltelli"}, {"seed", -1}, {"levels", 4}, {"over", over}}),
      (std::set<std::string>{"/design/count", "/design/seed", "/design/levels"}));
  EXPECT_EQ(sensitivity_faults_of({{"type", "saltelli"}, {"count", 5000}, {"over", over}}),
            (std::set<std::string>{"/design"}))
      << "15,000 jobs";
}

// A described linkage names its metrics by its joints; what was swept, and what tells jobs apart, is none.
TEST(Metrics, AreThoseOfTheStudysLinkages) {
  const jobs::ResultTable described{.columns = {"job_id", "state", "replicate", "clearance_mm",
                                                "linkage.bodies.rod.mass_kg", "peak_pin_force_n", "steps"},
                                    .rows = {}};
  EXPECT_EQ(jobs::choose_metric(described, ""), "peak_pin_force_n");
  EXPECT_EQ(jobs::choose_metric(described, "steps"), "steps");
  EXPECT_EQ(jobs::find_metric(described, "steps"), 6U);
  const jobs::ResultTable rpsup{.columns = {"job_id", "state", "amplification", peak()}, .rows = {}};
  EXPECT_EQ(jobs::choose_metric(rpsup, ""), peak());
  const jobs::ResultTable worn{.columns = {"job_id", "state", "wear_depth_um", "amplification"}, .rows = {}};
  EXPECT_EQ(jobs::choose_metric(worn, ""), "amplification");
  for (const std::string& none : {std::string("state"), std::string("clearance_mm"),
                                  std::string("linkage.bodies.rod.mass_kg"), peak()}) {
    try {
      (void)jobs::choose_metric(described, none);
      ADD_FAILURE() << none;
    } catch (const jobs::InvalidRequest& invalid) {
      EXPECT_EQ(invalid.faults().at(0).pointer, "/metric");
      EXPECT_NE(
          invalid.faults().at(0).detail.find("is no metric of this sweep, which has peak_pin_force_n, steps"),
          std::string::npos);
    }
  }
}

}  // namespace
}  // namespace jobs_tests
