// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "jobs/requests/expand.h"
#include "jobs/statistics/unit_points.h"
#include "tests/jobs/request_support.h"

namespace jobs_tests {
namespace {

using nlohmann::json;
using Strings = std::vector<std::string>;

jobs::SweepPlan plan_of(const std::string& request) { return jobs::plan_sweep(request_of(request), 10'000); }

std::vector<json> rows_of(const std::string& request) {
  std::vector<json> rows;
  for (const jobs::PlannedJob& job : plan_of(request).jobs) rows.push_back(json::parse(job.swept));
  return rows;
}

Strings texts_of(const std::string& request) {
  Strings texts;
  for (const json& row : rows_of(request)) texts.push_back(row.dump());
  return texts;
}

TEST(Zip, TakesTheValuesOfAllListsTogether) {
  const std::string request =
      R"({"design": {"type": "zip", "over": {"crank_velocity_rad_s": [5, 10, 12], "coupler": ["rigid",
         "flexible", "rigid"],
                                                                      "clearance_mm": {"from": 0.1, "to": 0.3,
         "count": 3}}}})";
  EXPECT_EQ(plan_of(request).swept, (Strings{"crank_velocity_rad_s", "coupler", "clearance_mm"}));
  EXPECT_EQ(texts_of(request),
            (Strings{R"([5.0,"rigid",0.1])", R"([10.0,"flexible",0.2])", R"([12.0,"rigid",0.3])"}));
}

TEST(OneAtATime, HasTheCentreOnceAndThenEachParameterAlone) {
  EXPECT_EQ(texts_of(R"({"design": {"type": "one_at_a_time", "centre": {"clearance_mm": 0.2},
                                    "over": {"clearance_mm": {"from": 0.1, "to": 0.3, "count": 3},
                        "crank_velocity_rad_s": [5, 12], "coupler": ["rigid", "flexible"]}}})"),
            (Strings{R"([0.2,10.0,"rigid"])", R"([0.1,10.0,"rigid"])", R"([0.3,10.0,"rigid"])",
                     R"([0.2,5.0,"rigid"])", R"([0.2,12.0,"rigid"])", R"([0.2,10.0,"flexible"])"}));
}

// The centre takes the values that follow from the parameters of all points: a mass goes with its length.
TEST(OneAtATime, TakesItsCentreFromTheDefaultsOfTheRequest) {
  const auto rows = rows_of(
      R"({"parameters": {"crank_length_m": 0.1}, "design": {"type": "one_at_a_time",
         "over": {"links.1,1.mass_kg": [0.3]}}})");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_DOUBLE_EQ(rows[0][0].get<double>(), 0.471 / 2.0);
  EXPECT_EQ(rows[1][0], 0.3);
}

TEST(SampledDesign, StretchesTheUnitCubeOverTheRanges) {
  const auto rows = rows_of(
      R"({"design": {"type": "sobol", "count": 16, "over": {"crank_velocity_rad_s": {"from": -20, "to": 20},
                                "clearance_mm": {"from": 0.01, "to": 1, "scale": "log"},
         "links.1,3.mass_kg": {"from": 0.29, "to": 0.32}}}})");
  const auto unit = jobs::sobol_points(16, 3, {});
  ASSERT_EQ(rows.size(), 16U);
  EXPECT_EQ(rows[0], json::array({-20.0, 0.01, 0.29}));
  for (std::size_t k = 0; k < 16; ++k) {
    EXPECT_NEAR(rows[k][0].get<double>(), -20.0 + 40.0 * unit[k][0], 1e-13) << k;
    EXPECT_NEAR(std::log10(rows[k][1].get<double>()), -2.0 + 2.0 * unit[k][1], 1e-14) << k;
    EXPECT_NEAR(rows[k][2].get<double>(), 0.29 + 0.03 * unit[k][2], 1e-15) << k;
  }
}

/// Count of each value in a column.
std::map<std::string, int> counts_of(const std::vector<json>& rows, std::size_t column) {
  std::map<std::string, int> counts;
  for (const json& row : rows) ++counts[row[column].dump()];
  return counts;
}

TEST(SampledDesign, GivesEachIntegerAndEachWordItsShare) {
  const auto rows = rows_of(
      R"({"design": {"type": "latin_hypercube", "count": 42, "seed": 5, "over": {"clearance_mm": {"from": 0.1,
         "to": 0.5},
                                "rigid_elements": {"from": 2, "to": 8}, "coupler": ["rigid", "flexible"],
         "radial_elements": [36, 180, 720]}}})");
  EXPECT_EQ(counts_of(rows, 1), (std::map<std::string, int>{
                                    {"2", 6}, {"3", 6}, {"4", 6}, {"5", 6}, {"6", 6}, {"7", 6}, {"8", 6}}));
  EXPECT_EQ(counts_of(rows, 2), (std::map<std::string, int>{{"\"flexible\"", 21}, {"\"rigid\"", 21}}));
  EXPECT_EQ(counts_of(rows, 3), (std::map<std::string, int>{{"180", 14}, {"36", 14}, {"720", 14}}));
}

// With equal ratios, the integers of [2, 4), [4, 8), ... up to 64 have the same share, and the last one is
// met.
TEST(SampledDesign, SpreadsIntegersByRatios) {
  const auto rows = rows_of(
      R"({"design": {"type": "sobol", "count": 1024, "over": {"radial_elements": {"from": 4, "to": 31,
         "scale": "log"},
                                "clearance_mm": {"from": 0.1, "to": 0.5}}}})");
  std::map<int, int> octaves;
  std::set<int> values;
  for (const json& row : rows) {
    const int value = row[0].get<int>();
    values.insert(value);
    ++octaves[static_cast<int>(std::log2(value))];
  }
  // A value at the border of two octaves may be rounded to either side.
  for (const auto& [octave, count] : octaves) EXPECT_NEAR(count, 1024.0 / 3.0, 1.5) << octave;
  EXPECT_EQ(*values.begin(), 4);
  EXPECT_EQ(*values.rbegin(), 31);
  EXPECT_EQ(values.size(), 28U);
}

TEST(SampledDesign, IsThatOfItsSeed) {
  const auto with = [](const std::string& type, const std::string& seed) {
    return texts_of(R"({"design": {"type": ")" + type + R"(", "count": 8, )" + seed +
                    R"("over": {"clearance_mm": {"from": 0.1, "to": 0.5}}}})");
  };
  EXPECT_EQ(with("latin_hypercube", ""), with("latin_hypercube", R"("seed": 1, )"));
  EXPECT_NE(with("latin_hypercube", ""), with("latin_hypercube", R"("seed": 2, )"));
  EXPECT_EQ(with("sobol", R"("seed": 2, )"), with("sobol", R"("seed": 2, )"));
  EXPECT_NE(with("sobol", R"("seed": 2, )"), with("sobol", R"("seed": 3, )"));
  EXPECT_NE(with("sobol", R"("seed": 1, )"), with("sobol", ""));
}

TEST(Design, MultipliesWithCasesAxesAndReplicates) {
  const auto plan = plan_of(
      R"({"cases": [{"restitution": 0.8}, {"restitution": 0.9}], "design": {"type": "zip",
         "over": {"clearance_mm": [0.1, 0.2]}},
                                "sweep": {"coupler": ["rigid", "flexible"]}, "replicates": {"count": 2}})");
  EXPECT_EQ(plan.swept, (Strings{"clearance_mm", "coupler", "restitution"}));
  Strings values;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    EXPECT_EQ(plan.jobs[i].replicate, i % 2);
    if (i % 2 == 0) values.push_back(plan.jobs[i].swept);
  }
  EXPECT_EQ(values, (Strings{R"([0.1,"rigid",0.8])", R"([0.1,"flexible",0.8])", R"([0.2,"rigid",0.8])",
                             R"([0.2,"flexible",0.8])", R"([0.1,"rigid",0.9])", R"([0.1,"flexible",0.9])",
                             R"([0.2,"rigid",0.9])", R"([0.2,"flexible",0.9])"}));
}

}  // namespace
}  // namespace jobs_tests
