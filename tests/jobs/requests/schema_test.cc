// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/base/errors.h"
#include "jobs/linkages/linkage_actuator.h"
#include "jobs/linkages/linkage_beam.h"
#include "jobs/linkages/linkage_fields.h"
#include "jobs/linkages/linkage_json.h"
#include "jobs/parameters/parameter_table.h"
#include "jobs/requests/parameter_schema.h"
#include "jobs/requests/parameters.h"

namespace jobs_tests {
namespace {

using nlohmann::json;

// The keys of the interface's description, written down here by hand.
const std::set<std::string> kKeys{"coupler",
                                  "clearance_mm",
                                  "axial_clearance_mm",
                                  "crank_velocity_rad_s",
                                  "duration_s",
                                  "output_rate_hz",
                                  "run_up_s",
                                  "rod_stroke_mm",
                                  "rod_stroke_time_s",
                                  "rod_pause_s",
                                  "drive",
                                  "baumgarte_alpha_1_s",
                                  "baumgarte_beta_1_s",
                                  "contact",
                                  "radial_levels",
                                  "radial_elements",
                                  "axial_levels",
                                  "axial_elements",
                                  "bearing_radius_mm",
                                  "bearing_length_mm",
                                  "normal_law",
                                  "restitution",
                                  "contact_damping_n_s_m",
                                  "stiffness_law",
                                  "contact_stiffness_scale",
                                  "axial_stiffness_n_m",
                                  "minimum_impact_velocity_m_s",
                                  "friction",
                                  "friction_static",
                                  "friction_kinetic",
                                  "bristle_stiffness_1_m",
                                  "bristle_damping_s_m",
                                  "bristle_viscous_s_m",
                                  "stribeck_velocity_m_s",
                                  "break_away_ratio",
                                  "friction_velocity_0_m_s",
                                  "friction_velocity_1_m_s",
                                  "rigid_elements",
                                  "youngs_modulus_pa",
                                  "shear_modulus_pa",
                                  "coupler_diameter_mm",
                                  "coupler_damping_ratio",
                                  "integrator",
                                  "step_s",
                                  "relative_tolerance",
                                  "absolute_tolerance",
                                  "crank_length_m",
                                  "rod_length_m",
                                  "coupler_length_m",
                                  "guide_offset_y_m",
                                  "guide_offset_z_m",
                                  "guide_angle_deg",
                                  "yoke_axis",
                                  "gravity_m_s2",
                                  "gravity_direction",
                                  "crank_start_rad",
                                  "crank_drive",
                                  "rod_drive",
                                  "rod_start_m",
                                  "rod_law",
                                  "linkage",
                                  "links",
                                  "wear_depth_um",
                                  "keep",
                                  "crank",
                                  "crank_diameter_mm",
                                  "crank_inner_diameter_mm",
                                  "crank_elements",
                                  "crank_damping_ratio",
                                  "rod",
                                  "rod_diameter_mm",
                                  "rod_inner_diameter_mm",
                                  "rod_elements",
                                  "rod_damping_ratio",
                                  "cross",
                                  "cross_diameter_mm",
                                  "cross_inner_diameter_mm",
                                  "cross_elements",
                                  "cross_damping_ratio",
                                  "cross_length_mm"};

TEST(ParameterSchema, ListsEveryKeyAndNoOther) {
  std::set<std::string> listed;
  const json schema = jobs::parameter_schema();
  for (const auto& [key, property] : schema.at("properties").items()) listed.insert(key);
  EXPECT_EQ(listed, kKeys);
  EXPECT_EQ(schema.at("additionalProperties"), false);
}

TEST(ParameterSchema, SaysTypeRangeUnitDefaultAndSource) {
  const json properties = jobs::parameter_schema().at("properties");
  const json& duration = properties.at("duration_s");
  EXPECT_EQ(duration.at("type"), "number");
  EXPECT_EQ(duration.at("exclusiveMinimum"), 0.0);
  EXPECT_EQ(duration.at("maximum"), 3600.0);
  EXPECT_FALSE(duration.contains("minimum"));
  EXPECT_EQ(duration.at("x-unit"), "s");
  EXPECT_EQ(duration.at("default"), 5.0);
  EXPECT_EQ(duration.at("x-default-source"), "chosen");
  EXPECT_EQ(properties.at("rigid_elements").at("type"), "integer");
  EXPECT_EQ(properties.at("rigid_elements").at("x-default-source"), "paper");
  EXPECT_EQ(properties.at("coupler").at("enum"), json::array({"rigid", "flexible"}));
  EXPECT_EQ(properties.at("coupler_diameter_mm").at("x-default-source"), "deduced from the paper");
  EXPECT_EQ(properties.at("rod_start_m").at("x-default-source"), "fitted to the paper's ratios");
  EXPECT_EQ(properties.at("yoke_axis").at("enum"), json::array({"guide", "across"}));
  EXPECT_EQ(properties.at("crank_inner_diameter_mm").at("default"), 20.0);
  EXPECT_EQ(properties.at("cross").at("enum"), properties.at("coupler").at("enum"));
  EXPECT_EQ(properties.at("links").at("properties").at("1,3").at("properties").at("mass_kg").at("default"),
            0.306);
  EXPECT_EQ(properties.at("links").at("properties").size(), 5U);
}

// Whoever follows the schema must be let in, and whoever leaves it by a hair must not.
TEST(ParameterSchema, AgreesWithTheChecks) {
  const json schema = jobs::parameter_schema();
  for (const auto& [key, property] : schema.at("properties").items()) {
    EXPECT_FALSE(key != "links" && property.at("description").get<std::string>().empty()) << key;
    if (!property.contains("default")) continue;  // links, worn bores and drives
    EXPECT_NO_THROW((void)jobs::complete_parameters({{key, property.at("default")}}, "")) << key;
    if (property.contains("maximum")) {
      EXPECT_THROW(
          (void)jobs::complete_parameters({{key, property.at("maximum").get<double>() * 1.001 + 1.0}}, ""),
          jobs::InvalidRequest)
          << key;
    }
    if (property.contains("exclusiveMinimum")) {
      EXPECT_THROW((void)jobs::complete_parameters({{key, property.at("exclusiveMinimum")}}, ""),
                   jobs::InvalidRequest)
          << key;
    }
  }
}

TEST(LinkageSchema, SaysTheDampingOfABeamWithoutAny) {
  const auto& fields = jobs::beam_fields();
  const auto field = std::ranges::find(fields, "damping_ratio", &jobs::LinkageField::key);
  ASSERT_NE(field, fields.end());
  const std::string help(field->help);
  EXPECT_EQ(std::stod(help.substr(help.rfind(' '))),
            jobs::read_beam({{"length_m", 1}, {"diameter_mm", 20}}, 1.0, {}).damping_ratio)
      << help;
}

const json& described_schema() {
  static const json schema = jobs::linkage_schema().at("oneOf").at(1).at("properties");
  return schema;
}

TEST(LinkageSchema, TakesThreeOrSixMomentsOfInertia) {
  const json schema = described_schema().at("bodies").at("additionalProperties").at("properties").at("inertia_kg_m2");
  const auto is_between = [](const json& limits, std::size_t n) {
    return n >= limits.at("minItems") && n <= limits.at("maxItems");
  };
  for (std::size_t n = 1; n < 9; ++n) {
    std::vector<jobs::Fault> faults;
    jobs::check_fields({{"mass_kg", 1}, {"inertia_kg_m2", std::vector<double>(n, 1.0)}}, jobs::body_fields(), "", faults);
    EXPECT_EQ(is_between(schema, n) && !is_between(schema.at("not"), n), faults.empty()) << n;
  }
}

TEST(LinkageSchema, TakesThePlaceOfAMoment) {
  const json load{{"body", "beam"}, {"at_m", {0.1, 0, 0}}, {"direction", {0, 0, 1}}, {"torque_n_m", 1}};
  std::vector<jobs::Fault> faults;
  jobs::check_body_load(load, "", faults);
  EXPECT_TRUE(faults.empty());
  const json schema = described_schema().at("loads").at("additionalProperties");
  for (const json& one : schema.at("oneOf")) EXPECT_EQ(one.size(), 1U) << "required alone";
}

}  // namespace
}  // namespace jobs_tests
