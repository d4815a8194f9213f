// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "jobs/base/content_id.h"
#include "jobs/parameters/job_spec.h"
#include "jobs/parameters/parameter_table.h"
#include "jobs/requests/parameters.h"
#include "tests/jobs/request_support.h"

namespace jobs_tests {
namespace {

using nlohmann::json;

struct ParameterFaultCase {
  const char* name;
  const char* given;
  const char* pointer;
  const char* says;  ///< part of the detail
};
void PrintTo(const ParameterFaultCase& c, std::ostream* out) { *out << c.name; }

class ParameterFault : public testing::TestWithParam<ParameterFaultCase> {};

TEST_P(ParameterFault, IsNamedWithItsPlaceAndRange) {
  const auto faults =
      faults_of([] { (void)jobs::complete_parameters(json_of(GetParam().given), "/parameters"); });
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].pointer, std::string("/parameters") + GetParam().pointer);
  EXPECT_NE(faults[0].detail.find(GetParam().says), std::string::npos) << faults[0].detail;
}

constexpr ParameterFaultCase kParameterFaults[] = {
    {"not_an_object", "[1]", "", "object"},
    {"unknown_key", R"({"colour": 1})", "/colour", "unknown key; all are listed at GET /v1/parameters"},
    {"parameters_one_level_too_deep", R"({"parameters": {"clearance_mm": 1}})", "/parameters",
     "parameters stand in this object itself"},
    {"sweep_for_one_set", R"({"sweep": {"clearance_mm": [0.1, 0.2]}})", "/sweep",
     "in a sweep (POST /v1/sweeps, rpsup sweep)"},
    {"link_by_its_path", R"({"links.1,3.mass_kg": 1})", "/links.1,3.mass_kg", "written as an object"},
    {"near_key_without_unit", R"({"clearance": 1})", "/clearance", "did you mean clearance_mm?"},
    {"near_key_with_a_slip", R"({"crank_velocty_rad_s": 1})", "/crank_velocty_rad_s",
     "did you mean crank_velocity_rad_s?"},
    {"key_with_a_slash", R"({"a/b~c": 1})", "/a~1b~0c", "unknown key"},
    {"text_for_number", R"({"clearance_mm": "0.25"})", "/clearance_mm", "must be a number in [0, 1000) mm"},
    {"boolean_for_number", R"({"clearance_mm": true})", "/clearance_mm", "must be a number"},
    {"null_for_number", R"({"clearance_mm": null})", "/clearance_mm", "must be a number"},
    {"negative_clearance", R"({"clearance_mm": -0.1})", "/clearance_mm", "[0, 1000)"},
    {"clearance_at_its_open_end", R"({"clearance_mm": 1000})", "/clearance_mm",
     "must be a number in [0, 1000) mm"},
    {"clearance_of_bearing_radius", R"({"clearance_mm": 5})", "/clearance_mm",
     "less than bearing_radius_mm, which is 5 mm"},
    {"clearance_between_atoms", R"({"clearance_mm": 1e-7})", "/clearance_mm", "at least 1e-06 mm"},
    {"duration_zero", R"({"duration_s": 0})", "/duration_s", "in (0, 3600] s"},
    {"duration_too_long", R"({"duration_s": 3600.1, "output_rate_hz": 1})", "/duration_s", "in (0, 3600] s"},
    {"rate_zero", R"({"output_rate_hz": 0})", "/output_rate_hz", "(0, 100000] Hz"},
    {"too_many_samples", R"({"duration_s": 30, "output_rate_hz": 100000})", "/output_rate_hz",
     "3000000 samples; at most 2000000"},
    {"too_many_values",
     R"({"duration_s": 20, "output_rate_hz": 100000, "coupler": "flexible", "rigid_elements": 64})",
     "/output_rate_hz", "values"},
    {"too_many_rk4_steps", R"({"integrator": "rk4", "step_s": 1e-8})", "/step_s",
     "500000000 steps; at most 100000000"},
    {"step_too_long", R"({"step_s": 0.01})", "/step_s", "[1e-08, 0.001] s"},
    {"tolerance_zero", R"({"relative_tolerance": 0})", "/relative_tolerance", "[1e-13, 0.01]"},
    {"negative_run_up", R"({"run_up_s": -1})", "/run_up_s", "[0, 3600] s"},
    {"unknown_word", R"({"coupler": "elastic"})", "/coupler", R"(must be "rigid" or "flexible")"},
    {"number_for_word", R"({"coupler": 1})", "/coupler", R"("rigid" or "flexible")"},
    {"unknown_integrator", R"({"integrator": "euler"})", "/integrator", R"("dopri5")"},
    {"fraction_for_integer", R"({"rigid_elements": 4.5})", "/rigid_elements",
     "must be an integer in [2, 64]"},
    {"boolean_for_integer", R"({"rigid_elements": true})", "/rigid_elements", "an integer"},
    {"too_few_elements", R"({"rigid_elements": 1})", "/rigid_elements", "[2, 64]"},
    {"integer_too_large_for_int", R"({"radial_elements": 99999999999})", "/radial_elements", "[3, 10000]"},
    {"negative_integer", R"({"radial_levels": -1})", "/radial_levels", "[1, 16]"},
    {"restitution_zero_by_a_law_without_one", R"({"restitution": 0, "normal_law": "hu_guo"})", "/restitution", "above 0 with"},
    {"restitution_below_zero", R"({"restitution": -0.01})", "/restitution", "[0, 1]"},
    {"restitution_above_one", R"({"restitution": 1.01})", "/restitution", "[0, 1]"},
    {"impossible_poisson_ratio", R"({"youngs_modulus_pa": 2.41e11})", "/youngs_modulus_pa",
     "3 times shear_modulus_pa"},
    {"solid_beyond_its_tube", R"({"crank_inner_diameter_mm": 28})", "/crank_inner_diameter_mm",
     "less than crank_diameter_mm, which is 28 mm"},
    {"rod_thinner_than_its_bore", R"({"rod_diameter_mm": 5, "rod_inner_diameter_mm": 6})",
     "/rod_inner_diameter_mm", "less than rod_diameter_mm"},
    {"one_element_of_the_crank", R"({"crank": "flexible", "crank_elements": 1})", "/crank_elements",
     "[2, 64]"},
    {"elastic_rod", R"({"rod": "elastic"})", "/rod", R"(must be "rigid" or "flexible")"},
    {"flexible_cross_without_length", R"({"cross": "flexible"})", "/cross_length_mm",
     "at least 1 mm, as the cross link is flexible"},
    {"hair_of_a_cross", R"({"cross_length_mm": 0.5})", "/cross_length_mm", "must be 0"},
    {"cross_triangle_broken_about_the_centre",
     R"({"cross_length_mm": 100, "links": {"2,2": {"inertia_kg_m2": [1e-4, 1e-4, 1e-5]}}})",
     "/links/2,2/inertia_kg_m2", "I_x and I_y"},
    {"too_many_values_of_links",
     R"({"duration_s": 20, "output_rate_hz": 100000, "crank": "flexible", "crank_elements": 64})",
     "/output_rate_hz", "values"},
    {"unknown_yoke_axis", R"({"yoke_axis": "x"})", "/yoke_axis", R"(must be "guide" or "across")"},
    {"unknown_direction_of_gravity", R"({"gravity_direction": "down"})", "/gravity_direction", R"("-z")"},
    {"unknown_law_of_the_rod", R"({"rod_law": "sine"})", "/rod_law",
     R"("cycloidal", "cosine" or "parabolic")"},
    {"crank_start_beyond_its_range", R"({"crank_start_rad": 10.1})", "/crank_start_rad", "[-10, 10] rad"},
    {"guide_angle_beyond_its_range", R"({"guide_angle_deg": 181})", "/guide_angle_deg", "[-180, 180] deg"},
    {"rod_start_beyond_its_range", R"({"rod_start_m": -101})", "/rod_start_m", "[-100, 100] m"},
    {"rod_start_out_of_reach", R"({"rod_start_m": 0.5})", "/rod_start_m", "must be longer than"},
    // The guide is the global x axis, and the crank rests along it.
    {"guide_through_the_crank_centre", R"({"guide_offset_z_m": 0, "crank_velocity_rad_s": 0})",
     "/guide_offset_z_m", "not further than the cross link's 0 mm"},
    // tan(57.143 degrees) = 0.24 / 0.155: the guide meets the plane of the crank at x = -0.155 m, where the
    // stroke from 0.15 m to 0.165 m passes.
    {"stroke_through_the_guide",
     R"({"guide_angle_deg": 57.143, "crank_velocity_rad_s": 0, "crank_start_rad": 3.141592653589793})",
     "/guide_angle_deg", "the linkage locks at t = "},
    {"guide_out_of_reach", R"({"guide_offset_z_m": 0.6})", "/guide_offset_z_m", ""},
    {"links_no_object", R"({"links": []})", "/links", "object"},
    {"unknown_link", R"({"links": {"3,1": {}}})", "/links/3,1", "unknown link"},
    {"link_no_object", R"({"links": {"1,1": 2}})", "/links/1,1", "mass_kg and inertia_kg_m2"},
    {"unknown_part_of_link", R"({"links": {"1,1": {"mass": 1}}})", "/links/1,1/mass",
     "did you mean mass_kg?"},
    {"mass_zero", R"({"links": {"1,1": {"mass_kg": 0}}})", "/links/1,1/mass_kg", "(0, 1000000] kg"},
    {"two_moments", R"({"links": {"1,1": {"inertia_kg_m2": [1, 1]}}})", "/links/1,1/inertia_kg_m2",
     "three moments"},
    {"moment_zero", R"({"links": {"2,1": {"inertia_kg_m2": [1, 0, 1]}}})", "/links/2,1/inertia_kg_m2/1",
     "(0, 1000000000]"},
    {"triangle_broken", R"({"links": {"2,1": {"inertia_kg_m2": [3, 1, 1.9]}}})", "/links/2,1/inertia_kg_m2",
     "sum of the other two"},
    // I_y about the origin is less than m (l/2)^2 = 0.306 * 0.25^2 = 0.019125.
    {"negative_about_the_centre", R"({"links": {"1,3": {"inertia_kg_m2": [3.8e-6, 0.019, 0.019]}}})",
     "/links/1,3/inertia_kg_m2", "0.019125"},
    // 0.02 and 0.0201 obey the triangle about the origin with I_x = 2e-4, but not with 5e-5.
    {"triangle_broken_about_the_centre", R"({"links": {"1,3": {"inertia_kg_m2": [5e-5, 0.02, 0.0201]}}})",
     "/links/1,3/inertia_kg_m2", "sum of the other two"},
    {"run_up_of_no_step", R"({"run_up_s": 1e-12})", "/run_up_s", "must be 0 (at full velocity from the start) or"},
    {"ramp_that_falls", R"({"friction": "ambrosio", "friction_velocity_1_m_s": 1e-5})", "/friction_velocity_1_m_s",
     "above friction_velocity_0_m_s"},
};

INSTANTIATE_TEST_SUITE_P(All, ParameterFault, testing::ValuesIn(kParameterFaults),
                         [](const auto& tested) { return tested.param.name; });

TEST(CompleteParameters, ReportsEveryFaultAtOnce) {
  const json given = json_of(
      R"({"coupler": 1, "clearance_mm": -1, "x": 0, "links": {"1,1": {"mass_kg": -1, "inertia_kg_m2": [0, -1,
         1]}}})");
  const std::vector<std::string> expected{
      "/clearance_mm",      "/coupler", "/links/1,1/inertia_kg_m2/0", "/links/1,1/inertia_kg_m2/1",
      "/links/1,1/mass_kg", "/x"};
  EXPECT_EQ(pointers_of(faults_of([&] { (void)jobs::complete_parameters(given, ""); })), expected);
}

TEST(CompleteParameters, RefusesNumbersThatAreNotFinite) {
  for (const double x :
       {std::nan(""), std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
    for (const char* key : {"gravity_m_s2", "clearance_mm", "rigid_elements"}) {
      EXPECT_EQ(pointers_of(faults_of([&] {
                  (void)jobs::complete_parameters({{key, x}}, "");
                })),
                (std::vector<std::string>{std::string("/") + key}))
          << x;
    }
  }
}

TEST(CompleteParameters, AcceptsTheEdgesOfRanges) {
  const json given = json_of(
      R"({"clearance_mm": 4.999, "duration_s": 3600, "output_rate_hz": 1, "crank_velocity_rad_s": 0,
         "restitution": 1,
                                 "run_up_s": 0, "rigid_elements": 64, "axial_stiffness_n_m": 0,
         "youngs_modulus_pa": 2.4e11, "step_s": 1e-8})");
  const json completed = jobs::complete_parameters(given, "");
  for (const auto& [key, value] : given.items()) EXPECT_EQ(completed.at(key), value) << key;
}

TEST(CompleteParameters, AcceptsAGuideThroughTheCrankCentreWithTheYokeAcross) {
  EXPECT_NO_THROW((void)jobs::complete_parameters({{"guide_offset_z_m", 0}, {"yoke_axis", "across"}}, ""));
}

TEST(CompleteParameters, AcceptsEveryNormalLawOfContactElements) {
  for (const char* law : {"lankarani_nikravesh", "kelvin_voigt"})
    EXPECT_NO_THROW((void)jobs::complete_parameters({{"contact", "elements"}, {"normal_law", law}}, ""))
        << law;
}

// The paper's values and those of the model's description, written down here by hand.
TEST(CompleteParameters, FillsInTheDefaults) {
  const json expected = json_of(R"({
    "coupler": "rigid", "clearance_mm": 0.25, "axial_clearance_mm": 0, "crank_velocity_rad_s": 10,
                                   "duration_s": 5, "output_rate_hz": 1000,
    "run_up_s": 2, "crank_start_rad": 0, "rod_start_m": 0.15, "rod_stroke_mm": 15, "rod_stroke_time_s": 0.5,
                                   "rod_pause_s": 0.5,
    "rod_law": "cosine", "drive": "prescribed", "baumgarte_alpha_1_s": 100,
    "baumgarte_beta_1_s": 100, "contact": "continuum", "radial_levels": 3, "radial_elements": 180,
                                   "axial_levels": 1, "axial_elements": 8,
    "bearing_radius_mm": 5, "bearing_length_mm": 16, "normal_law": "lankarani_nikravesh", "restitution": 0.9,
    "contact_damping_n_s_m": 1000, "stiffness_law": "hertz", "contact_stiffness_scale": 1,
                                   "axial_stiffness_n_m": 8.5e5,
    "minimum_impact_velocity_m_s": 0.001, "friction": "lugre", "friction_static": 0.1,
                                   "friction_kinetic": 0.2, "bristle_stiffness_1_m": 100,
    "bristle_damping_s_m": 5, "bristle_viscous_s_m": 0, "stribeck_velocity_m_s": 0.001,
                                   "break_away_ratio": 0.7,
    "friction_velocity_0_m_s": 1e-4, "friction_velocity_1_m_s": 1e-3, "rigid_elements": 4,
                                   "youngs_modulus_pa": 2.1e11,
    "shear_modulus_pa": 0.8e11, "coupler_diameter_mm": 10, "coupler_damping_ratio": 0.0005,
                                   "integrator": "auto", "step_s": 1e-5,
    "relative_tolerance": 1.5e-5, "absolute_tolerance": 1.5e-5, "crank_length_m": 0.2, "rod_length_m": 0.2,
                                   "coupler_length_m": 0.5,
    "guide_offset_y_m": 0, "guide_offset_z_m": 0.24, "guide_angle_deg": 0, "yoke_axis": "guide",
                                   "gravity_m_s2": 9.81,
    "gravity_direction": "-z", "linkage": "rpsup",
    "crank": "rigid", "crank_diameter_mm": 28, "crank_inner_diameter_mm": 20, "crank_elements": 4,
                                   "crank_damping_ratio": 0.01,
    "rod": "rigid", "rod_diameter_mm": 20, "rod_inner_diameter_mm": 0, "rod_elements": 4,
                                   "rod_damping_ratio": 0.01,
    "cross": "rigid", "cross_diameter_mm": 20, "cross_inner_diameter_mm": 15, "cross_elements": 4,
                                   "cross_damping_ratio": 0.01, "cross_length_mm": 0})");
  json completed = jobs::complete_parameters(json::object(), "");
  completed.erase("links");
  EXPECT_EQ(completed, expected);
}

// The paper's Table 1, with the rows of (2,1) and (2,2) read as bodies. The rods' I_y follow from the printed
// masses, which have three digits.
TEST(CompleteParameters, FillsInTheLinks) {
  const json expected =
      json_of(R"({"1,1": [0.471, 6.964e-5, 6.309e-3, 6.309e-3], "1,2": [0.490, 2.451e-5, 6.548e-3, 6.548e-3],
    "1,3": [0.306, 3.829e-6, 2.553e-2, 2.553e-2], "2,1": [0.780, 8.126e-4, 1.885e-4, 6.76e-4], "2,2": [0.107,
                 9.354e-5, 9.354e-5, 8.377e-6]})");
  const json links = jobs::complete_parameters(json::object(), "").at("links");
  ASSERT_EQ(links.size(), expected.size());
  for (const auto& [link, row] : expected.items()) {
    EXPECT_EQ(links.at(link).at("mass_kg"), row[0]) << link;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(links.at(link).at("inertia_kg_m2")[axis].get<double>() / row[axis + 1].get<double>(), 1.0,
                  1.2e-3)
          << link;
    }
  }
}

TEST(CompleteParameters, OfItsOwnResultChangesNothing) {
  const json once = jobs::complete_parameters({{"coupler_length_m", 0.6}, {"coupler", "flexible"}}, "");
  EXPECT_EQ(jobs::complete_parameters(once, ""), once);
}

TEST(ToJobSpec, GivesTheEnginesDefaultsToTheLastBit) {
  const jobs::JobSpec spec = jobs::to_job_spec(jobs::complete_parameters(json::object(), ""));
  const engine::RpsupParameters defaults;
  for (const jobs::ParameterInfo& info : jobs::parameter_table()) {
    EXPECT_EQ(info.read(spec), info.read(jobs::JobSpec{})) << info.key;
  }
  for (std::size_t i = 0; i < defaults.links.size(); ++i) {
    EXPECT_EQ(spec.parameters.links[i].mass, defaults.links[i].mass);
    EXPECT_EQ(spec.parameters.links[i].inertia, defaults.links[i].inertia);
  }
  EXPECT_EQ(spec.parameters.c_r, 0.25e-3);
  EXPECT_EQ(spec.parameters.bearing_radius, 5e-3);
}

TEST(ToJobSpec, ConvertsMillimetresAndWords) {
  const json given = json_of(
      R"({"clearance_mm": 0.5, "axial_clearance_mm": 0.1, "bearing_radius_mm": 8, "bearing_length_mm": 30,
         "rod_stroke_mm": 20,
    "coupler_diameter_mm": 12, "coupler": "flexible", "drive": "baumgarte", "contact": "elements",
         "friction": "none", "integrator": "rk4",
    "radial_elements": 36.0, "crank_velocity_rad_s": 12, "duration_s": 4, "crank": "flexible",
         "rod_inner_diameter_mm": 8, "cross_length_mm": 60,
    "cross_elements": 6})");
  const jobs::JobSpec spec = jobs::to_job_spec(jobs::complete_parameters(given, ""));
  EXPECT_EQ(spec.parameters.c_r, 0.0005);
  EXPECT_EQ(spec.parameters.c_a, 0.0001);
  EXPECT_EQ(spec.parameters.bearing_radius, 0.008);
  EXPECT_EQ(spec.parameters.bearing_length, 0.03);
  EXPECT_EQ(spec.parameters.rod_stroke, 0.02);
  EXPECT_EQ(spec.parameters.coupler_diameter, 0.012);
  EXPECT_EQ(spec.parameters.coupler, engine::Coupler::kFlexible);
  EXPECT_EQ(spec.parameters.drive, engine::DriveEnforcement::kBaumgarte);
  EXPECT_EQ(spec.parameters.contact, engine::ContactForm::kElements);
  EXPECT_EQ(spec.parameters.friction, engine::FrictionLaw::kNone);
  EXPECT_EQ(spec.options.integrator, engine::Integrator::kRk4);
  EXPECT_EQ(spec.parameters.radial_elements, 36);
  EXPECT_EQ(spec.parameters.crank.model, engine::LinkModel::kFlexible);
  EXPECT_EQ(spec.parameters.rod.model, engine::LinkModel::kRigid);
  EXPECT_EQ(spec.parameters.rod.inner_diameter, 0.008);
  EXPECT_EQ(spec.parameters.cross_length, 0.06);
  EXPECT_EQ(spec.parameters.cross.elements, 6);
  EXPECT_EQ(spec.parameters.crank_velocity, 12.0);
  EXPECT_EQ(spec.options.duration, 4.0);
}

TEST(ToJobSpec, RefusesAWordThatAnOlderProgramHasStored) {
  json stored = jobs::complete_parameters(json::object(), "");
  stored["integrator"] = "rodas4";
  try {
    (void)jobs::to_job_spec(stored);
    FAIL() << "nothing was thrown";
  } catch (const jobs::InvalidRequest& refused) {
    EXPECT_STREQ(refused.what(), R"(/integrator: this version does not know "rodas4")");
  }
}

TEST(CompleteParameters, NamesTheIntegratorsThatThereAre) {
  try {
    (void)jobs::complete_parameters({{"integrator", "rodas4"}}, "");
    FAIL() << "nothing was thrown";
  } catch (const jobs::InvalidRequest& refused) {
    EXPECT_STREQ(refused.what(), R"(/integrator: must be "auto", "radau5", "rodas5", "dopri5" or "rk4")");
  }
}

TEST(ContentId, IsSha256OfTextAndVersion) {
  // printf 'abc\n0.1' | sha256sum
  EXPECT_EQ(jobs::content_id("abc", "0.1"),
            "5fb98a8be7c2ac87cc286d0b06e5efc852a687ace2ba983e3e824e538038992b");
  EXPECT_EQ(jobs::sha256_hex("ab", "c\n0.1"), jobs::content_id("abc", "0.1")) << "a text in two parts";
  EXPECT_NE(jobs::content_id("abc", "0.2"), jobs::content_id("abc", "0.1"));
}

TEST(ToJobSpec, ConvertsDegreesAndTheWordsOfTheGeometry) {
  const json given = json_of(
      R"({"guide_angle_deg": 30, "yoke_axis": "across", "gravity_direction": "-x", "rod_law": "parabolic",
    "rod_start_m": 0.18, "crank_start_rad": -0.5})");
  const engine::RpsupParameters p = jobs::to_job_spec(jobs::complete_parameters(given, "")).parameters;
  EXPECT_DOUBLE_EQ(p.guide_angle, std::numbers::pi / 6.0);
  EXPECT_EQ(p.yoke_axis, engine::YokeAxis::kAcross);
  EXPECT_EQ(p.gravity_direction, engine::Direction::kMinusX);
  EXPECT_EQ(p.rod_law, engine::StrokeLaw::kParabolic);
  EXPECT_EQ(p.rod_start, 0.18);
  EXPECT_EQ(p.crank_start, -0.5);
}

TEST(CanonicalText, IsOneForAllWaysToWriteTheSameParameters) {
  const auto text = [](const char* given) {
    return jobs::canonical_text(jobs::complete_parameters(json_of(given), ""));
  };
  const std::string defaults = text("{}");
  EXPECT_EQ(text(R"({"crank_velocity_rad_s": 10, "clearance_mm": 0.250})"), defaults);
  EXPECT_EQ(text(R"({"clearance_mm": 2.5e-1, "crank_velocity_rad_s": 10.0, "rigid_elements": 4.0})"),
            defaults);
  EXPECT_EQ(text(R"({"guide_offset_y_m": -0.0})"), defaults);
  EXPECT_EQ(text(R"({"links": {"1,3": {"mass_kg": 0.306}}})"), defaults);
  EXPECT_NE(text(R"({"clearance_mm": 0.26})"), defaults);
}

TEST(Channels, AreMoreThanOneFewerThanThereAreAndNotMoreThanThemselves) {
  const json all_flexible{{"coupler", "flexible"}, {"rigid_elements", 64}, {"crank", "flexible"},
                          {"crank_elements", 64},  {"rod", "flexible"},    {"rod_elements", 64},
                          {"cross", "flexible"},   {"cross_elements", 64}, {"cross_length_mm", 100},
                          {"radial_levels", 16}};
  json largest = all_flexible;
  largest["wear_depth_um"] = std::vector<std::vector<double>>(16, std::vector<double>(8, 1.0));
  for (const json& given :
       {json::object(), json{{"coupler", "flexible"}, {"rigid_elements", 64}}, all_flexible, largest}) {
    const jobs::JobSpec spec = jobs::to_job_spec(jobs::complete_parameters(given, ""));
    const auto channels = static_cast<double>(jobs::channel_table(spec).size());
    EXPECT_TRUE(jobs::has_more_channels(spec, channels - 1.0)) << given;
    EXPECT_FALSE(jobs::has_more_channels(spec, channels)) << given;
  }
}

}  // namespace
}  // namespace jobs_tests
