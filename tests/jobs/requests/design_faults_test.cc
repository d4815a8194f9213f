// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "jobs/requests/expand.h"
#include "tests/jobs/request_support.h"

namespace jobs_tests {
namespace {

struct FaultCase {
  const char* name;
  const char* request;
  const char* pointer;
  const char* says;
};
void PrintTo(const FaultCase& c, std::ostream* out) { *out << c.name; }

class DesignFault : public testing::TestWithParam<FaultCase> {};

TEST_P(DesignFault, IsNamedWithItsPlace) {
  const auto faults = faults_of([] { (void)jobs::plan_sweep(request_of(GetParam().request), 10'000); });
  ASSERT_EQ(faults.size(), 1U) << (faults.size() < 2 ? "" : faults[1].pointer + ": " + faults[1].detail);
  EXPECT_EQ(faults[0].pointer, GetParam().pointer);
  EXPECT_NE(faults[0].detail.find(GetParam().says), std::string::npos) << faults[0].detail;
}

constexpr FaultCase kFaultCases[] = {
    {"no_object", R"({"design": []})", "/design", "must be an object"},
    {"no_type", R"({"design": {"over": {}}})", "/design/type",
     "\"latin_hypercube\", \"sobol\", \"zip\", \"one_at_a_time\""},
    {"unknown_type", R"({"design": {"type": "halton"}})", "/design/type", "must be one of"},
    {"type_no_text", R"({"design": {"type": 1}})", "/design/type", "must be one of"},
    {"no_over", R"({"design": {"type": "zip"}})", "/design/over", "one parameter or more"},
    {"over_a_list", R"({"design": {"type": "zip", "over": [1]}})", "/design/over", "one parameter or more"},
    {"over_nothing", R"({"design": {"type": "sobol", "count": 2, "over": {}}})", "/design/over",
     "one parameter or more"},
    {"key_of_another_type", R"({"design": {"type": "zip", "seed": 1, "over": {"clearance_mm": [1]}}})",
     "/design/seed", "unknown key; allowed: type, over (of zip)"},
    {"misspelt_key",
     R"({"design": {"type": "sobol", "count": 2, "sed": 1, "over": {"clearance_mm": {"from": 0, "to": 1}}}})",
     "/design/sed", "did you mean seed?"},
    {"unknown_path", R"({"design": {"type": "zip", "over": {"clearence_mm": [1]}}})",
     "/design/over/clearence_mm", "did you mean clearance_mm?"},
    {"whole_links", R"({"design": {"type": "zip", "over": {"links": [1]}}})", "/design/over/links",
     "links.1,3.mass_kg"},
    {"no_count", R"({"design": {"type": "sobol", "over": {"clearance_mm": {"from": 0, "to": 1}}}})",
     "/design/count", "missing"},
    {"count_zero",
     R"({"design": {"type": "sobol", "count": 0, "over": {"clearance_mm": {"from": 0, "to": 1}}}})",
     "/design/count", "integer"},
    {"count_fraction",
     R"({"design": {"type": "sobol", "count": 2.5, "over": {"clearance_mm": {"from": 0, "to": 1}}}})",
     "/design/count", "integer"},
    {"seed_no_number",
     R"({"design": {"type": "sobol", "count": 2, "seed": "a", "over": {"clearance_mm": {"from": 0,
        "to": 1}}}})",
     "/design/seed", "integer"},
    {"count_in_the_range",
     R"({"design": {"type": "sobol", "count": 2, "over": {"clearance_mm": {"from": 0, "to": 1,
        "count": 2}}}})",
     "/design/over/clearance_mm/count", "unknown key"},
    {"no_from", R"({"design": {"type": "sobol", "count": 2, "over": {"clearance_mm": {"to": 1}}}})",
     "/design/over/clearance_mm/from", "missing"},
    {"from_out_of_range",
     R"({"design": {"type": "sobol", "count": 2, "over": {"restitution": {"from": -0.1, "to": 1}}}})",
     "/design/over/restitution/from", "[0, 1]"},
    {"to_below_from",
     R"({"design": {"type": "sobol", "count": 2, "over": {"clearance_mm": {"from": 1, "to": 0.5}}}})",
     "/design/over/clearance_mm/to", "more than from"},
    {"to_equal_from",
     R"({"design": {"type": "sobol", "count": 2, "over": {"clearance_mm": {"from": 1, "to": 1}}}})",
     "/design/over/clearance_mm/to", "more than from"},
    {"log_from_zero",
     R"({"design": {"type": "sobol", "count": 2, "over": {"clearance_mm": {"from": 0, "to": 1,
        "scale": "log"}}}})",
     "/design/over/clearance_mm/from", "above 0"},
    {"log_too_wide",
     R"({"design": {"type": "sobol", "count": 2, "over": {"bristle_stiffness_1_m": {"from": 1e-310, "to": 1e9,
        "scale": "log"}}}})",
     "/design/over/bristle_stiffness_1_m/to", "times from"},
    {"broken_integer",
     R"({"design": {"type": "sobol", "count": 2, "over": {"rigid_elements": {"from": 2, "to": 8.5}}}})",
     "/design/over/rigid_elements/to", "integer"},
    {"integer_of_a_description_without_end",
     R"({"parameters": {"linkage": {"bodies": {"b": {"mass_kg": 1, "beam": {"length_m": 1, "diameter_mm": 20}}},
                                    "joints": {"j": {"kind": "revolute", "from": "ground", "to": "b"}}}},
         "design": {"type": "sobol", "count": 2, "over": {"linkage.bodies.b.beam.elements": {"from": 1, "to": 1e300}}}})",
     "/design/over/linkage.bodies.b.beam.elements/to", "an integer in [1, 64]"},
    {"range_of_words",
     R"({"design": {"type": "sobol", "count": 2, "over": {"coupler": {"from": 1, "to": 2}}}})",
     "/design/over/coupler", "must be a list"},
    {"scalar", R"({"design": {"type": "sobol", "count": 2, "over": {"clearance_mm": 1}}})",
     "/design/over/clearance_mm", "or a list"},
    {"empty_list", R"({"design": {"type": "sobol", "count": 2, "over": {"clearance_mm": []}}})",
     "/design/over/clearance_mm", "one value or more"},
    {"bad_word", R"({"design": {"type": "sobol", "count": 2, "over": {"coupler": ["rigid", "soft"]}}})",
     "/design/over/coupler/1", "\"flexible\""},
    {"word_twice", R"({"design": {"type": "sobol", "count": 2, "over": {"coupler": ["rigid", "rigid"]}}})",
     "/design/over/coupler/1", "already"},
    {"more_points_than_combinations",
     R"({"design": {"type": "latin_hypercube", "count": 15, "over": {"coupler": ["rigid", "flexible"],
        "rigid_elements": {"from": 2, "to": 8}}}})",
     "/design/count", "at most 14"},
    {"zip_of_unequal_lists",
     R"({"design": {"type": "zip", "over": {"clearance_mm": [0.1, 0.2], "crank_velocity_rad_s": {"from": 1,
        "to": 3, "count": 3}}}})",
     "/design/over/crank_velocity_rad_s", "has 3 values, and clearance_mm has 2"},
    {"zip_with_a_point_twice",
     R"({"design": {"type": "zip", "over": {"clearance_mm": [0.1, 0.2, 0.1], "coupler": ["rigid", "rigid",
        "rigid"]}}})",
     "/design/over/clearance_mm/2", "already"},
    {"zip_with_a_bad_value", R"({"design": {"type": "zip", "over": {"clearance_mm": [0.1, -1]}}})",
     "/design/over/clearance_mm/1", "[0, 1000)"},
    {"zip_without_range", R"({"design": {"type": "zip", "over": {"clearance_mm": {"from": 0, "to": 1}}}})",
     "/design/over/clearance_mm/count", "missing"},
    {"centre_no_object",
     R"({"design": {"type": "one_at_a_time", "centre": 1, "over": {"clearance_mm": [0.1]}}})",
     "/design/centre", "object"},
    {"centre_elsewhere",
     R"({"design": {"type": "one_at_a_time", "centre": {"gravity_m_s2": 1},
        "over": {"clearance_mm": [0.1]}}})",
     "/design/centre/gravity_m_s2", "is not in over"},
    {"centre_unknown",
     R"({"design": {"type": "one_at_a_time", "centre": {"gravity": 1}, "over": {"clearance_mm": [0.1]}}})",
     "/design/centre/gravity", "did you mean gravity_m_s2?"},
    {"centre_bad_value",
     R"({"design": {"type": "one_at_a_time", "centre": {"clearance_mm": "a"},
        "over": {"clearance_mm": [0.1]}}})",
     "/design/centre/clearance_mm", "[0, 1000)"},
    {"no_centre_for_a_span",
     R"({"design": {"type": "one_at_a_time", "over": {"linkage.x": {"from": 0, "to": 1, "count": 2}}}})",
     "/design/centre", "linkage.x"},
    {"no_centre_for_a_list", R"({"design": {"type": "one_at_a_time", "over": {"linkage.x.y": [1, 2]}}})",
     "/design/centre", "linkage.x.y"},
    {"no_centre_but_a_name",
     R"({"design": {"type": "one_at_a_time", "over": {"linkage.-": {"from": 0, "to": 1, "count": 2}}}})",
     "/design/centre", "linkage.-"},
    {"one_at_a_time_twice", R"({"design": {"type": "one_at_a_time", "over": {"clearance_mm": [0.1, 0.1]}}})",
     "/design/over/clearance_mm/1", "already"},
    {"one_at_a_time_bad_list", R"({"design": {"type": "one_at_a_time", "over": {"rigid_elements": ["a"]}}})",
     "/design/over/rigid_elements/0", "integer"},
    {"in_parameters",
     R"({"parameters": {"clearance_mm": 1}, "design": {"type": "zip", "over": {"clearance_mm": [0.1]}}})",
     "/design/over/clearance_mm", "parameters"},
    {"in_an_axis",
     R"({"sweep": {"clearance_mm": [1]}, "design": {"type": "zip", "over": {"clearance_mm": [0.1]}}})",
     "/sweep/clearance_mm", "in the design, too"},
    {"in_a_case",
     R"({"cases": [{"clearance_mm": 1}], "design": {"type": "zip", "over": {"clearance_mm": [0.1]}}})",
     "/cases/0/clearance_mm", "in the design, too"},
    // Without its faulty values a parameter set is that of the defaults: one fault, and no other because of
    // it.
    {"bad_parameters",
     R"({"parameters": {"crank_length_m": "a"}, "design": {"type": "one_at_a_time",
        "over": {"links.1,1.mass_kg": [0.1]}}})",
     "/parameters/crank_length_m", "[0.001, 100]"},
    {"combination",
     R"({"parameters": {"bearing_radius_mm": 1}, "design": {"type": "zip", "over": {"clearance_mm": [0.1,
        3]}}})",
     "/design/over/clearance_mm", "(at clearance_mm = 3.0)"},
};

INSTANTIATE_TEST_SUITE_P(All, DesignFault, testing::ValuesIn(kFaultCases),
                         [](const auto& tested) { return tested.param.name; });

TEST(DesignFaults, AreAllReportedAtOnce) {
  const auto faults = faults_of([] {
    (void)jobs::plan_sweep(request_of(R"({"design": {"type": "sobol", "count": "a", "seed": -1, "extra": 0,
                                          "over": {"clearance_mm": {"from": "a", "scale": "cubic"},
                                         "coupler": []}}, "sweep": {"gravity_m_s2": 1}})"),
                           10'000);
  });
  EXPECT_EQ(pointers_of(faults),
            (std::vector<std::string>{"/design/count", "/design/extra", "/design/over/clearance_mm/from",
                                      "/design/over/clearance_mm/scale", "/design/over/clearance_mm/to",
                                      "/design/over/coupler", "/design/seed", "/sweep/gravity_m_s2"}));
}

struct SizeCase {
  const char* name;
  const char* request;
  const char* size;
};
void PrintTo(const SizeCase& c, std::ostream* out) { *out << c.name; }

class DesignTooLarge : public testing::TestWithParam<SizeCase> {};

TEST_P(DesignTooLarge, IsRefusedWithItsSize) {
  const auto faults = faults_of([] { (void)jobs::plan_sweep(request_of(GetParam().request), 10'000); });
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_NE(faults[0].detail.find(std::string("would have ") + GetParam().size + " jobs; at most 10000"),
            std::string::npos)
      << faults[0].detail;
}

// A billion points would take some hundred gigabytes, if they were made before they are counted.
constexpr SizeCase kSizeCases[] = {
    {"latin_hypercube",
     R"({"design": {"type": "latin_hypercube", "count": 1e9, "over": {"clearance_mm": {"from": 0,
        "to": 1}}}})",
     "1000000000"},
    {"sobol_times_axis",
     R"({"design": {"type": "sobol", "count": 5001, "over": {"clearance_mm": {"from": 0, "to": 1}}},
        "sweep": {"gravity_m_s2": [1, 2]}})",
     "10002"},
    {"zip",
     R"({"design": {"type": "zip", "over": {"clearance_mm": {"from": 0, "to": 1, "count": 1e9},
        "gravity_m_s2": {"from": 0, "to": 1, "count": 1e9}}}})",
     "1000000000"},
    {"one_at_a_time",
     R"({"design": {"type": "one_at_a_time", "over": {"clearance_mm": {"from": 0, "to": 1, "count": 1e9},
        "coupler": ["flexible"]}}})",
     "1000000002"},
    {"one_at_a_time_with_its_centre",
     R"({"design": {"type": "one_at_a_time", "centre": {"clearance_mm": 0.5, "gravity_m_s2": 1},
       "over": {"clearance_mm": {"from": 1, "to": 0, "count": 999999999}, "gravity_m_s2": {"from": 2, "to": 8,
        "count": 10000}}}})",
     "1000009999"},
    {"too_many_to_count",
     R"({"design": {"type": "sobol", "count": 1e9, "over": {"clearance_mm": {"from": 0, "to": 1}}},
        "replicates": {"count": 1e9},
       "sweep": {"gravity_m_s2": {"from": 0, "to": 1, "count": 1e9}}})",
     "more than 18446744073709551615"},
};

INSTANTIATE_TEST_SUITE_P(All, DesignTooLarge, testing::ValuesIn(kSizeCases),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace jobs_tests
