// SPDX-License-Identifier: Apache-2.0
// Descriptions of linkages that are refused, and where.

#include <algorithm>
#include <cstddef>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/simulate_linkage.h"
#include "jobs/linkages/linkage_json.h"
#include "jobs/requests/parameters.h"
#include "tests/jobs/request_support.h"
#include "tests/jobs/requests/example_linkage.h"

namespace jobs_tests {
namespace {

using nlohmann::json;

struct Refusal {
  const char* name;
  const char* change;   ///< JSON patch of the four-bar example
  const char* pointer;
  const char* says;
};
void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.name; }

class LinkageRefusal : public testing::TestWithParam<Refusal> {};

TEST_P(LinkageRefusal, IsNamedWithItsPlace) {
  const json changed = example("four_bar").patch(json_of(GetParam().change));
  const auto faults = faults_of([&] { (void)jobs::complete_parameters(changed, ""); });
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].pointer, GetParam().pointer);
  EXPECT_NE(faults[0].detail.find(GetParam().says), std::string::npos) << faults[0].detail;
}

constexpr Refusal kRefusals[] = {
    {"no_linkage", R"([{"op": "replace", "path": "/linkage", "value": "rsup"}])", "/linkage",
     "describes a linkage"},
    {"unknown_key", R"([{"op": "add", "path": "/linkage/joint", "value": {}}])", "/linkage/joint",
     "did you mean joints?"},
    {"unknown_body",
     R"([{"op": "replace", "path": "/linkage/joints/rocker/to", "value": "roker"}, {"op": "remove",
        "path": "/linkage/bodies/rocker"},
       {"op": "remove", "path": "/linkage/joints/rocker_pin"}])",
     "/linkage/joints/rocker/to", "no body roker"},
    {"bad_name", R"([{"op": "add", "path": "/linkage/bodies/a b", "value": {"mass_kg": 1}}])",
     "/linkage/bodies/a b", "a name is"},
    {"not_carried", R"([{"op": "add", "path": "/linkage/bodies/loose", "value": {"mass_kg": 1}}])",
     "/linkage/bodies/loose", "carried by no joint"},
    {"carried_twice", R"([{"op": "remove", "path": "/linkage/joints/rocker_pin/closes_loop"},
     {"op": "remove", "path": "/linkage/joints/rocker_pin/to_at_m"}])",
     "/linkage/joints/rocker_pin/to", "closes_loop"},
    {"damping_where_a_loop_closes", R"([{"op": "add", "path": "/linkage/joints/rocker_pin/damping_n_m_s_rad", "value": 1}])",
     "/linkage/joints/rocker_pin/damping_n_m_s_rad", "have the loop cut at another joint"},
    {"unknown_kind", R"([{"op": "replace", "path": "/linkage/joints/rocker/kind", "value": "hinge"},
     {"op": "remove", "path": "/linkage/joints/rocker/guess_rad"}])",
     "/linkage/joints/rocker/kind", "revolute"},
    {"unit_of_the_other_kind",
     R"([{"op": "move", "from": "/linkage/joints/rocker/guess_rad",
        "path": "/linkage/joints/rocker/guess_m"}])",
     "/linkage/joints/rocker/guess_m", "unknown key"},
    {"clearance_of_a_planar_joint",
     R"([{"op": "replace", "path": "/linkage/joints/crank", "value": {"kind": "planar", "from": "ground", "to": "crank", "clearance": {}}}])",
     "/linkage/joints/crank/clearance", "belongs to a revolute"},
    {"clearance_of_a_block_without_its_width",
     R"([{"op": "replace", "path": "/linkage/joints/crank", "value": {"kind": "prismatic", "from": "ground", "to": "crank",
        "clearance": {"block_height_mm": 10}}}])",
     "/linkage/joints/crank/clearance/block_width_mm", "is missing"},
    {"width_of_a_ball",
     R"([{"op": "replace", "path": "/linkage/joints/crank", "value": {"kind": "spherical", "from": "ground", "to": "crank",
        "clearance": {"block_width_mm": 10}}}])",
     "/linkage/joints/crank/clearance/block_width_mm", "belongs to a prismatic joint"},
    {"rings_of_a_ball",
     R"([{"op": "replace", "path": "/linkage/joints/crank", "value": {"kind": "spherical", "from": "ground", "to": "crank",
        "clearance": {"radial_levels": 3}}}])",
     "/linkage/joints/crank/clearance/radial_levels", "does not belong to a spherical joint"},
    {"universal_clearance_without_a_cross",
     R"([{"op": "replace", "path": "/linkage/joints/crank", "value": {"kind": "universal", "from": "ground", "to": "crank",
        "clearance": {}}}])",
     "/linkage/joints/crank/cross", "is missing"},
    {"cross_without_clearance",
     R"([{"op": "replace", "path": "/linkage/joints/crank", "value": {"kind": "universal", "from": "ground", "to": "crank",
        "cross": {"mass_kg": 1, "inertia_kg_m2": [1, 1, 1]}}}])",
     "/linkage/joints/crank/cross", "with clearance"},
    {"cross_that_no_body_is",
     R"([{"op": "replace", "path": "/linkage/joints/crank", "value": {"kind": "universal", "from": "ground", "to": "crank",
        "clearance": {}, "cross": {"mass_kg": 1, "inertia_kg_m2": [1, 1, 5]}}}])",
     "/linkage/joints/crank/cross/inertia_kg_m2", "principal moment"},
    {"block_that_turns_over",
     R"([{"op": "replace", "path": "/linkage/joints/crank", "value": {"kind": "prismatic", "from": "ground", "to": "crank",
        "clearance": {"block_width_mm": 20, "block_height_mm": 20, "clearance_mm": 5}}}])",
     "/linkage/joints/crank/clearance/clearance_mm", "turn over"},
    {"clearance_below_all_measure", R"([{"op": "add", "path": "/linkage/joints/rocker_pin/clearance", "value": {"clearance_mm": 1e-9}}])",
     "/linkage/joints/rocker_pin/clearance/clearance_mm", "at least 1e-6 mm"},
    {"reaction_of_a_loose_joint",
     R"([{"op": "add", "path": "/linkage/joints/rocker/clearance", "value": {}},
         {"op": "add", "path": "/linkage/joints/rocker/friction", "value": {"by_reaction": true, "radius_mm": 5}}])",
     "/linkage/joints/rocker/friction/by_reaction", "without clearance"},
    {"load_on_play_that_is_none",
     R"([{"op": "add", "path": "/linkage/joints/rocker/clearance", "value": {"clearance_mm": 0}},
         {"op": "add", "path": "/linkage/joints/rocker/freedoms", "value": {"slide_x": {"load_n": 1}}}])",
     "/linkage/joints/rocker/freedoms/slide_x/load_n", "the joint ideal"},
    {"start_beyond_the_play",
     R"([{"op": "add", "path": "/linkage/joints/rocker/clearance", "value": {"clearance_mm": 0.1}},
         {"op": "add", "path": "/linkage/joints/rocker/freedoms", "value": {"slide_x": {"start_m": 0.001}}}])",
     "/linkage/joints/rocker", "beyond the play"},
    {"freedom_that_clearance_does_not_give",
     R"([{"op": "add", "path": "/linkage/joints/crank/clearance", "value": {}},
         {"op": "add", "path": "/linkage/joints/crank/freedoms", "value": {"turn_z": {"start_rad": 0}}}])",
     "/linkage/joints/crank/freedoms/turn_z", "slide_x, slide_y, slide_z, turn_y, turn_x"},
    {"clearance_too_large",
     R"([{"op": "add", "path": "/linkage/joints/rocker_pin/clearance", "value": {"clearance_mm": 6}}])",
     "/linkage/joints/rocker_pin/clearance/clearance_mm", "bearing_radius_mm"},
    {"contact_elements_by_the_law_of_a_ring",
     R"([{"op": "add", "path": "/linkage/joints/rocker_pin/clearance", "value": {"contact": "elements", "stiffness_law": "johnson"}}])",
     "/linkage/joints/rocker_pin/clearance/stiffness_law", "must be hertz"},
    {"friction_that_rises_at_once",
     R"([{"op": "add", "path": "/linkage/joints/rocker_pin/clearance",
        "value": {"friction": "ambrosio", "friction_velocity_0_m_s": 0.01, "friction_velocity_1_m_s": 0.01}}])",
     "/linkage/joints/rocker_pin/clearance/friction_velocity_1_m_s", "above friction_velocity_0_m_s"},
    {"unknown_law", R"([{"op": "replace", "path": "/linkage/joints/crank/drive", "value": {"law": "sine"}}])",
     "/linkage/joints/crank/drive/law", "harmonic"},
    {"table_that_turns_back", R"([{"op": "replace", "path": "/linkage/joints/crank/drive",
       "value": {"law": "table", "times_s": [0, 2, 1], "values_rad": [0, 1, 2]}}])",
     "/linkage/joints/crank/drive/times_s", "1e-6 s"},
    {"stroke_by_an_unknown_law", R"([{"op": "replace", "path": "/linkage/joints/crank/drive",
       "value": {"law": "rise_return_pause", "stroke_rad": 1, "stroke_time_s": 1, "stroke_law": "sine"}}])",
     "/linkage/joints/crank/drive/stroke_law", R"("cycloidal", "cosine", "parabolic")"},
    {"stroke_law_that_is_no_word", R"([{"op": "replace", "path": "/linkage/joints/crank/drive",
       "value": {"law": "rise_return_pause", "stroke_rad": 1, "stroke_time_s": 1, "stroke_law": 1}}])",
     "/linkage/joints/crank/drive/stroke_law", "must be one of"},
    {"stroke_from_a_length", R"([{"op": "replace", "path": "/linkage/joints/crank/drive",
       "value": {"law": "rise_return_pause", "stroke_rad": 1, "stroke_time_s": 1, "from_m": 1}}])",
     "/linkage/joints/crank/drive/from_m", "unknown key"},
    {"stroke_from_a_word", R"([{"op": "replace", "path": "/linkage/joints/crank/drive",
       "value": {"law": "rise_return_pause", "stroke_rad": 1, "stroke_time_s": 1, "from_rad": "0"}}])",
     "/linkage/joints/crank/drive/from_rad", "must be a number in [-1000000, 1000000] rad"},
    {"stroke_law_of_another_law", R"([{"op": "replace", "path": "/linkage/joints/crank/drive",
       "value": {"law": "cycloidal", "rise_rad": 1, "time_s": 1, "stroke_law": "cosine"}}])",
     "/linkage/joints/crank/drive/stroke_law", "unknown key"},
    {"run_up_from_a_length", R"([{"op": "replace", "path": "/linkage/joints/crank/drive",
       "value": {"law": "run_up", "velocity_rad_s": 1, "from_m": 1}}])",
     "/linkage/joints/crank/drive/from_m", "unknown key"},
    {"run_up_of_no_step", R"([{"op": "replace", "path": "/linkage/joints/crank/drive",
       "value": {"law": "run_up", "velocity_rad_s": 1, "time_s": 1e-300}}])",
     "/linkage/joints/crank/drive/time_s", "or at least 1e-6 s"},
    {"run_up_from_too_far", R"([{"op": "replace", "path": "/linkage/joints/crank/drive",
       "value": {"law": "run_up", "velocity_rad_s": 1, "from_rad": 1000001}}])",
     "/linkage/joints/crank/drive/from_rad", "[-1000000, 1000000] rad"},
    {"driven_and_given", R"([{"op": "add", "path": "/linkage/joints/crank/start_rad", "value": 1}])",
     "/linkage/joints/crank/start_rad", "drive"},
    {"beam_without_section", R"([{"op": "remove", "path": "/linkage/bodies/coupler/beam/width_mm"}])",
     "/linkage/bodies/coupler/beam", "section"},
    {"inertia_of_no_body",
     R"([{"op": "replace", "path": "/linkage/bodies/rocker/inertia_kg_m2", "value": [1, 1, 3]}])",
     "/linkage/bodies/rocker/inertia_kg_m2", "principal moment"},
    {"inertia_of_no_body_about_its_origin",
     R"([{"op": "remove", "path": "/linkage/bodies/rocker/inertia_kg_m2"},
         {"op": "add", "path": "/linkage/bodies/rocker/inertia_about_origin_kg_m2", "value": [1, 1, 5]}])",
     "/linkage/bodies/rocker/inertia_about_origin_kg_m2", "principal moment"},
    {"loop_that_does_not_close",
     R"([{"op": "replace", "path": "/linkage/joints/rocker/at_m", "value": [2, 0, 0]}])",
     "/linkage/joints/rocker_pin", "does not close"},
    {"massless_and_free", R"([{"op": "add", "path": "/linkage/bodies/pointer", "value": {"mass_kg": 0}},
       {"op": "add", "path": "/linkage/joints/loose", "value": {"kind": "revolute", "from": "crank",
                                                                "to": "pointer"}}])",
     "/linkage/joints/loose", "has mass"},
    {"spring_of_no_body",
     R"([{"op": "add", "path": "/linkage/springs", "value": {"stay": {"from": "ground", "to": "roker",
        "stiffness_n_m": 1}}}])",
     "/linkage/springs/stay/to", "no body roker"},
    {"spring_on_one_body",
     R"([{"op": "add", "path": "/linkage/springs", "value": {"stay": {"from": "rocker", "to": "rocker",
        "stiffness_n_m": 1}}}])",
     "/linkage/springs/stay/to", "a body other than"},
    {"spring_that_pushes",
     R"([{"op": "add", "path": "/linkage/springs", "value": {"stay": {"from": "ground", "to": "rocker",
        "stiffness_n_m": -1}}}])",
     "/linkage/springs/stay/stiffness_n_m", "[0, "},
    {"spring_by_the_name_of_a_joint",
     R"([{"op": "add", "path": "/linkage/springs", "value": {"rocker": {"from": "ground", "to": "rocker",
        "stiffness_n_m": 1}}}])",
     "/linkage/springs/rocker", "a joint rocker"},
    {"spring_that_is_none",
     R"([{"op": "add", "path": "/linkage/springs", "value": {"stay": {"from": "ground", "to": "rocker"}}}])",
     "/linkage/springs/stay", "a damping_n_s_m or a drag_n_s_m"},
    {"drag_between_two_bodies",
     R"([{"op": "add", "path": "/linkage/springs", "value": {"stay": {"from": "crank", "to": "rocker",
        "drag_n_s_m": 1}}}])",
     "/linkage/springs/stay/drag_n_s_m", "the ground at one end"},
    {"spring_without_a_way",
     R"([{"op": "add", "path": "/linkage/springs", "value": {"stay": {"from": "ground", "to": "crank",
        "stiffness_n_m": 1,
        "free_length_m": 1}}}])",
     "/linkage/springs/stay", "in one place"},
    {"no_springs", R"([{"op": "add", "path": "/linkage/springs", "value": {}}])", "/linkage/springs",
     "one entry or more"},
    {"rpsup_alone", R"([{"op": "add", "path": "/coupler_length_m", "value": 0.4}])", "/coupler_length_m",
     "belongs to the linkage"},
    {"worn_bore", R"([{"op": "add", "path": "/wear_depth_um", "value": [[0, 0, 0, 0, 1, 0, 0, 0]]}])",
     "/wear_depth_um", "given with the linkage \"rpsup\" only"},
    {"worn_bore_of_a_joint", R"([{"op": "add", "path": "/linkage/joints/rocker_pin/clearance",
                                  "value": {"wear_depth_um": [[0, 0, 0, 0, 1, 0, 0, 0]]}}])",
     "/linkage/joints/rocker_pin/clearance/wear_depth_um", "given with the linkage \"rpsup\" only"},
    {"polynomial_without_coefficients", R"([{"op": "replace", "path": "/linkage/joints/crank/drive",
       "value": {"law": "polynomial"}}])",
     "/linkage/joints/crank/drive/coefficients_rad", "is missing"},
    {"polynomial_with_both_names", R"([{"op": "replace", "path": "/linkage/joints/crank/drive",
       "value": {"law": "polynomial", "coefficients_rad": [0, 1], "coefficients_rad_s": [0, 1]}}])",
     "/linkage/joints/crank/drive/coefficients_rad_s", "former name of coefficients_rad"},
};

INSTANTIATE_TEST_SUITE_P(All, LinkageRefusal, testing::ValuesIn(kRefusals),
                         [](const auto& test) { return std::string(test.param.name); });

// A universal joint with clearance is two joints of the engine, and a body between them.
TEST(LinkageRefusals, NameAUniversalJointByItsOwnName) {
  const json description = json_of(R"({"bodies": {"a": {}}, "joints": {"u": {}, "guide_first": {}}})");
  const auto pointer_of = [&](const char* field) { return jobs::pointer_of_linkage_field(field, description); };
  EXPECT_EQ(pointer_of("joints.u_first"), "/linkage/joints/u");
  EXPECT_EQ(pointer_of("joints.u_second"), "/linkage/joints/u");
  EXPECT_EQ(pointer_of("bodies.u_cross.inertia"), "/linkage/joints/u/cross/inertia_kg_m2");
  EXPECT_EQ(pointer_of("joints.guide_first"), "/linkage/joints/guide_first");
  EXPECT_EQ(pointer_of("bodies.a.mass"), "/linkage/bodies/a/mass_kg");
  EXPECT_EQ(pointer_of("joints"), "/linkage/joints");
  EXPECT_EQ(pointer_of(""), "/linkage");
}

TEST(LinkageRefusals, ComeAllAtOnce) {
  json given = example("four_bar");
  given["linkage"]["bodies"]["crank"]["mass_kg"] = -1;
  given["linkage"]["joints"]["rocker"]["axis"] = "w";
  given["linkage"]["joints"]["crank"]["from"] = "nowhere";
  EXPECT_EQ(pointers_of(faults_of([&] { (void)jobs::complete_parameters(given, ""); })),
            (std::vector<std::string>{"/linkage/bodies/crank/mass_kg", "/linkage/joints/crank/from",
                                      "/linkage/joints/rocker/axis"}));
}

// Where the names of two things make one key: the place that is named, the key and the other thing.
struct Clash {
  const char* name;
  const char* joint;     ///< name of a prismatic joint that carries the second body
  const char* change;    ///< JSON patch
  const char* pointer;
  const char* key;
  const char* other;
};
void PrintTo(const Clash& clash, std::ostream* out) { *out << clash.name; }

class ClashOfKeys : public testing::TestWithParam<Clash> {};

TEST_P(ClashOfKeys, IsNamedWithBothSources) {
  json given = json_of(R"({"linkage": {"bodies": {"a": {"mass_kg": 1, "inertia_kg_m2": [1, 1, 1]},
      "c": {"mass_kg": 1}}, "joints": {"elbow": {"kind": "revolute", "from": "ground", "to": "a",
      "drive": {"law": "polynomial", "coefficients_rad": [0, 1]}}}}})");
  given["linkage"]["joints"][GetParam().joint] = {{"kind", "prismatic"}, {"from", "a"}, {"to", "c"}};
  given = given.patch(json_of(GetParam().change));
  const auto faults = faults_of([&] { (void)jobs::complete_parameters(given, ""); });
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].pointer, GetParam().pointer);
  EXPECT_NE(faults[0].detail.find(GetParam().key), std::string::npos) << faults[0].detail;
  EXPECT_NE(faults[0].detail.find(GetParam().other), std::string::npos) << faults[0].detail;
}

constexpr const char* kAddSpring = R"([{"op": "add", "path": "/linkage/springs", "value": {"stay":
    {"from": "ground", "to": "c", "at_m": [1, 0, 0], "stiffness_n_m": 1}}}])";

constexpr Clash kClashes[] = {
    {"drive", "elbow_drive_n", "[]", "/linkage/joints/elbow_drive_n", " elbow_drive_n_m,", "the joint elbow"},
    {"moment", "elbow_moment_x_n", "[]", "/linkage/joints/elbow", " elbow_moment_x_n_m,",
     "the joint elbow_moment_x_n"},
    {"pose", "pose_c_y", "[]", "/linkage/bodies/c", " pose_c_y_m,", "the joint pose_c_y"},
    {"spring", "stay_length", kAddSpring, "/linkage/springs/stay", " stay_length_m,",
     "the joint stay_length"},
    {"element_of_a_beam", "slide", R"([{"op": "add", "path": "/linkage/bodies/a_1", "value": {"mass_kg": 1}},
        {"op": "add", "path": "/linkage/joints/third",
         "value": {"kind": "prismatic", "from": "c", "to": "a_1"}},
        {"op": "replace", "path": "/linkage/bodies/a", "value": {"mass_kg": 1, "beam": {"length_m": 1,
         "diameter_mm": 10}}}])",
     "/linkage/bodies/a_1", " pose_a_1_x_m,", "the body a:"},
};

INSTANTIATE_TEST_SUITE_P(All, ClashOfKeys, testing::ValuesIn(kClashes),
                         [](const auto& test) { return std::string(test.param.name); });

// Every joint by the name of every channel, less its unit: refused, or no key occurs twice.
TEST(KeysOfALinkage, OccurOnce) {
  const json plain = json_of(R"({"linkage": {"bodies": {"a": {"mass_kg": 1, "inertia_kg_m2": [1, 1, 1]},
      "c": {"mass_kg": 1}}, "joints": {"elbow": {"kind": "cylindrical", "from": "ground", "to": "a",
      "freedoms": {"turn": {"drive": {"law": "polynomial", "coefficients_rad": [0, 1]}},
                   "slide": {"drive": {"law": "polynomial", "coefficients_m": [0, 1]}}}},
      "slide": {"kind": "prismatic", "from": "a", "to": "c"}}}})");
  const auto tables_of = [](const json& given) {
    return engine::linkage_tables(*jobs::to_job_spec(jobs::complete_parameters(given, "")).linkage);
  };
  const auto tables = tables_of(plain);
  std::set<std::string> names;
  for (const auto* const table : {&tables.channels, &tables.metrics})
    for (const engine::QuantityInfo& info : *table)
      for (std::size_t end = 1; end < std::min<std::size_t>(info.key.size(), 33); ++end)
        if (info.key[end] == '_') names.insert(info.key.substr(0, end));
  names.erase("elbow");
  std::size_t refused = 0;
  for (const std::string& name : names) {
    json given = plain;
    given["linkage"]["joints"].erase("slide");
    given["linkage"]["joints"][name] = plain["linkage"]["joints"]["slide"];
    try {
      const auto made = tables_of(given);
      for (const auto* const table : {&made.channels, &made.metrics}) {
        std::set<std::string> keys;
        for (const engine::QuantityInfo& info : *table) EXPECT_TRUE(keys.insert(info.key).second) << info.key;
      }
    } catch (const jobs::InvalidRequest&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 5U);
  EXPECT_LT(refused, names.size());
}

}  // namespace
}  // namespace jobs_tests
