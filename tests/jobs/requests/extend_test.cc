// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/extend_request.h"

#include <gtest/gtest.h>

#include "tests/jobs/request_support.h"

namespace jobs_tests {
namespace {

using Strings = std::vector<std::string>;

constexpr std::size_t kMaxExtendedJobs = 100;

jobs::Extension extension_of(const char* former, const char* addition) {
  return jobs::plan_extension(request_of(former), request_of(addition), kMaxExtendedJobs);
}

Strings extended_values(const jobs::Extension& extension) {
  Strings values;
  for (const jobs::PlannedJob& job : extension.jobs) values.push_back(job.swept);
  return values;
}

constexpr const char* kGrid = R"({"name": "n", "sweep": {"clearance_mm": [0.1, 0.2], "coupler": ["rigid"]}})";

TEST(PlanExtension, AddsValuesToAxes) {
  const auto extension = extension_of(kGrid, R"({"sweep": {"clearance_mm": [0.3]}})");
  EXPECT_EQ(extension.request,
            request_of(R"({"name": "n", "sweep": {"clearance_mm": [0.1, 0.2, 0.3], "coupler": ["rigid"]}})"));
  EXPECT_EQ(extended_values(extension), (Strings{R"([0.3,"rigid"])"}));
}

TEST(PlanExtension, MultipliesWhatIsAddedToTwoAxes) {
  const auto extension =
      extension_of(kGrid, R"({"sweep": {"coupler": ["flexible"], "clearance_mm": [0.3]}})");
  EXPECT_EQ(extended_values(extension), (Strings{R"([0.1,"flexible"])", R"([0.2,"flexible"])",
                                                 R"([0.3,"rigid"])", R"([0.3,"flexible"])"}));
}

TEST(PlanExtension, LeavesOutWhatTheSweepHas) {
  const auto nothing = extension_of(kGrid, R"({"sweep": {"clearance_mm": [0.2, 0.1]}})");
  EXPECT_EQ(nothing.request, request_of(kGrid));
  EXPECT_TRUE(nothing.jobs.empty());
  const auto one = extension_of(R"({"sweep": {"crank_velocity_rad_s": [5]}})",
                                R"({"sweep": {"crank_velocity_rad_s": [5.0, 6]}})");
  EXPECT_EQ(extended_values(one), (Strings{"[6.0]"}));
}

TEST(PlanExtension, WritesARangeOutWhenItGrows) {
  const auto extension = extension_of(R"({"sweep": {"clearance_mm": {"from": 0, "to": 0.5, "count": 3}}})",
                                      R"({"sweep": {"clearance_mm": {"from": 0.5, "to": 1, "count": 3}}})");
  EXPECT_EQ(extension.request, request_of(R"({"sweep": {"clearance_mm": [0.0, 0.25, 0.5, 0.75, 1.0]}})"));
  EXPECT_EQ(extended_values(extension), (Strings{"[0.75]", "[1.0]"}));
}

TEST(PlanExtension, AddsCasesTimesAllAxes) {
  const auto extension =
      extension_of(R"({"cases": [{"restitution": 0.9}], "sweep": {"clearance_mm": [0.1, 0.2]}})",
                   R"({"cases": [{"restitution": 0.9}, {"restitution": 0.8}]})");
  EXPECT_EQ(extension.request.at("cases"), request_of(R"([{"restitution": 0.9}, {"restitution": 0.8}])"));
  EXPECT_EQ(extended_values(extension), (Strings{"[0.1,0.8]", "[0.2,0.8]"}));
}

TEST(PlanExtension, RefusesMoreCasesThanASweepMayHaveJobs) {
  std::string cases = "{}";
  for (std::size_t k = 0; k < kMaxExtendedJobs; ++k) cases += ",{}";
  const auto faults = faults_of([&] {
    (void)extension_of(R"({"cases": [{"restitution": 0.9}]})", (R"({"cases": [)" + cases + "]}").c_str());
  });
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].pointer, "/cases");
  EXPECT_EQ(faults[0].detail, "has 101 cases; at most 100 jobs are allowed");
}

// Were each case to be compared with every other one, this would take hours.
TEST(PlanExtension, KnowsItsOwnCasesAmongMany) {
  constexpr std::size_t kCases = 50'000;
  std::string cases = R"({"restitution": 0.9})";
  for (std::size_t k = 1; k < kCases; ++k) cases += R"(,{"gravity_m_s2": )" + std::to_string(k) + "e-4}";
  const auto request = request_of((R"({"cases": [)" + cases + "]}").c_str());
  EXPECT_TRUE(jobs::plan_extension(request, request, kCases).jobs.empty());
}

TEST(PlanExtension, KeepsThePointsOfADesign) {
  const char* const former =
      R"({"design": {"type": "latin_hypercube", "count": 3, "over": {"restitution": {"from": 0.6,
         "to": 0.9}}}, "sweep": {"coupler": ["rigid"]}})";
  const auto extension = extension_of(former, R"({"sweep": {"coupler": ["flexible"]}})");
  const auto before = jobs::plan_sweep(request_of(former), kMaxExtendedJobs);
  EXPECT_EQ(extension.request.at("design"), request_of(former).at("design"));
  ASSERT_EQ(extension.jobs.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    nlohmann::json point = nlohmann::json::parse(before.jobs[k].swept);
    point.back() = "flexible";
    EXPECT_EQ(nlohmann::json::parse(extension.jobs[k].swept), point);
  }
}

TEST(PlanExtension, RunsNewSetsAsOftenAsTheOthers) {
  const auto extension = extension_of(R"({"sweep": {"clearance_mm": [0.1]}, "replicates": {"count": 3}})",
                                      R"({"sweep": {"clearance_mm": [0.2]}})");
  ASSERT_EQ(extension.jobs.size(), 3U);
  for (std::uint64_t k = 0; k < 3; ++k) EXPECT_EQ(extension.jobs[k].replicate, k);
}

struct RefusalCase {
  const char* name;
  const char* former;
  const char* addition;
  Strings pointers;
};
void PrintTo(const RefusalCase& c, std::ostream* out) { *out << c.name; }

class ExtensionRefusal : public testing::TestWithParam<RefusalCase> {};

TEST_P(ExtensionRefusal, NamesEveryPlace) {
  const auto faults = faults_of([&] { (void)extension_of(GetParam().former, GetParam().addition); });
  EXPECT_EQ(pointers_of(faults), GetParam().pointers);
}

constexpr const char* kCases = R"({"cases": [{"restitution": 0.9}, {"restitution": 0.7}]})";

INSTANTIATE_TEST_SUITE_P(
    All, ExtensionRefusal,
    testing::Values(RefusalCase{"NoObject", kGrid, "[]", {""}}, RefusalCase{"Empty", kGrid, "{}", {""}},
                    RefusalCase{
                        "OtherKeys", kGrid, R"({"name": "x", "sweep": {"clearance_mm": [1]}})", {"/name"}},
                    RefusalCase{"NoSuchAxis",
                                kGrid,
                                R"({"sweep": {"restitution": [0.8], "coupler": [1]}})",
                                {"/sweep/coupler/0", "/sweep/restitution"}},
                    RefusalCase{"BadValues",
                                kGrid,
                                R"({"sweep": {"clearance_mm": [0.3, -1, "a"]}})",
                                {"/sweep/clearance_mm/1", "/sweep/clearance_mm/2"}},
                    RefusalCase{"TooMany",
                                kGrid,
                                R"({"sweep": {"clearance_mm": {"from": 1, "to": 2, "count": 1000000000}}})",
                                {"/sweep/clearance_mm"}},
                    RefusalCase{"TooManyTogether",
                                kGrid,
                                R"({"sweep": {"clearance_mm": {"from": 1, "to": 2, "count": 100}}})",
                                {"/sweep"}},
                    RefusalCase{"NoCasesBefore", kGrid, R"({"cases": [{"restitution": 0.5}]})", {"/cases"}},
                    RefusalCase{"OtherParametersInACase",
                                kCases,
                                R"({"cases": [{"clearance_mm": 0.5}]})",
                                {"/cases/0/clearance_mm"}},
                    RefusalCase{"NoCasesAtAll", kCases, R"({"cases": []})", {"/cases"}},
                    RefusalCase{"NoListOfCases", kCases, R"({"cases": {}})", {"/cases"}},
                    RefusalCase{"BadCases",
                                kCases,
                                R"({"cases": [{"restitution": 0.9}, {"restitution": 2}]})",
                                {"/cases/1/restitution"}},
                    // Larger than the bearing: a fault of the set, found in the union, where the case has
                    // another number.
                    RefusalCase{"CasesThatCannotBe",
                                R"({"cases": [{"clearance_mm": 1}, {"clearance_mm": 2}]})",
                                R"({"cases": [{"clearance_mm": 1}, {"clearance_mm": 900}]})",
                                {"/cases/1/clearance_mm"}},
                    RefusalCase{"CasesBehindRepeatedOnes",
                                R"({"cases": [{"clearance_mm": 1}, {"clearance_mm": 2}]})",
                                R"({"cases": [{"clearance_mm": 1}, {"clearance_mm": 1}, {"clearance_mm": 2},
                                              {"clearance_mm": 900}, {"clearance_mm": 1.5}]})",
                                {"/cases/3/clearance_mm"}}),
    [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace jobs_tests
