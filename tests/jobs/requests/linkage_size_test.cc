// SPDX-License-Identifier: Apache-2.0
// Described linkages that are too large, by themselves or for a sweep of many jobs.

#include <string>

#include <gtest/gtest.h>

#include "jobs/requests/expand.h"
#include "jobs/requests/parameters.h"
#include "tests/jobs/request_support.h"

namespace jobs_tests {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxJobs = 10'000;

/// Bodies one behind the other, the joints of one kind, and revolute joints between the ground and the first
/// body.
json chain(int bodies, const char* kind, int closing = 0) {
  json linkage{{"bodies", json::object()}, {"joints", json::object()}};
  const auto name = [](const char* letter, int k) { return letter + std::to_string(k); };
  for (int k = 0; k < bodies; ++k) {
    linkage["bodies"][name("b", k)] = {{"mass_kg", 1}, {"inertia_kg_m2", {0.1, 0.1, 0.1}}};
    linkage["joints"][name("j", k)] = {{"kind", kind},
                                       {"from", k == 0 ? "ground" : name("b", k - 1)},
                                       {"to", name("b", k)},
                                       {"at_m", {1, 0, 0}}};
  }
  for (int k = 0; k < closing; ++k)
    linkage["joints"][name("c", k)] = {
        {"kind", "revolute"}, {"from", "ground"}, {"to", "b0"}, {"closes_loop", true}, {"at_m", {1, 0, 0}}};
  return linkage;
}

/// A crank that turns by a table of that many points.
json table_driven(int points) {
  json times = json::array(), angles = json::array();
  for (int k = 0; k < points; ++k) {
    times.push_back(0.001 * k);
    angles.push_back(0.1 * k);
  }
  json linkage = chain(1, "revolute");
  linkage["joints"]["j0"]["drive"] = {{"law", "table"}, {"times_s", times}, {"values_rad", angles}};
  return linkage;
}

std::string refusal_of(const json& linkage) {
  const auto faults = faults_of([&] { (void)jobs::complete_parameters({{"linkage", linkage}}, ""); });
  if (faults.empty()) return "";
  EXPECT_EQ(faults[0].pointer, "/linkage");
  return faults[0].detail;
}

std::string refusal_of_sweep(const json& linkage, int points) {
  const nlohmann::ordered_json request{
      {"parameters", {{"linkage", linkage}}},
      {"sweep", {{"gravity_m_s2", {{"from", 1}, {"to", 10}, {"count", points}}}}}};
  const auto faults = faults_of([&] { (void)jobs::plan_sweep(request, kMaxJobs); });
  return faults.empty() ? "" : faults[0].detail;
}

TEST(LinkageSize, IsBoundedInCoordinates) {
  EXPECT_EQ(refusal_of(chain(100, "free")), "");
  EXPECT_EQ(
      refusal_of(chain(101, "free")),
      "has 606 coordinates, of its joints and between the elements of its beams; at most 600 are allowed");
}

TEST(LinkageSize, CountsTheElementsOfBeams) {
  json linkage = chain(4, "revolute");
  for (json& body : linkage["bodies"])
    body = {{"mass_kg", 1}, {"beam", {{"length_m", 1}, {"diameter_mm", 9}, {"elements", 64}}}};
  EXPECT_EQ(refusal_of(linkage).find("has 760 coordinates"), 0U);
  for (json& body : linkage["bodies"]) body["beam"].erase("elements");
  const auto faults = faults_of([&] {
    (void)jobs::complete_parameters({{"linkage", linkage}, {"rigid_elements", 64}}, "");
  });
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].detail.find("has 760 coordinates"), 0U);
}

TEST(LinkageSize, IsBoundedInConstraints) {
  EXPECT_EQ(refusal_of(chain(1, "revolute", 60)), "");
  EXPECT_EQ(refusal_of(chain(1, "revolute", 61)),
            "has 305 constraints by joints that close loops or have clearance; at most 300 are allowed");
}

TEST(SweepOfLinkages, MayHaveFewerJobsTheLargerTheLinkage) {
  EXPECT_EQ(refusal_of_sweep(chain(100, "free"), 2), "");
  const std::string refusal = refusal_of_sweep(chain(100, "free"), 1000);
  EXPECT_EQ(refusal.find("the linkage is too large for a sweep of 1000 jobs, whose loops would all have to "
                         "be closed: at most 247 are allowed"),
            0U)
      << refusal;
}

TEST(SweepOfLinkages, MayHaveFewerJobsTheLongerTheDescription) {
  EXPECT_EQ(refusal_of_sweep(table_driven(5000), 2), "");
  EXPECT_NE(refusal_of_sweep(table_driven(5000), 5000).find("each of which keeps its description: at most "),
            std::string::npos);
}

// A bore of 360 sectors and some rings, in each job: 946 MB of store from a body of 97 kB, once.
TEST(SweepOfLargeParameters, MayHaveFewerJobsTheLargerTheyAre) {
  nlohmann::ordered_json request = request_of(
      R"({"parameters": {"contact": "continuum", "radial_levels": 9}, "sweep": {"crank_velocity_rad_s": {"from": 1, "to": 9, "count": 5}}})");
  request["parameters"]["wear_depth_um"] = std::vector<std::vector<double>>(9, std::vector<double>(360, 0.12345));
  const auto refusal_with = [&](int count) -> std::string {
    request["sweep"]["crank_velocity_rad_s"]["count"] = count;
    try {
      static_cast<void>(jobs::plan_sweep(request, 10'000));
    } catch (const jobs::InvalidRequest& invalid) {
      return invalid.faults().front().detail;
    }
    return "";
  };
  EXPECT_EQ(refusal_with(5), "");
  EXPECT_EQ(refusal_with(10'000).find("the parameters are too large for a sweep of 10000 jobs, each of which keeps them: at most "), 0U)
      << refusal_with(10'000);
  // Also where the cases that follow are the large ones.
  nlohmann::ordered_json cases = nlohmann::ordered_json::array();
  for (int i = 0; i < 10; ++i)
    cases.push_back({{"wear_depth_um", std::vector<std::vector<double>>(9, std::vector<double>(360, 0.1 + 1e-3 * i))}});
  nlohmann::ordered_json many = request;
  many["parameters"].erase("wear_depth_um");
  many["cases"] = cases;
  many["sweep"]["crank_velocity_rad_s"]["count"] = 100;
  EXPECT_THROW(static_cast<void>(jobs::plan_sweep(many, 1'000)), jobs::InvalidRequest);
}

}  // namespace
}  // namespace jobs_tests
