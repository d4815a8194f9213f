// SPDX-License-Identifier: Apache-2.0
// Sweeps over numbers inside the description of a linkage.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/base/errors.h"
#include "jobs/requests/expand.h"
#include "jobs/requests/extend_request.h"
#include "jobs/requests/metric_keys.h"
#include "jobs/results/table_groups.h"
#include "jobs/service.h"
#include "tests/jobs/request_support.h"
#include "tests/jobs/requests/example_linkage.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using nlohmann::json;

TEST(LinkageSweep, GoesOverNumbersInsideADescription) {
  nlohmann::ordered_json request{{"parameters", example("slider_crank")},
                                 {"sweep", {{"linkage.joints.crank_pin.clearance.clearance_mm", {0.05, 0.1}},
                                            {"linkage.bodies.rod.mass_kg", {0.2, 0.3}},
                                            {"linkage.joints.slider_pin.clearance.restitution", {0.8}}}}};
  const jobs::SweepPlan plan = jobs::plan_sweep(request, 100);
  ASSERT_EQ(plan.jobs.size(), 4U);
  const json first = json::parse(plan.jobs[1].parameters);
  EXPECT_EQ(first.at("linkage").at("bodies").at("rod").at("mass_kg"), 0.3);
  EXPECT_EQ(first.at("linkage").at("joints").at("slider_pin").at("clearance").at("restitution"), 0.8);
  EXPECT_EQ(plan.jobs[1].swept, "[0.05,0.3,0.8]");
}

TEST(LinkageSweep, HasCasesOfNumbersInsideADescription) {
  const std::string path = "linkage.bodies.rod.mass_kg";
  const auto request_of = [](const nlohmann::ordered_json& cases) {
    return nlohmann::ordered_json{{"parameters", example("slider_crank")}, {"cases", cases}};
  };
  const jobs::SweepPlan plan =
      jobs::plan_sweep(request_of({{{path, 0.2}, {"friction", "none"}}, {{path, 0.3}}}), 100);
  ASSERT_EQ(plan.jobs.size(), 2U);
  const json second = json::parse(plan.jobs[1].parameters);
  EXPECT_EQ(second.at("linkage").at("bodies").at("rod").at("mass_kg"), 0.3);
  EXPECT_EQ(plan.jobs[0].swept, R"([0.2,"none"])");
  const auto pointer_of = [&](const nlohmann::ordered_json& one_case) -> std::string {
    try {
      (void)jobs::plan_sweep(request_of(nlohmann::ordered_json::array({one_case})), 100);
    } catch (const jobs::InvalidRequest& invalid) {
      return invalid.faults().front().pointer;
    }
    return "none";
  };
  EXPECT_EQ(pointer_of({{path, "heavy"}}), "/cases/0/" + path);
  EXPECT_EQ(pointer_of({{path, -1}}), "/cases/0/" + path);
  EXPECT_EQ(pointer_of({{"linkage.bodies.rood.mass_kg", 1}}), "/cases/0/linkage.bodies.rood.mass_kg");
  EXPECT_EQ(pointer_of({{"linkage.bodies.rod.inertia_kg_m2.7", 1}}),
            "/cases/0/linkage.bodies.rod.inertia_kg_m2.7");
}

TEST(LinkageSweep, IsExtendedByNumbersInsideADescription) {
  const std::string path = "linkage.bodies.rod.mass_kg";
  const nlohmann::ordered_json request{{"parameters", example("slider_crank")}, {"cases", {{{path, 0.2}}}}};
  EXPECT_EQ(jobs::plan_extension(request, {{"cases", {{{path, 0.25}}}}}, 100).jobs.size(), 1U);
  EXPECT_EQ(pointers_of(faults_of([&] {
              (void)jobs::plan_extension(request, {{"cases", {{{path, "heavy"}}}}}, 100);
            })),
            std::vector<std::string>{"/cases/0/" + path});
}

// Rows of one point are known by the values that they show.
TEST(LinkageSweep, ShowsDifferentLinkagesDifferently) {
  json light = example("slider_crank").at("linkage");
  light.erase("name");
  json heavy = light, called = light, namesake = heavy;
  heavy["bodies"]["rod"]["mass_kg"] = 0.3;
  called["name"] = "described #2";
  namesake["name"] = "rpsup";
  const std::string path = "linkage.bodies.rod.mass_kg";
  const auto shown = [](const nlohmann::ordered_json& request) {
    std::vector<std::string> swept;
    for (const jobs::PlannedJob& job : jobs::plan_sweep(request, 100).jobs) swept.push_back(job.swept);
    return swept;
  };
  const json cases{{{"linkage", light}},  {{"linkage", heavy}},    {{"linkage", light}, {"friction", "none"}},
                   {{"linkage", called}}, {{"linkage", namesake}}, {{"linkage", "rpsup"}}};
  EXPECT_EQ(shown({{"cases", cases}}),
            (std::vector<std::string>{R"(["described","lugre"])", R"(["described #2","lugre"])",
                                      R"(["described","none"])", R"(["described #2 #2","lugre"])",
                                      R"(["rpsup #2","lugre"])", R"(["rpsup","lugre"])"}));
  json many = json::array();
  for (int k = 0; k < 200; ++k) {
    light["bodies"]["rod"]["mass_kg"] = 0.2 + 1e-5 * k;
    many.push_back({{"linkage", light}});
  }
  EXPECT_EQ(jobs::plan_sweep({{"cases", many}}, 10'000).jobs.back().swept, R"(["described #200"])");
  EXPECT_EQ(shown({{"cases", {{{"linkage", light}}}}, {"sweep", {{path, {0.2, 0.3}}}}}),
            (std::vector<std::string>{R"([0.2,"described"])", R"([0.3,"described"])"}))
      << "one description, with two of its numbers";
}

std::size_t place_of(const std::string& column, const jobs::ResultTable& table) {
  return static_cast<std::size_t>(std::ranges::find(table.columns, column) - table.columns.begin());
}

TEST(LinkageSweep, IsComputedAndTabulated) {
  const TemporaryStore store;
  jobs::Service service(options_of(store, 1));
  json parameters = example("slider_crank");
  parameters["duration_s"] = 0.01;
  const std::string path = "linkage.joints.crank_pin.clearance.clearance_mm";
  const auto sweep = service.submit_sweep({{"parameters", parameters}, {"sweep", {{path, {0.05, 0.1}}}}});
  const std::string id = sweep.at("id");
  ASSERT_TRUE(service.wait_for_sweep(id, std::chrono::minutes(2)));
  const auto table = service.find_results(id);
  ASSERT_TRUE(table);
  ASSERT_EQ(table->rows.size(), 2U);
  for (const std::size_t row : {0U, 1U}) {
    EXPECT_EQ(table->rows[row].at(place_of("state", *table)), "succeeded");
    EXPECT_EQ(table->rows[row].at(place_of(path, *table)), row == 0 ? 0.05 : 0.1);
    EXPECT_GT(table->rows[row].at(place_of("peak_guide_acceleration_whole_run_m_s2", *table)).get<double>(), 0.0);
  }
  EXPECT_EQ(place_of("peak_slider_acceleration_m_s2", *table), table->columns.size())
      << "a metric of another linkage";
}

// A joint that is ideal in the description has contact in some jobs.
TEST(LinkageSweep, HasTheMetricsOfClearanceThatItSweeps) {
  json parameters = example("slider_crank");
  const std::string path = "linkage.joints.crank_pin.clearance.clearance_mm", metric = "peak_crank_pin_contact_force_n";
  parameters["linkage"]["joints"]["crank_pin"]["clearance"]["clearance_mm"] = 0;
  const auto has_metric = [&](const json& varied) {
    json request = varied;
    request["parameters"] = parameters;
    const auto keys = jobs::metric_keys_of(request);
    EXPECT_EQ(std::ranges::count(keys, "peak_crank_pin_reaction_n"), 1);
    return std::ranges::find(keys, metric) != keys.end();
  };
  const json span{{"from", 0}, {"to", 0.1}, {"count", 2}};
  EXPECT_FALSE(has_metric(json::object()));
  EXPECT_FALSE(has_metric({{"sweep", {{path, {0}}}}}));
  EXPECT_FALSE(has_metric({{"sweep", {{"linkage.joints.no_pin.clearance.clearance_mm", {0.1}}}}}));
  EXPECT_TRUE(has_metric({{"sweep", {{path, {0, 0.1}}}}}));
  EXPECT_TRUE(has_metric({{"sweep", {{path, span}}}}));
  EXPECT_TRUE(has_metric({{"over", {{path, span}}}}));
  EXPECT_TRUE(has_metric({{"design", {{"type", "zip"}, {"over", {{path, {0, 0.1}}}}}}}));
  EXPECT_TRUE(has_metric({{"cases", {{{path, 0}}, {{path, 0.1}}}}}));
  EXPECT_TRUE(has_metric({{"cases", {{{"linkage", parameters.at("linkage")}}}}, {"sweep", {{path, {0, 0.1}}}}}));
}

// Mean and largest value over the replicates, against those of the rows themselves.
void expect_statistics_of(const jobs::ResultTable& table, const std::string& metric) {
  const std::size_t column = place_of(metric, table);
  ASSERT_LT(column, table.columns.size());
  double sum = 0.0, most = -1e300;
  for (const auto& row : table.rows) {
    sum += row.at(column).get<double>();
    most = std::max(most, row.at(column).get<double>());
  }
  ASSERT_EQ(table.replicates.size(), table.rows.size());
  const double mean = sum / static_cast<double>(table.rows.size());
  EXPECT_NEAR(table.replicates[0].mean.value(), mean, 1e-9 * most) << metric;
  EXPECT_EQ(table.replicates[0].max.value(), most) << metric;
}

TEST(LinkageSweep, ComparesReplicatesByTheMetricThatIsChosen) {
  const TemporaryStore store;
  jobs::Service service(options_of(store, 1));
  json parameters = example("slider_crank");
  parameters["duration_s"] = 0.01;
  parameters["run_up_s"] = 0;
  const std::string metric = "peak_crank_pin_contact_force_n";
  const json replicates{{"count", 3}, {"perturbation", 1e-3}};
  const std::string id =
      service.submit_sweep({{"parameters", parameters}, {"replicates", replicates}}).at("id");
  ASSERT_TRUE(service.wait_for_sweep(id, std::chrono::minutes(2)));
  const auto unasked = service.find_results(id);
  const std::string by_default = jobs::choose_free_metric(*service.find_sweep(id), *unasked, "");
  EXPECT_NE(by_default, unasked->columns.at(3))
      << "the first one, behind job_id, state, replicate, is driven";
  expect_statistics_of(*unasked, by_default);
  expect_statistics_of(*service.find_results(id, {.metric = metric}), metric);
  EXPECT_EQ(pointers_of(faults_of([&] { (void)service.find_results(id, {.metric = "no_metric"}); })),
            std::vector<std::string>{"/metric"});
}

// The bore is too narrow for the default clearance, which no job of these has.
TEST(LinkageSweep, JudgesADescriptionWithTheValuesOfItsJobs) {
  json parameters = example("slider_crank");
  parameters.erase("clearance_mm");
  parameters["linkage"]["joints"]["slider_pin"]["clearance"]["bearing_radius_mm"] = 0.2;
  const auto faults = [&](const json& varied) {
    json request = varied;
    request["parameters"] = parameters;
    return pointers_of(faults_of([&] { (void)jobs::plan_sweep(request, 100); }));
  };
  const std::vector<std::string> none;
  EXPECT_EQ(faults({{"sweep", {{"clearance_mm", {0.05, 0.1}}}}}), none);
  EXPECT_EQ(faults({{"sweep", {{"clearance_mm", {{"from", 0.05}, {"to", 0.1}, {"count", 3}}}}}}), none);
  EXPECT_EQ(faults({{"cases", {{{"clearance_mm", 0.05}}, {{"clearance_mm", 0.1}}}}}), none);
  EXPECT_EQ(faults({{"design", {{"type", "latin_hypercube"}, {"count", 4},
                                {"over", {{"clearance_mm", {{"from", 0.05}, {"to", 0.1}}}}}}}}), none);
  EXPECT_NE(faults(json::object()), none);
  EXPECT_NE(faults({{"sweep", {{"clearance_mm", {0.05, 0.25}}}}}), none);
}

TEST(LinkageSweep, PerturbsJointsWithAStiffnessOfTheirOwn) {
  json parameters = example("slider_crank");
  json& clearance = parameters["linkage"]["joints"]["crank_pin"]["clearance"];
  clearance["contact_stiffness_scale"] = 2.0;
  const jobs::SweepPlan plan = jobs::plan_sweep(
      {{"parameters", parameters}, {"replicates", {{"count", 3}, {"perturbation", 1e-4}, {"seed", 7}}}}, 100);
  ASSERT_EQ(plan.jobs.size(), 3U);
  for (std::uint64_t k = 0; k < 3; ++k) {
    const json run = json::parse(plan.jobs[k].parameters);
    EXPECT_EQ(run["linkage"]["joints"]["crank_pin"]["clearance"]["contact_stiffness_scale"],
              2.0 * jobs::replicate_factor(7, k, 1e-4));
  }
}

TEST(LinkageSweep, RefusesWhatIsNoPlaceOrNoValueOfTheDescription) {
  const auto pointers = [](const json& axes, const json& parameters) {
    return pointers_of(faults_of([&] {
      (void)jobs::plan_sweep({{"parameters", parameters}, {"sweep", axes}}, 100);
    }));
  };
  const json parameters = example("slider_crank");
  EXPECT_EQ(pointers({{"linkage.bodies.pod.mass_kg", {1, 2}}}, parameters),
            std::vector<std::string>{"/sweep/linkage.bodies.pod.mass_kg"});
  EXPECT_EQ(pointers({{"linkage.bodies.rod.mass_kg", {1, 2}}}, json::object()),
            std::vector<std::string>{"/sweep/linkage.bodies.rod.mass_kg"});
  EXPECT_EQ(pointers({{"linkage.bodies.rod.mass_kg", {1, "heavy"}}}, parameters),
            std::vector<std::string>{"/sweep/linkage.bodies.rod.mass_kg/1"});
  EXPECT_EQ(pointers({{"linkage.bodies.rod.mass_kg", {1, -1}}}, parameters),
            std::vector<std::string>{"/sweep/linkage.bodies.rod.mass_kg"});
  EXPECT_EQ(pointers({{"linkage", {"rpsup"}}}, json::object()), std::vector<std::string>{"/sweep/linkage"});
  json with_centre = parameters;
  with_centre["linkage"]["bodies"]["rod"] = {
      {"mass_kg", 0.2}, {"centre_of_mass_m", {0.1, 0, 0}}, {"inertia_kg_m2", {1e-5, 1e-3, 1e-3}}};
  EXPECT_EQ(pointers({{"linkage.bodies.rod.centre_of_mass_m.0", {0.1, 0.2}}}, with_centre),
            std::vector<std::string>{});
  for (const std::string place : {"3", "00", "-", "x", "123456789012345678901", ""}) {
    const std::string path = "linkage.bodies.rod.centre_of_mass_m." + place;
    EXPECT_EQ(pointers({{path, {1, 2}}}, with_centre), std::vector<std::string>{"/sweep/" + path});
  }
}

// A list is refused as a whole; its fault stands where the element came from.
TEST(LinkageSweep, NamesThePlaceOfAnElementOfAList) {
  const json parameters = example("slider_crank");
  const std::string path = "linkage.bodies.rod.centre_of_mass_m.0";
  const auto pointers = [&](const char* where, const json& varied) {
    return pointers_of(faults_of([&] { (void)jobs::plan_sweep({{"parameters", parameters}, {where, varied}}, 100); }));
  };
  EXPECT_EQ(pointers("sweep", {{path, {0.1, 5000}}}), std::vector<std::string>{"/sweep/" + path});
  EXPECT_EQ(pointers("design", {{"type", "zip"}, {"over", {{path, {0.1, 5000}}}}}),
            std::vector<std::string>{"/design/over/" + path});
  EXPECT_EQ(pointers("cases", {{{path, 0.1}}, {{path, 5000}}}), std::vector<std::string>{"/cases/1/" + path});
}

// Where the description has no value of its own, or none that is a number, the design has no centre.
TEST(LinkageSweep, NeedsACentreForOneAtATime) {
  const auto pointers = [](const std::string& path, const json& centre) {
    const json span{{"from", 0.1}, {"to", 0.2}, {"count", 2}};
    nlohmann::ordered_json request{{"parameters", example("slider_crank")},
                                   {"design", {{"type", "one_at_a_time"}, {"over", {{path, span}}}}}};
    if (!centre.is_null()) request["design"]["centre"] = {{path, centre}};
    return pointers_of(faults_of([&] { (void)jobs::plan_sweep(request, 100); }));
  };
  EXPECT_EQ(pointers("linkage.bodies.rod.mass_kg", nullptr), std::vector<std::string>{});
  EXPECT_EQ(pointers("linkage.joints.slider_pin.clearance.restitution", nullptr),
            std::vector<std::string>{"/design/centre"});
  EXPECT_EQ(pointers("linkage.joints.slider_pin.clearance.restitution", 0.8), std::vector<std::string>{});
  EXPECT_EQ(pointers("crank_length_m", nullptr), std::vector<std::string>{"/design/centre"})
      << "a described linkage has no such parameter";
  EXPECT_EQ(pointers("linkage.bodies.rod", nullptr), std::vector<std::string>{"/design/centre"});
  EXPECT_EQ(pointers("linkage.bodies.rod.mass_kg.123456789012345678901", nullptr),
            std::vector<std::string>{"/design/centre"});
}

}  // namespace
}  // namespace jobs_tests
