// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "jobs/requests/expand.h"
#include "jobs/requests/parameter_path.h"
#include "tests/jobs/request_support.h"

namespace jobs_tests {
namespace {

struct SweepFaultCase {
  const char* name;
  const char* request;
  const char* pointer;
  const char* says;
};
void PrintTo(const SweepFaultCase& c, std::ostream* out) { *out << c.name; }

class SweepFault : public testing::TestWithParam<SweepFaultCase> {};

TEST_P(SweepFault, IsNamedWithItsPlace) {
  const auto faults = faults_of([] { (void)jobs::plan_sweep(request_of(GetParam().request), 10'000); });
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].pointer, GetParam().pointer);
  EXPECT_NE(faults[0].detail.find(GetParam().says), std::string::npos) << faults[0].detail;
}

TEST(SweepFaults, OfAListThatAParameterIsSayNothingOfSweeping) {
  const auto faults = faults_of([] {
    (void)jobs::plan_sweep(request_of(R"({"parameters": {"links": {"1,3": {"inertia_kg_m2": [1, 2]}}}})"),
                           10'000);
  });
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].detail.find("sweep"), std::string::npos) << faults[0].detail;
}

constexpr SweepFaultCase kSweepFaults[] = {
    {"not_an_object", "[]", "", "object"},
    {"unknown_key", R"({"swep": {}})", "/swep", "did you mean sweep?"},
    {"swapped_letters", R"({"swepe": {}})", "/swepe", "did you mean sweep?"},
    {"key_of_another_tool", R"({"axes": {}})", "/axes",
     "unknown key; allowed: name, parameters, sweep, design, cases, replicates, keep, reuse, priority, executor"},
    {"parameter_at_the_top", R"({"clearance_mm": 1})", "/clearance_mm", "under \"parameters\""},
    {"name_no_text", R"({"name": 1})", "/name", "string"},
    {"reuse_no_boolean", R"({"reuse": 1})", "/reuse", "true or false"},
    {"value_of_parameters", R"({"parameters": {"clearance_mm": -1}})", "/parameters/clearance_mm",
     "[0, 1000)"},
    {"list_in_parameters", R"({"parameters": {"clearance_mm": [0.1, 0.5]}})", "/parameters/clearance_mm",
     "several values stand under \"sweep\""},
    {"words_in_parameters", R"({"parameters": {"coupler": ["rigid"]}})", "/parameters/coupler",
     "several values stand under \"sweep\""},
    {"masses_in_parameters", R"({"parameters": {"links": {"1,3": {"mass_kg": [0.2, 0.4]}}}})",
     "/parameters/links/1,3/mass_kg", "several values stand under \"sweep\""},
    {"span_in_a_case", R"({"cases": [{"clearance_mm": {"from": 1, "to": 2, "count": 2}}]})",
     "/cases/0/clearance_mm", "several values stand under \"sweep\""},
    {"sweep_no_object", R"({"sweep": []})", "/sweep", "object"},
    {"unknown_axis", R"({"sweep": {"clearence_mm": [1]}})", "/sweep/clearence_mm",
     "did you mean clearance_mm?"},
    {"whole_links_as_axis", R"({"sweep": {"links": [1]}})", "/sweep/links", "links.1,3.mass_kg"},
    {"unknown_dotted_axis", R"({"sweep": {"links.1,3.mas_kg": [1]}})", "/sweep/links.1,3.mas_kg",
     "did you mean links.1,3.mass_kg?"},
    {"empty_axis", R"({"sweep": {"clearance_mm": []}})", "/sweep/clearance_mm", "one value or more"},
    {"scalar_axis", R"({"sweep": {"clearance_mm": 1}})", "/sweep/clearance_mm", "must be a list"},
    {"bad_value", R"({"sweep": {"clearance_mm": [0, 0.1, -1]}})", "/sweep/clearance_mm/2", "[0, 1000)"},
    {"bad_dotted_value", R"({"sweep": {"links.1,3.mass_kg": [0.3, 0]}})", "/sweep/links.1,3.mass_kg/1",
     "(0, 1000000] kg"},
    {"value_twice", R"({"sweep": {"clearance_mm": [0.5, 0, 0.50]}})", "/sweep/clearance_mm/2", "already"},
    {"integer_and_number_twice", R"({"sweep": {"crank_velocity_rad_s": [5, 5.0]}})",
     "/sweep/crank_velocity_rad_s/1", "already"},
    {"word_twice", R"({"sweep": {"coupler": ["rigid", "rigid"]}})", "/sweep/coupler/1", "already"},
    {"span_of_words", R"({"sweep": {"coupler": {"from": 1, "to": 2, "count": 2}}})", "/sweep/coupler",
     "must be a list"},
    {"span_without_to", R"({"sweep": {"clearance_mm": {"from": 1, "count": 2}}})", "/sweep/clearance_mm/to",
     "missing"},
    {"span_without_count", R"({"sweep": {"clearance_mm": {"from": 1, "to": 2}}})",
     "/sweep/clearance_mm/count", "missing"},
    {"span_with_step", R"({"sweep": {"clearance_mm": {"from": 1, "to": 2, "count": 2, "step": 1}}})",
     "/sweep/clearance_mm/step", "unknown key"},
    {"span_of_unknown_scale",
     R"({"sweep": {"clearance_mm": {"from": 1, "to": 2, "count": 2, "scale": "cubic"}}})",
     "/sweep/clearance_mm/scale", "\"log\""},
    {"span_count_fraction", R"({"sweep": {"clearance_mm": {"from": 1, "to": 2, "count": 2.5}}})",
     "/sweep/clearance_mm/count", "integer"},
    {"span_count_zero", R"({"sweep": {"clearance_mm": {"from": 1, "to": 2, "count": 0}}})",
     "/sweep/clearance_mm/count", "integer"},
    {"span_of_one", R"({"sweep": {"clearance_mm": {"from": 1, "to": 2, "count": 1}}})",
     "/sweep/clearance_mm/count", "2 or more"},
    {"span_of_equal_ends", R"({"sweep": {"clearance_mm": {"from": 1, "to": 1, "count": 2}}})",
     "/sweep/clearance_mm/to", "already"},
    {"span_end_out_of_range", R"({"sweep": {"restitution": {"from": 0.5, "to": 1.5, "count": 2}}})",
     "/sweep/restitution/to", "value 1.5: must be"},
    {"log_from_zero", R"({"sweep": {"clearance_mm": {"from": 0, "to": 1, "count": 2, "scale": "log"}}})",
     "/sweep/clearance_mm/from", "above 0"},
    {"span_of_broken_integers", R"({"sweep": {"rigid_elements": {"from": 2, "to": 5, "count": 3}}})",
     "/sweep/rigid_elements", "value 3.5: must be an integer"},
    {"log_too_wide",
     R"({"sweep": {"bristle_stiffness_1_m": {"from": 1e-310, "to": 1e9, "count": 3, "scale": "log"}}})",
     "/sweep/bristle_stiffness_1_m/to", "times from"},
    {"log_too_wide_down",
     R"({"sweep": {"bristle_stiffness_1_m": {"from": 1e9, "to": 1e-310, "count": 3, "scale": "log"}}})",
     "/sweep/bristle_stiffness_1_m/to", "times from"},
    {"axis_in_parameters", R"({"parameters": {"clearance_mm": 1}, "sweep": {"clearance_mm": [1]}})",
     "/sweep/clearance_mm", "parameters"},
    {"dotted_axis_in_parameters",
     R"({"parameters": {"links": {"1,3": {"mass_kg": 0.3}}}, "sweep": {"links.1,3.mass_kg": [0.3]}})",
     "/sweep/links.1,3.mass_kg", "parameters"},
    {"cases_no_list", R"({"cases": {}})", "/cases", "list"},
    {"no_cases", R"({"cases": []})", "/cases", "one parameter object or more"},
    {"case_no_object", R"({"cases": [1]})", "/cases/0", "object"},
    {"value_of_case", R"({"cases": [{}, {"clearance_mm": -1}]})", "/cases/1/clearance_mm", "[0, 1000)"},
    {"case_twice", R"({"cases": [{"clearance_mm": 1}, {"clearance_mm": 1}]})", "/cases/1", "already"},
    {"case_in_parameters", R"({"parameters": {"clearance_mm": 1}, "cases": [{"clearance_mm": 2}]})",
     "/cases/0/clearance_mm", "parameters"},
    {"case_in_axis", R"({"sweep": {"clearance_mm": [1]}, "cases": [{"clearance_mm": 2}]})",
     "/cases/0/clearance_mm", "axis"},
    {"replicates_number", R"({"replicates": 3})", "/replicates", "object"},
    {"replicates_without_count", R"({"replicates": {"seed": 1}})", "/replicates/count", "missing"},
    {"replicates_count_zero", R"({"replicates": {"count": 0}})", "/replicates/count", "integer"},
    {"perturbation_zero", R"({"replicates": {"count": 2, "perturbation": 0}})", "/replicates/perturbation",
     "(0, 0.1]"},
    {"tolerance_factor_above_one", R"({"replicates": {"count": 2, "tolerance_factor": 2}})",
     "/replicates/tolerance_factor", "(0, 1]"},
    {"tightened_out_of_range", R"({"replicates": {"count": 2, "tolerance_factor": 1e-9}})",
     "/replicates/tolerance_factor", "relative_tolerance out of its range"},
    {"seed_negative", R"({"replicates": {"count": 2, "seed": -1}})", "/replicates/seed", "integer"},
    {"replicates_unknown_key", R"({"replicates": {"count": 2, "sed": 1}})", "/replicates/sed",
     "did you mean seed?"},
    {"replicated_values_unlisted", R"({"replicates": {"count": 2, "only": {"clearance_mm": 1}}})",
     "/replicates/only/clearance_mm", "list of one value or more"},
    {"replicated_values_of_no_parameter", R"({"replicates": {"count": 2, "only": {"": [{}]}}})",
     "/replicates/only/", "unknown key"},
    {"replicated_values_of_many", R"({"replicates": {"count": 2, "only": {"links": [{}]}}})",
     "/replicates/only/links", "one value"},
    {"replicated_linkages", R"({"replicates": {"count": 2, "only": {"linkage": [{}]}}})",
     "/replicates/only/linkage", "one value"},
    {"replicated_value_out_of_range", R"({"replicates": {"count": 2, "only": {"clearance_mm": [1, -1]}}})",
     "/replicates/only/clearance_mm/1", "[0, 1000)"},
    {"perturbed_out_of_range",
     R"({"parameters": {"contact_stiffness_scale": 1e6}, "replicates": {"count": 20, "perturbation": 0.1}})",
     "/replicates/perturbation", "[1e-06, 1000000]"},
    // Combinations: which place gave the value, which points have the fault.
    {"clearance_of_bearing",
     R"({"sweep": {"clearance_mm": [1, 6], "bearing_radius_mm": [5, 6, 7], "coupler": ["rigid"]}})",
     "/sweep/clearance_mm",
     "which is 5 mm (at clearance_mm = 6.0, bearing_radius_mm = 5.0, coupler = \"rigid\"); likewise at 1 "
     "more points"},
    {"reach_of_the_point", R"({"sweep": {"guide_offset_z_m": [0.2, 0.49]}})", "/sweep/guide_offset_z_m",
     "(at guide_offset_z_m = 0.49)"},
    {"reach_of_the_case", R"({"cases": [{}, {"coupler_length_m": 0.28}]})", "/cases/1/coupler_length_m",
     "(at coupler_length_m = 0.28)"},
    {"inertia_of_the_axis",
     R"({"parameters": {"links": {"1,3": {"inertia_kg_m2": [4e-6, 0.02, 0.02]}}},
        "sweep": {"links.1,3.mass_kg": [0.3, 0.4]}})",
     "/parameters/links/1,3/inertia_kg_m2", "(at links.1,3.mass_kg = 0.4)"},
};

INSTANTIATE_TEST_SUITE_P(All, SweepFault, testing::ValuesIn(kSweepFaults),
                         [](const auto& tested) { return tested.param.name; });

TEST(SweepFaults, AreAllReportedAtOnce) {
  const auto faults = faults_of([] {
    (void)jobs::plan_sweep(
        request_of(
            R"({"name": 3, "parameters": {"coupler": 1}, "sweep": {"x": [1], "clearance_mm": [-1, 1, -2]},
               "cases": [{"y": 1}],
                                          "replicates": {"count": "two"}, "extra": 0})"),
        10'000);
  });
  EXPECT_EQ(
      pointers_of(faults),
      (std::vector<std::string>{"/cases/0/y", "/extra", "/name", "/parameters/coupler", "/replicates/count",
                                "/sweep/clearance_mm/0", "/sweep/clearance_mm/2", "/sweep/x"}));
}

TEST(SweepFaults, AreAllThereWhenPlacesClash) {
  const auto faults = faults_of([] {
    (void)jobs::plan_sweep(
        request_of(R"({"name": 1, "cases": [{"clearance_mm": 0.1}], "sweep": {"clearance_mm": [0.1, -1]}})"),
        10'000);
  });
  EXPECT_EQ(pointers_of(faults),
            (std::vector<std::string>{"/cases/0/clearance_mm", "/name", "/sweep/clearance_mm/1"}));
}

TEST(SweepFaults, AreNamedBesideASizeThatIsTooLarge) {
  const auto faults = faults_of(
      [] { (void)jobs::plan_sweep(request_of(R"({"name": 1, "replicates": {"count": 10001}})"), 10'000); });
  EXPECT_EQ(pointers_of(faults), (std::vector<std::string>{"/name", "/replicates/count"}));
}

// Unknown names give no paths and one fault each. Faults of the places below, which may be many, would repeat
// a long name.
TEST(SweepFaults, ComeFromKnownPlacesOnly) {
  EXPECT_EQ(jobs::paths_of(request_of(R"({"x": 1, "clearance_mm": 1, "wear_depth_um": [],
                                          "links": {"9,9": {"mass_kg": 1}, "1,3": {"mass_kg": 1, "mas": 2},
                                         "2,1": 3}})")),
            (std::vector<std::string>{"clearance_mm", "wear_depth_um", "links.1,3.mass_kg"}));
  const std::string path = "linkage." + std::string(1000, 'x');
  const auto faults = faults_of([&] {
    (void)jobs::plan_sweep({{"sweep", {{path, {{"a", 1}, {"b", 2}}}}}}, 10'000);
  });
  EXPECT_EQ(pointers_of(faults), std::vector<std::string>{"/sweep/" + path});
}

struct SweepSize {
  const char* name;
  const char* request;
  const char* size;
};
void PrintTo(const SweepSize& c, std::ostream* out) { *out << c.name; }

class SweepTooLarge : public testing::TestWithParam<SweepSize> {};

TEST_P(SweepTooLarge, IsRefusedWithItsSize) {
  const auto faults = faults_of([] { (void)jobs::plan_sweep(request_of(GetParam().request), 10'000); });
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_NE(faults[0].detail.find(std::string("would have ") + GetParam().size + " jobs; at most 10000"),
            std::string::npos)
      << faults[0].detail;
}

constexpr SweepSize kSweepSizes[] = {
    {"one_too_many", R"({"sweep": {"clearance_mm": {"from": 0, "to": 1, "count": 10001}}})", "10001"},
    {"by_replicates", R"({"replicates": {"count": 10001}})", "10001"},
    {"by_product",
     R"({"sweep": {"clearance_mm": {"from": 0, "to": 1, "count": 200}, "crank_velocity_rad_s": {"from": 0,
        "to": 1, "count": 100}}})",
     "20000"},
    {"by_cases",
     R"({"cases": [{"radial_levels": 1}, {"radial_levels": 2}], "sweep": {"clearance_mm": {"from": 0, "to": 1,
        "count": 5001}}})",
     "10002"},
    {"too_many_to_count",
     R"({"sweep": {"clearance_mm": {"from": 0, "to": 1, "count": 1e9}, "crank_velocity_rad_s": {"from": 0,
        "to": 1, "count": 1e9},
       "gravity_m_s2": {"from": 0, "to": 1, "count": 1e9}}})",
     "more than 18446744073709551615"},
};

INSTANTIATE_TEST_SUITE_P(All, SweepTooLarge, testing::ValuesIn(kSweepSizes),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace jobs_tests
