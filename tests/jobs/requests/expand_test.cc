// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "jobs/base/content_id.h"
#include "jobs/base/program_info.h"
#include "jobs/requests/expand.h"
#include "jobs/requests/parameters.h"
#include "tests/jobs/request_support.h"

namespace jobs_tests {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxExpandedJobs = 10'000;

jobs::SweepPlan expanded_plan_of(const std::string& request) {
  return jobs::plan_sweep(request_of(request), kMaxExpandedJobs);
}

std::vector<std::string> swept_values(const jobs::SweepPlan& plan) {
  std::vector<std::string> values;
  for (const jobs::PlannedJob& job : plan.jobs) values.push_back(job.swept);
  return values;
}

using Strings = std::vector<std::string>;

TEST(PlanSweep, TakesNamesOfUpTo200Bytes) {
  const auto named = [](std::size_t bytes) {
    return json{{"sweep", {{"clearance_mm", {0.1}}}}, {"name", std::string(bytes, 'x')}}.dump();
  };
  EXPECT_EQ(expanded_plan_of(named(200)).name, std::string(200, 'x'));
  EXPECT_THROW((void)expanded_plan_of(named(201)), jobs::InvalidRequest);
}

TEST(PlanSweep, MultipliesAxesInTheirOrderLastFastest) {
  // crank_velocity_rad_s comes before clearance_mm in the alphabet of neither the request nor the sorted
  // keys.
  const auto plan = expanded_plan_of(
      R"({"name": "n", "sweep": {"crank_velocity_rad_s": [5, 10], "coupler": ["flexible", "rigid"],
         "clearance_mm": [0, 0.25, 0.5]}})");
  EXPECT_EQ(plan.name, "n");
  EXPECT_EQ(plan.swept, (Strings{"crank_velocity_rad_s", "coupler", "clearance_mm"}));
  EXPECT_EQ(swept_values(plan),
            (Strings{R"([5.0,"flexible",0.0])", R"([5.0,"flexible",0.25])", R"([5.0,"flexible",0.5])",
                     R"([5.0,"rigid",0.0])", R"([5.0,"rigid",0.25])", R"([5.0,"rigid",0.5])",
                     R"([10.0,"flexible",0.0])", R"([10.0,"flexible",0.25])", R"([10.0,"flexible",0.5])",
                     R"([10.0,"rigid",0.0])", R"([10.0,"rigid",0.25])", R"([10.0,"rigid",0.5])"}));
  EXPECT_EQ(plan.jobs[3].kind, "rigid, ideal");
}

TEST(PlanSweep, GivesEachJobItsWholeParameterSet) {
  const auto plan =
      plan_of(R"({"parameters": {"duration_s": 4, "links": {"1,3": {"inertia_kg_m2": [4e-6, 0.026, 0.026]}}},
                                "sweep": {"links.1,3.mass_kg": [0.3, 0.31], "clearance_mm": [0.5]}})");
  ASSERT_EQ(plan.jobs.size(), 2U);
  const json expected = jobs::complete_parameters(
      json_of(
          R"({"duration_s": 4, "clearance_mm": 0.5, "links": {"1,3": {"mass_kg": 0.31, "inertia_kg_m2": [4e-6,
             0.026, 0.026]}}})"),
      "");
  EXPECT_EQ(json::parse(plan.jobs[1].parameters), expected);
  EXPECT_EQ(plan.jobs[1].content_id, jobs::content_id(expected.dump(), jobs::kEngineVersion));
  EXPECT_EQ(plan.jobs[1].swept, "[0.31,0.5]");
}

TEST(PlanSweep, RunsThroughCasesOutermost) {
  const auto plan = plan_of(
      R"({"cases": [{"clearance_mm": 0, "coupler": "rigid"}, {"coupler": "flexible",
         "links": {"2,2": {"mass_kg": 0.2}}}],
                                "sweep": {"crank_velocity_rad_s": [5, 10]}})");
  EXPECT_EQ(plan.swept, (Strings{"crank_velocity_rad_s", "clearance_mm", "coupler", "links.2,2.mass_kg"}));
  // A case that leaves a key out has its default there.
  EXPECT_EQ(swept_values(plan), (Strings{R"([5.0,0.0,"rigid",0.107])", R"([10.0,0.0,"rigid",0.107])",
                                         R"([5.0,0.25,"flexible",0.2])", R"([10.0,0.25,"flexible",0.2])"}));
}

TEST(PlanSweep, OfNothingIsOneJobOfDefaults) {
  const auto plan = expanded_plan_of("{}");
  ASSERT_EQ(plan.jobs.size(), 1U);
  EXPECT_EQ(json::parse(plan.jobs[0].parameters), jobs::complete_parameters(json::object(), ""));
  EXPECT_FALSE(plan.replicated);
  EXPECT_TRUE(plan.reuse);
}

TEST(PlanSweep, SpacesLinearAndLogarithmicAxes) {
  EXPECT_EQ(
      swept_values(expanded_plan_of(R"({"sweep": {"clearance_mm": {"from": 0.1, "to": 0.5, "count": 5}}})")),
      (Strings{"[0.1]", "[0.2]", "[0.3]", "[0.4]", "[0.5]"}));
  EXPECT_EQ(
      swept_values(expanded_plan_of(
          R"({"sweep": {"crank_velocity_rad_s": {"from": 10, "to": -10, "count": 3, "scale": "linear"}}})")),
      (Strings{"[10.0]", "[0.0]", "[-10.0]"}));
  EXPECT_EQ(
      swept_values(expanded_plan_of(R"({"sweep": {"rigid_elements": {"from": 2, "to": 8, "count": 4}}})")),
      (Strings{"[2]", "[4]", "[6]", "[8]"}));
  EXPECT_EQ(
      swept_values(expanded_plan_of(R"({"sweep": {"clearance_mm": {"from": 0.3, "to": 0.3, "count": 1}}})")),
      (Strings{"[0.3]"}));
  // Three times 0.1 over three is 0.10000000000000002; the ends are what was written all the same.
  EXPECT_EQ(
      swept_values(expanded_plan_of(R"({"sweep": {"clearance_mm": {"from": 0.4, "to": 0.1, "count": 4}}})"))
          .back(),
      "[0.1]");
  const auto plan = expanded_plan_of(
      R"({"sweep": {"relative_tolerance": {"from": 1e-9, "to": 1e-3, "count": 4, "scale": "log"}}})");
  const double expected[] = {1e-9, 1e-7, 1e-5, 1e-3};
  ASSERT_EQ(plan.jobs.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(json::parse(plan.jobs[k].swept)[0].get<double>(), expected[k]) << k;
}

std::vector<double> range_values(const std::string& range) {
  std::vector<double> values;
  for (const auto& job : expanded_plan_of(R"({"sweep": {"gravity_m_s2": )" + range + "}}").jobs)
    values.push_back(json::parse(job.swept)[0].get<double>());
  return values;
}

// A decimal of integers, m 10^-places, is read from its text.
TEST(PlanSweep, HasRoundNumbersInARange) {
  for (int places = 0; places <= 4; ++places) {
    for (const int first : {-300, -7, 0, 1, 12}) {
      for (const int step : {1, 3, 7}) {
        for (const int count : {3, 7, 31}) {
          const auto text = [&](int k) { return std::to_string(first + k * step) + "e-" + std::to_string(places); };
          if (std::abs(std::stod(text(count - 1))) > 1000.0 || std::abs(std::stod(text(0))) > 1000.0) continue;
          const auto values = range_values(R"({"from": )" + text(0) + R"(, "to": )" + text(count - 1) +
                                           R"(, "count": )" + std::to_string(count) + "}");
          ASSERT_EQ(values.size(), static_cast<std::size_t>(count));
          for (int k = 0; k < count; ++k) ASSERT_EQ(values[static_cast<std::size_t>(k)], std::stod(text(k))) << text(0) << ' ' << text(k);
        }
      }
    }
  }
}

TEST(PlanSweep, HasDecimalsOfTwelveDigitsWhereARangeIsNotRound) {
  EXPECT_EQ(range_values(R"({"from": 0, "to": 2, "count": 4})"), (std::vector{0.0, 0.666666666667, 1.33333333333, 2.0}));
  EXPECT_EQ(range_values(R"({"from": 5, "to": 15, "count": 3, "scale": "log"})"), (std::vector{5.0, 8.66025403784, 15.0}));
  EXPECT_EQ(range_values(R"({"from": 0.001, "to": 100, "count": 6, "scale": "log"})"), (std::vector{0.001, 0.01, 0.1, 1.0, 10.0, 100.0}));
  EXPECT_EQ(range_values(R"({"from": 64, "to": 0.125, "count": 10, "scale": "log"})"), (std::vector{64.0, 32.0, 16.0, 8.0, 4.0, 2.0, 1.0, 0.5, 0.25, 0.125}));
  // Ends have all their digits.
  EXPECT_EQ(range_values(R"({"from": 0.1234567890123456, "to": 1.2345678901234567, "count": 2})"), (std::vector{0.1234567890123456, 1.2345678901234567}));
}

// Twelve digits would make 1, 1, 1, 1.000000000001 of these.
TEST(PlanSweep, KeepsTheStepsOfANarrowRange) {
  for (const char* const scale : {"linear", "log"}) {
    const auto values = range_values(R"({"from": 1, "to": 1.000000000001, "count": 4, "scale": ")" + std::string(scale) + "\"}");
    ASSERT_EQ(values.size(), 4U);
    for (std::size_t k = 1; k < 4; ++k) EXPECT_NEAR(values[k] - values[k - 1], 1e-12 / 3.0, 4e-16) << scale;
  }
}

// The levels of Morris' design are thirds of the range.
TEST(PlanSweep, HasRoundNumbersInADesign) {
  std::set<double> levels;
  for (const auto& job : expanded_plan_of(R"({"design": {"type": "morris", "trajectories": 20, "over": {"gravity_m_s2": {"from": 0, "to": 0.9}}}})").jobs)
    levels.insert(json::parse(job.swept)[0].get<double>());
  EXPECT_EQ(levels, (std::set{0.0, 0.3, 0.6, 0.9}));
}

/// The numbers of the bits that are set, from 1: a subset of 1 .. 6.
std::vector<int> subset(int bits) {
  std::vector<int> members;
  for (int i = 0; i < 6; ++i) {
    if ((bits >> i & 1) != 0) members.push_back(i + 1);
  }
  return members;
}

RC_GTEST_PROP(PlanSweep, HasTheProductOfTheAxesAsCountAndEveryCombinationOnce, ()) {
  const auto speeds = subset(*rc::gen::inRange(1, 64));
  const auto levels = subset(*rc::gen::inRange(1, 64));
  const int replicates = *rc::gen::inRange(1, 4);
  const nlohmann::ordered_json request{
      {"sweep", {{"radial_levels", levels}, {"crank_velocity_rad_s", speeds}}},
      {"replicates", {{"count", replicates}}}};
  const auto plan = jobs::plan_sweep(request, kMaxExpandedJobs);
  RC_ASSERT(plan.jobs.size() == speeds.size() * levels.size() * static_cast<std::size_t>(replicates));
  std::size_t next = 0;
  for (const int level : levels) {
    for (const int speed : speeds) {
      for (int k = 0; k < replicates; ++k, ++next) {
        RC_ASSERT(json::parse(plan.jobs[next].swept) == json::array({level, speed}));
        RC_ASSERT(plan.jobs[next].replicate == static_cast<std::uint64_t>(k));
      }
    }
  }
  std::set<std::string> contents;
  for (const auto& job : plan.jobs) contents.insert(job.content_id);
  RC_ASSERT(contents.size() == plan.jobs.size());
}

// The first numbers of splitmix64 from the seed 1234567, as its author's program prints them.
TEST(ReplicateFactor, ComesFromSplitmix64) {
  const std::uint64_t published[] = {6457827717110365317U, 3203168211198807973U, 9817491932198370423U};
  for (std::uint64_t k = 1; k <= 3; ++k) {
    const double u = 2.0 * (static_cast<double>(published[k - 1] >> 11U) / 9007199254740992.0) - 1.0;
    EXPECT_EQ(jobs::replicate_factor(1234567, k, 0.01), 1.0 + 0.01 * u);
  }
  EXPECT_EQ(jobs::replicate_factor(1234567, 0, 0.01), 1.0);
}

RC_GTEST_PROP(ReplicateFactor, StaysWithinThePerturbation, (std::uint64_t seed, std::uint64_t k)) {
  const double factor = jobs::replicate_factor(seed, k, 1e-3);
  RC_ASSERT(factor >= 1.0 - 1e-3 && factor <= 1.0 + 1e-3);
}

TEST(PlanSweep, RunsReplicatesOfEachPointInnermost) {
  const std::string request =
      R"({"parameters": {"contact_stiffness_scale": 2}, "sweep": {"clearance_mm": [0.25, 0.5]},
                                  "replicates": {"count": 3, "perturbation": 1e-4, "seed": 7}})";
  const auto plan = expanded_plan_of(request);
  ASSERT_EQ(plan.jobs.size(), 6U);
  EXPECT_TRUE(plan.replicated);
  for (std::size_t i = 0; i < 6; ++i) {
    const std::uint64_t k = i % 3;
    EXPECT_EQ(plan.jobs[i].replicate, k);
    EXPECT_EQ(plan.jobs[i].swept, i < 3 ? "[0.25]" : "[0.5]");
    EXPECT_EQ(json::parse(plan.jobs[i].parameters).at("contact_stiffness_scale"),
              2.0 * jobs::replicate_factor(7, k, 1e-4));
  }
  const auto again = expanded_plan_of(request);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(plan.jobs[i].content_id, again.jobs[i].content_id);
  EXPECT_EQ(plan.jobs[0].content_id,
            expanded_plan_of(R"({"parameters": {"contact_stiffness_scale": 2, "clearance_mm": 0.25}})")
                .jobs[0]
                .content_id);
}

TEST(PlanSweep, RunsAllReplicatesButTheFirstWithTighterTolerances) {
  const auto plan = expanded_plan_of(
      R"({"parameters": {"relative_tolerance": 1e-4, "absolute_tolerance": 1e-6},
         "replicates": {"count": 3, "tolerance_factor": 0.5}})");
  ASSERT_EQ(plan.jobs.size(), 3U);
  for (const std::size_t k : {0U, 1U, 2U}) {
    const json parameters = json::parse(plan.jobs[k].parameters);
    EXPECT_EQ(parameters.at("relative_tolerance"), k == 0 ? 1e-4 : 0.5e-4) << k;
    EXPECT_EQ(parameters.at("absolute_tolerance"), k == 0 ? 1e-6 : 0.5e-6) << k;
  }
}

// Rows are grouped by what is swept: the perturbation must not make a group of every row, not even where
// stiffness is swept.
TEST(PlanSweep, GivesReplicatesTheSweptValuesOfTheirPoint) {
  const auto plan = expanded_plan_of(
      R"({"sweep": {"contact_stiffness_scale": [0.5, 2.0]}, "replicates": {"count": 2,
         "perturbation": 0.1}})");
  ASSERT_EQ(plan.jobs.size(), 4U);
  EXPECT_EQ(plan.jobs[0].swept, "[0.5]");
  EXPECT_EQ(plan.jobs[1].swept, "[0.5]");
  EXPECT_EQ(plan.jobs[3].swept, "[2.0]");
  EXPECT_NE(plan.jobs[2].content_id, plan.jobs[3].content_id);
}

TEST(PlanJob, IsTheJobOfItsParameters) {
  const auto job = jobs::plan_job(json_of(R"({"coupler": "flexible"})"));
  EXPECT_EQ(job.content_id, expanded_plan_of(R"({"sweep": {"coupler": ["flexible"]}})").jobs[0].content_id);
  EXPECT_EQ(job.kind, "flexible, clearance");
  EXPECT_EQ(expanded_plan_of(R"({"sweep": {"crank": ["flexible"], "rod": ["flexible"]}})").jobs.front().kind,
            "rigid + crank + rod, clearance");
  EXPECT_FALSE(job.replicate.has_value());
}

}  // namespace
}  // namespace jobs_tests
