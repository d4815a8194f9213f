// SPDX-License-Identifier: Apache-2.0
// Laws for crank and rod of the linkage "rpsup" in the place of the paper's.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/simulate_rpsup.h"
#include "jobs/requests/expand.h"
#include "jobs/requests/parameters.h"
#include "tests/jobs/request_support.h"

namespace jobs_tests {
namespace {

using nlohmann::json;

const json kTable{{"law", "velocity_table"}, {"times_s", {0, 1, 2}}, {"velocities_rad_s", {0, 8, 10}}};

TEST(RpsupDrive, TakesThePlaceOfTheParametersOfThePaper) {
  const json completed = jobs::complete_parameters({{"crank_drive", kTable}}, "");
  EXPECT_FALSE(completed.contains("crank_velocity_rad_s"));
  EXPECT_FALSE(completed.contains("crank_start_rad"));
  EXPECT_TRUE(completed.contains("rod_stroke_mm"));
  EXPECT_EQ(completed.at("crank_drive").at("times_s").dump(), "[0.0,1.0,2.0]");
  EXPECT_EQ(completed.at("crank_drive").at("interpolation"), "monotone_cubic");
  const json former{{"law", "polynomial"}, {"coefficients_rad_s", {0, 5}}};
  EXPECT_EQ(jobs::complete_parameters({{"crank_drive", former}}, "").at("crank_drive").dump(),
            R"({"coefficients_rad":[0.0,5.0],"law":"polynomial"})");
  const jobs::JobSpec spec = jobs::to_job_spec(completed);
  ASSERT_TRUE(spec.parameters.crank_drive);
  EXPECT_FALSE(spec.parameters.rod_drive);
  EXPECT_EQ(engine::calc_driven_motion(*spec.parameters.crank_drive, 2.5).qd, 10.0);
  EXPECT_FALSE(jobs::complete_parameters(json::object(), "").contains("crank_drive"));
}

TEST(RpsupDrive, MovesTheRodFromItsLength) {
  const json rod{{"law", "harmonic"}, {"amplitude_m", 0.01}, {"frequency_hz", 1}};
  const json completed = jobs::complete_parameters({{"rod_drive", rod}, {"duration_s", 0.3}, {"run_up_s", 0.1}}, "");
  for (const char* const key : {"rod_start_m", "rod_stroke_mm", "rod_stroke_time_s", "rod_pause_s", "rod_law"})
    EXPECT_FALSE(completed.contains(key)) << key;
  const jobs::JobSpec spec = jobs::to_job_spec(completed);
  const engine::RunResult result = engine::simulate_rpsup(spec.parameters, spec.options, {});
  ASSERT_EQ(result.status, engine::RunStatus::kSucceeded) << result.detail;
  for (std::size_t k = 0; k < result.trajectory.channels.size(); ++k) {
    if (result.trajectory.channels[k].key != "rod_displacement_m") continue;
    EXPECT_NEAR(result.trajectory.columns[k].at(250), 0.01, 1e-9);  // at 0.25 s
    return;
  }
  FAIL() << "no channel rod_displacement_m";
}

struct Refused {
  const char* name;
  const char* request;
  const char* pointer;
  const char* says;
};
void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.name; }

class RefusedRpsupDrive : public testing::TestWithParam<Refused> {};

TEST_P(RefusedRpsupDrive, IsNamedWithItsPlace) {
  const auto faults = faults_of([&] { (void)jobs::plan_sweep(request_of(GetParam().request), 100); });
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].pointer, GetParam().pointer);
  EXPECT_NE(faults[0].detail.find(GetParam().says), std::string::npos) << faults[0].detail;
}

constexpr Refused kRefused[] = {
    {"no_object", R"({"parameters": {"crank_drive": 3}})", "/parameters/crank_drive", "object"},
    {"no_law", R"({"parameters": {"crank_drive": {}}})", "/parameters/crank_drive/law", "run_up"},
    {"unknown_law", R"({"parameters": {"crank_drive": {"law": "fast"}}})", "/parameters/crank_drive/law", "velocity_table"},
    {"unit_of_the_other_motion", R"({"parameters": {"rod_drive": {"law": "run_up", "velocity_m_s": 0, "from_rad": 1}}})",
     "/parameters/rod_drive/from_rad", "from_m"},
    {"fewer_velocities", R"({"parameters": {"crank_drive": {"law": "velocity_table", "times_s": [0, 1], "velocities_rad_s": [1, 2, 3]}}})",
     "/parameters/crank_drive/velocities_rad_s", "each of the 2 of times_s"},
    {"one_velocity", R"({"parameters": {"crank_drive": {"law": "velocity_table", "times_s": [0, 1], "velocities_rad_s": [1]}}})",
     "/parameters/crank_drive/velocities_rad_s", "2 to 10,000 numbers"},
    {"times_that_fall", R"({"parameters": {"crank_drive": {"law": "velocity_table", "times_s": [0, 0], "velocities_rad_s": [1, 1]}}})",
     "/parameters/crank_drive/times_s", "1e-6 s"},
    {"times_too_close", R"({"parameters": {"crank_drive": {"law": "velocity_table", "times_s": [0, 1e-300], "velocities_rad_s": [1, 2]}}})",
     "/parameters/crank_drive/times_s", "1e-6 s"},
    {"interpolation", R"({"parameters": {"crank_drive": {"law": "velocity_table", "times_s": [0, 1], "velocities_rad_s": [1, 1],
      "interpolation": "cubic"}}})", "/parameters/crank_drive/interpolation", "monotone_cubic"},
    {"beside_a_velocity", R"({"parameters": {"crank_velocity_rad_s": 5, "crank_drive": {"law": "run_up", "velocity_rad_s": 5}}})",
     "/parameters/crank_velocity_rad_s", "crank_drive"},
    {"beside_an_axis", R"({"parameters": {"crank_drive": {"law": "run_up", "velocity_rad_s": 5}}, "sweep": {"crank_start_rad": [0, 1]}})",
     "/sweep/crank_start_rad", "crank_drive"},
    {"as_an_axis", R"({"sweep": {"crank_drive": [{"law": "run_up", "velocity_rad_s": 5}]}})", "/sweep/crank_drive", "cases"},
    {"out_of_reach", R"({"parameters": {"rod_drive": {"law": "cycloidal", "rise_m": 3, "time_s": 1}}})",
     "/parameters/rod_drive", "locks"},
    {"out_of_reach_with_another_crank", R"({"parameters": {"crank_drive": {"law": "run_up", "velocity_rad_s": 5}, "rod_drive": {"law": "cycloidal",
      "rise_m": 3, "time_s": 1}}})", "/parameters/rod_drive", "locks"},
    {"beside_the_parameters", R"({"crank_drive": {"law": "run_up", "velocity_rad_s": 5}})", "/crank_drive", "\"parameters\""},
};

INSTANTIATE_TEST_SUITE_P(All, RefusedRpsupDrive, testing::ValuesIn(kRefused),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(RpsupDrive, IsShownByItsLawInTheCasesOfASweep) {
  json faster = kTable;
  faster["velocities_rad_s"] = {0, 9, 12};
  const jobs::SweepPlan plan = jobs::plan_sweep(
      {{"cases", {{{"crank_drive", kTable}}, {{"crank_drive", faster}}, {{"restitution", 0.8}}}}}, 100);
  ASSERT_EQ(plan.jobs.size(), 3U);
  EXPECT_EQ(plan.swept, (std::vector<std::string>{"crank_drive", "restitution"}));
  EXPECT_EQ(plan.jobs[0].swept, R"(["velocity_table",0.9])");
  EXPECT_EQ(plan.jobs[1].swept, R"(["velocity_table #2",0.9])");
  EXPECT_EQ(plan.jobs[2].swept, R"([null,0.8])");
}

TEST(RpsupDrive, BelongsToThatLinkage) {
  json given{{"crank_drive", kTable}};
  given["linkage"] = json_of(R"({"bodies": {"b": {"mass_kg": 1}}, "joints": {"j": {"kind": "prismatic", "from": "ground", "to": "b"}}})");
  EXPECT_EQ(pointers_of(faults_of([&] { (void)jobs::complete_parameters(given, ""); })), std::vector<std::string>{"/crank_drive"});
}

}  // namespace
}  // namespace jobs_tests
