// SPDX-License-Identifier: Apache-2.0
// The parameter of a worn bore: what is refused, and that it is part of what a job is.

#include "jobs/parameters/wear_depth.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/requests/expand.h"
#include "jobs/requests/parameters.h"
#include "jobs/wear/pressed_arc.h"
#include "jobs/wear/wear.h"
#include "tests/jobs/request_support.h"

namespace jobs_tests {
namespace {

using nlohmann::json;
using std::numbers::pi;

json bore_of(double depth_um, std::size_t sectors = 8, std::size_t rings = 3) {
  return json(std::vector<std::vector<double>>(rings, std::vector<double>(sectors, depth_um)));
}

TEST(WearDepth, IsRefusedWhereItSaysNoBore) {
  json odd = bore_of(1);
  odd[1].push_back(1);
  json negative = bore_of(1);
  negative[1][3] = -1;
  const struct {
    json parameters;
    const char* pointer;
    const char* says;
  } cases[] = {
      {{{"wear_depth_um", 3}}, "", "a list for each ring"},
      {{{"wear_depth_um", json::array()}}, "", "a list for each ring"},
      {{{"wear_depth_um", bore_of(1, 7)}}, "", "[8, 360]"},
      {{{"wear_depth_um", bore_of(1, 361)}}, "", "[8, 360]"},
      {{{"wear_depth_um", odd}}, "", "the same number"},
      {{{"wear_depth_um", negative}}, "/1/3", "[0, 100000] um"},
      {{{"wear_depth_um", bore_of(1, 8, 2)}}, "", "for each of the rings, 3"},
      {{{"wear_depth_um", bore_of(501)}}, "", "a tenth of the bearing radius, 500 um"},
      {{{"wear_depth_um", bore_of(1)}, {"contact", "elements"}}, "", "contact continuum"},
      {{{"wear_depth_um", bore_of(1)}, {"clearance_mm", 0}}, "", "ideal joint"},
  };
  for (const auto& refused : cases) {
    const auto faults = faults_of([&] { (void)jobs::complete_parameters(refused.parameters, ""); });
    ASSERT_EQ(faults.size(), 1U) << refused.parameters;
    EXPECT_EQ(faults[0].pointer, std::string("/wear_depth_um") + refused.pointer);
    EXPECT_NE(faults[0].detail.find(refused.says), std::string::npos) << faults[0].detail;
  }
}

TEST(WearDepth, IsPartOfWhatAJobIsOnlyWhereItIsGiven) {
  const json round = jobs::complete_parameters(json::object(), "");
  EXPECT_FALSE(round.contains("wear_depth_um"));
  json whole = bore_of(0);
  whole[0][2] = 3;
  json same = bore_of(-0.0);
  same[0][2] = 3.0;
  const auto plan = [](const json& bore) { return jobs::plan_job({{"wear_depth_um", bore}}).content_id; };
  EXPECT_EQ(plan(whole), plan(same));
  EXPECT_NE(plan(whole), plan(bore_of(0)));
  EXPECT_NE(jobs::plan_job(json::object()).content_id, plan(bore_of(0)));
  const auto spec = jobs::to_job_spec(jobs::complete_parameters({{"wear_depth_um", whole}}, ""));
  EXPECT_DOUBLE_EQ(spec.parameters.wear_depth.at(0).at(2), 3e-6);
}

// In rows a bore stands for its largest depth; it is no axis.
TEST(WearDepth, IsSweptByCases) {
  const nlohmann::ordered_json request{
      {"cases", {{{"wear_depth_um", bore_of(1)}}, {{"wear_depth_um", bore_of(2)}}}}};
  const auto plan = jobs::plan_sweep(request, 10);
  ASSERT_EQ(plan.jobs.size(), 2U);
  EXPECT_EQ(plan.jobs[1].swept, "[2.0]");
  const auto faults = faults_of([] { (void)jobs::plan_sweep({{"sweep", {{"wear_depth_um", {1, 2}}}}}, 10); });
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_NE(faults[0].detail.find("cases"), std::string::npos);
}

// Pressed a micrometre deep, a round journal touches where |e| (1 - cos phi) < 1 um, and most in the middle.
TEST(PressedArc, IsWhereAJournalIsDeeperThanTheBore) {
  constexpr double c_r = 0.25e-3, delta = 1e-6;
  constexpr std::size_t kSectors = 360;
  const engine::WornBore bore(c_r, engine::WearDepth{std::vector<double>(36, 0.0)});
  jobs::PressedArc arc(bore, 0, c_r, kSectors);
  std::vector<double> work(kSectors, 0.0);
  arc.add(7.0, pi, delta, work);
  const double half = std::acos(c_r / (c_r + delta)) * 180.0 / pi;  // 5.1 degrees
  double sum = 0.0;
  for (std::size_t s = 0; s < kSectors; ++s) {
    sum += work[s];
    const double away = std::abs(static_cast<double>(s) + 0.5 - 180.0);
    if (away > half + 0.5) {
      EXPECT_EQ(work[s], 0.0) << s;
    } else if (away < half - 0.5) {
      EXPECT_GT(work[s], 0.0) << s;
    }
  }
  EXPECT_NEAR(sum, 7.0, 1e-12);
  // A parabola over 2 half holds 3/4 of its height on the mean: 7 J over 10.2 sectors.
  EXPECT_NEAR(work[180], 1.5 * 7.0 / (2.0 * half), 0.03);
  EXPECT_NEAR(work[179], work[180], 1e-9);
}

}  // namespace
}  // namespace jobs_tests
