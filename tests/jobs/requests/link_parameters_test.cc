// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include <gtest/gtest.h>

#include "jobs/requests/parameters.h"
#include "tests/jobs/request_support.h"

namespace jobs_tests {
namespace {

using nlohmann::json;

json link_of(const char* given, const char* link) {
  return jobs::complete_parameters(json_of(given), "").at("links").at(link);
}

void expect_relative(double actual, double expected, double tolerance) {
  EXPECT_NEAR(actual / expected, 1.0, tolerance);
}

// A solid steel rod: m = rho pi d^2 l / 4, I_x = m d^2 / 8, I_y = m l^2 / 3 + I_x / 2 about its end. The
// coupler's default is this rod at l = 0.5 m, d = 10 mm, with its mass to three printed digits; the scaled
// one must be the longer rod to as many.
TEST(DefaultLinks, ScaleAsAUniformRod) {
  const double l = 0.7;
  const double d = 0.014;
  const double m = 7800.0 * std::numbers::pi / 4.0 * d * d * l;
  const json link = link_of(R"({"coupler_length_m": 0.7, "coupler_diameter_mm": 14})", "1,3");
  expect_relative(link.at("mass_kg"), m, 2e-3);
  expect_relative(link.at("inertia_kg_m2")[0], m * d * d / 8.0, 2e-3);
  expect_relative(link.at("inertia_kg_m2")[1], m * l * l / 3.0 + m * d * d / 16.0, 2e-3);
  EXPECT_EQ(link.at("inertia_kg_m2")[1], link.at("inertia_kg_m2")[2]);
}

// A steel tube: m = rho pi (d^2 - d_i^2) l / 4, I_x = m (d^2 + d_i^2) / 8. The crank's default is one of
// 28/20 mm.
TEST(DefaultLinks, ScaleAsAUniformTube) {
  const double l = 0.25, d = 0.03, d_i = 0.018;
  const double m = 7800.0 * std::numbers::pi / 4.0 * (d * d - d_i * d_i) * l;
  const json link =
      link_of(R"({"crank_length_m": 0.25, "crank_diameter_mm": 30, "crank_inner_diameter_mm": 18})", "1,1");
  expect_relative(link.at("mass_kg"), m, 2e-3);
  expect_relative(link.at("inertia_kg_m2")[0], m * (d * d + d_i * d_i) / 8.0, 2e-3);
  expect_relative(link.at("inertia_kg_m2")[1], m * l * l / 3.0 + m * (d * d + d_i * d_i) / 16.0, 2e-3);
}

// With a length it is a tube along z from its guide on; without one the table's, whatever its diameters.
TEST(DefaultLinks, OfTheCrossLinkFollowItsLength) {
  const double l = 0.06, d = 0.02, d_i = 0.015;
  const double m = 7800.0 * std::numbers::pi / 4.0 * (d * d - d_i * d_i) * l;
  const json link = link_of(R"({"cross_length_mm": 60})", "2,2");
  expect_relative(link.at("mass_kg"), m, 2e-3);
  expect_relative(link.at("inertia_kg_m2")[2], m * (d * d + d_i * d_i) / 8.0, 3e-3);
  expect_relative(link.at("inertia_kg_m2")[0], m * l * l / 3.0 + m * (d * d + d_i * d_i) / 16.0, 3e-3);
  EXPECT_EQ(link.at("inertia_kg_m2")[0], link.at("inertia_kg_m2")[1]);
  EXPECT_EQ(link_of(R"({"cross_diameter_mm": 40})", "2,2"), link_of("{}", "2,2"));
}

// Very short rods are discs: I_y comes near I_x / 2, and no scaling of I_y with l^2 alone would be that of a
// body.
TEST(DefaultLinks, AreBodiesAtAnyLength) {
  for (const double length : {0.001, 0.01, 0.1, 1.0}) {
    EXPECT_NO_THROW(
        (void)jobs::complete_parameters({{"crank_length_m", length}, {"coupler_length_m", 0.5 + length}}, ""))
        << length;
  }
}

TEST(DefaultLinks, OfCrankAndRodFollowTheirOwnLengthsOnly) {
  const char* given = R"({"crank_length_m": 0.1})";
  const json crank = link_of(given, "1,1");
  EXPECT_DOUBLE_EQ(crank.at("mass_kg"), 0.471 / 2.0);
  EXPECT_DOUBLE_EQ(crank.at("inertia_kg_m2")[0], 6.964e-5 / 2.0);
  EXPECT_DOUBLE_EQ(crank.at("inertia_kg_m2")[1], 0.471 / 2.0 * 0.1 * 0.1 / 3.0 + 6.964e-5 / 4.0);
  const json defaults = jobs::complete_parameters(json::object(), "").at("links");
  for (const char* other : {"1,2", "1,3", "2,1", "2,2"})
    EXPECT_EQ(link_of(given, other), defaults.at(other)) << other;
  EXPECT_DOUBLE_EQ(link_of(R"({"rod_length_m": 0.24})", "1,2").at("mass_kg"), 0.490 * 1.2);
}

TEST(DefaultLinks, MomentsFollowAGivenMass) {
  const json link = link_of(R"({"links": {"2,1": {"mass_kg": 1.56}}})", "2,1");
  EXPECT_EQ(link.at("mass_kg"), 1.56);
  EXPECT_DOUBLE_EQ(link.at("inertia_kg_m2")[0], 2.0 * 8.126e-4);
  EXPECT_DOUBLE_EQ(link.at("inertia_kg_m2")[2], 2.0 * 6.76e-4);
  const json rod = link_of(R"({"links": {"1,3": {"mass_kg": 0.612}}})", "1,3");
  EXPECT_DOUBLE_EQ(rod.at("inertia_kg_m2")[0], 2.0 * 3.829e-6);
  EXPECT_DOUBLE_EQ(rod.at("inertia_kg_m2")[1], 0.612 * 0.25 / 3.0 + 3.829e-6);
}

TEST(GivenLinks, AreTakenAsTheyAre) {
  const json link = link_of(
      R"({"coupler_length_m": 0.6, "links": {"1,3": {"mass_kg": 0.3, "inertia_kg_m2": [1e-5, 0.036,
         0.036]}}})",
      "1,3");
  EXPECT_EQ(link, json_of(R"({"mass_kg": 0.3, "inertia_kg_m2": [1e-5, 0.036, 0.036]})"));
  EXPECT_EQ(link_of(R"({"coupler_length_m": 0.6, "links": {"1,3": {"inertia_kg_m2": [1e-5, 0.036, 0.036]}}})",
                    "1,3")
                .at("mass_kg")
                .get<double>(),
            0.306 * (0.6 / 0.5));
}

// A plate has I_x = I_y + I_z exactly; 0.1 + 0.2 is more than 0.3 in doubles, and 0.3 + 0.6 less than 0.9.
TEST(GivenLinks, MayBePlates) {
  for (const char* plate : {"[0.3, 0.1, 0.2]", "[0.1, 0.2, 0.3]", "[0.3, 0.9, 0.6]"}) {
    const std::string given = std::string(R"({"links": {"2,2": {"inertia_kg_m2": )") + plate + "}}}";
    EXPECT_NO_THROW((void)jobs::complete_parameters(json_of(given), "")) << plate;
  }
}

}  // namespace
}  // namespace jobs_tests
