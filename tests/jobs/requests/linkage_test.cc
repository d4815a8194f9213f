// SPDX-License-Identifier: Apache-2.0
// Described linkages as parameters of a job: the examples, what is refused and where, sweeps over numbers
// inside a description.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/model/rpsup_geometry.h"
#include "engine/simulate_linkage.h"
#include "engine/simulate_rpsup.h"
#include "jobs/requests/expand.h"
#include "jobs/requests/parameters.h"
#include "jobs/run_job.h"
#include "jobs/service.h"
#include "tests/jobs/request_support.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using nlohmann::json;

json example(const std::string& name) {
  return json::parse(std::ifstream(std::string(LINKAGE_FOLDER) + "/" + name + ".json"));
}

const std::vector<double>& column(const engine::Trajectory& trajectory, const std::string& key) {
  for (std::size_t k = 0; k < trajectory.channels.size(); ++k)
    if (trajectory.channels[k].key == key) return trajectory.columns[k];
  throw std::out_of_range("no channel " + key);
}

engine::RunResult run(const json& parameters) {
  const jobs::JobSpec spec = jobs::to_job_spec(jobs::complete_parameters(parameters, ""));
  if (!spec.linkage) return engine::simulate_rpsup(spec.parameters, spec.options, {});
  return engine::simulate_linkage(*spec.linkage, spec.options, spec.parameters.run_up, {});
}

class LinkageExample : public testing::TestWithParam<const char*> {};

TEST_P(LinkageExample, Runs) {
  json parameters = example(GetParam());
  parameters["duration_s"] = 0.1;
  const jobs::Outcome outcome = jobs::run_job(parameters, [](double) { return false; });
  ASSERT_EQ(outcome.job.at("state"), "succeeded") << outcome.job.at("error");
  const json& metrics = outcome.job.at("metrics");
  // What the account misses, against the energy that there is.
  double energy = 0.0;
  const std::vector<double> kinetic = column(outcome.trajectory, "kinetic_energy_j");
  for (const double value : kinetic) energy = std::max(energy, value);
  EXPECT_LT(metrics.at("energy_imbalance_j").get<double>(), 2e-3 * energy);
  EXPECT_GT(energy, 0.0);
  for (const std::size_t samples = outcome.trajectory.columns[0].size();
       const auto& each : outcome.trajectory.columns)
    EXPECT_EQ(each.size(), samples);
}

INSTANTIATE_TEST_SUITE_P(All, LinkageExample,
                         testing::Values("rpsup", "rsup", "slider_crank", "four_bar", "bricard"),
                         [](const auto& test) { return std::string(test.param); });

TEST(LinkageExamples, HaveTheirJointsAndFreedoms) {
  const json both = jobs::run_job(example("slider_crank"), [](double) { return false; }).job.at("metrics");
  EXPECT_GT(both.at("peak_crank_pin_contact_force_n"), 0.0);
  EXPECT_GT(both.at("peak_slider_pin_contact_force_n"), 0.0);
  json bricard = example("bricard");
  bricard["duration_s"] = 0.01;
  EXPECT_EQ(
      jobs::run_job(bricard, [](double) { return false; }).job.at("metrics").at("redundant_constraints"), 1);
}

// Nothing is left to solve for: the force of the drive is m (a - g), which for a harmonic motion along y is
// known.
TEST(LinkageWithoutUnknowns, FollowsItsDrives) {
  const json driven = json_of(
      R"({"duration_s": 0.2, "output_rate_hz": 100, "gravity_m_s2": 10,
         "linkage": {"bodies": {"b": {"mass_kg": 2}},
    "joints": {"j": {"kind": "prismatic", "axis": "y", "from": "ground", "to": "b",
         "drive": {"law": "harmonic", "amplitude_m": 0.1,
    "frequency_hz": 5}}}}})");
  const engine::RunResult result = run(driven);
  ASSERT_EQ(result.status, engine::RunStatus::kSucceeded) << result.detail;
  const std::vector<double> t = column(result.trajectory, "t_s");
  ASSERT_EQ(t.size(), 21U);
  const double omega = 10.0 * std::numbers::pi;
  for (std::size_t k = 0; k < t.size(); ++k)
    EXPECT_NEAR(column(result.trajectory, "j_drive_n")[k],
                2.0 * (10.0 - 0.1 * omega * omega * std::sin(omega * t[k])), 1e-9)
        << t[k];
}

TEST(LinkageWithoutUnknowns, StandsStillIfItIsWelded) {
  const json welded = json_of(R"({"duration_s": 0.1, "linkage": {"bodies": {"b": {"mass_kg": 2}},
    "joints": {"j": {"kind": "weld", "from": "ground", "to": "b"}}}})");
  const engine::RunResult result = run(welded);
  ASSERT_EQ(result.status, engine::RunStatus::kSucceeded) << result.detail;
  EXPECT_EQ(column(result.trajectory, "kinetic_energy_j").back(), 0.0);
}

/// RPSUP by data and the built-in one, channel for channel.
const std::vector<std::pair<std::string, std::string>> kSame{{"t_s", "t_s"},
                                                             {"crank_rad", "crank_angle_rad"},
                                                             {"rod_m", "rod_displacement_m"},
                                                             {"guide_m", "slider_position_m"},
                                                             {"guide_m_s", "slider_velocity_m_s"},
                                                             {"guide_m_s2", "slider_acceleration_m_s2"},
                                                             {"crank_drive_n_m", "crank_torque_n_m"},
                                                             {"rod_drive_n", "rod_force_n"},
                                                             {"bearing_force_x_n", "reaction_x_n"},
                                                             {"bearing_force_y_n", "reaction_y_n"},
                                                             {"bearing_force_z_n", "reaction_z_n"},
                                                             {"kinetic_energy_j", "kinetic_energy_j"},
                                                             {"potential_energy_j", "potential_energy_j"},
                                                             {"pose_cross_qx", "pose_2_2_qx"},
                                                             {"pose_cross_qy", "pose_2_2_qy"}};

/// The same and those of the clearance.
std::vector<std::pair<std::string, std::string>> same_with_clearance() {
  auto channels = kSame;
  for (const char* const key : {"journal_x_mm", "journal_y_mm", "contact_force_n", "friction_force_n"})
    channels.emplace_back("bearing_" + std::string(key), key);
  return channels;
}

void expect_same_bytes(const json& described, const json& built_in,
                       const std::vector<std::pair<std::string, std::string>>& channels) {
  const engine::RunResult data = run(described), own = run(built_in);
  ASSERT_EQ(data.status, engine::RunStatus::kSucceeded) << data.detail;
  for (const auto& [by_data, by_name] : channels)
    EXPECT_EQ(column(data.trajectory, by_data), column(own.trajectory, by_name)) << by_data;
}

/// The coupler of the example as the built-in one bends.
json make_beam(double damping_ratio) {
  const json beam{{"length_m", 0.5},
                  {"diameter_mm", 10},
                  {"axial_inertia_kg_m2", 3.829e-6},
                  {"damping_ratio", damping_ratio}};
  return {{"mass_kg", 0.306}, {"beam", beam}};
}

TEST(RpsupByData, GivesTheSameBytes) {
  json described = example("rpsup");
  described["duration_s"] = 0.05;
  expect_same_bytes(described, {{"duration_s", 0.05}}, same_with_clearance());
  described["clearance_mm"] = 0;
  expect_same_bytes(described, {{"duration_s", 0.05}, {"clearance_mm", 0}}, kSame);
}

TEST(RpsupByData, GivesTheSameBytesWithAFlexibleCoupler) {
  json described = example("rpsup");
  described["duration_s"] = 0.02;
  described["linkage"]["bodies"]["coupler"] = make_beam(0.0005);
  expect_same_bytes(described, {{"duration_s", 0.02}, {"coupler", "flexible"}}, same_with_clearance());
}

/// The example with the geometry of a built-in linkage, whose guesses begin where the built-in ones do.
json describe_geometry(const json& built_in) {
  const json all = jobs::complete_parameters(built_in, "");
  const engine::RpsupParameters p = jobs::to_job_spec(all).parameters;
  const engine::AssemblyGuess guess = engine::calc_assembly_guess(p);
  json described = example("rpsup");
  json& joints = described["linkage"]["joints"];
  joints["crank"]["drive"].update({{"from_rad", all.at("crank_start_rad")}, {"time_s", all.at("run_up_s")}});
  joints["rod"]["drive"].update({{"stroke_law", all.at("rod_law")},
                                 {"from_m", p.rod_start - p.rod_length},
                                 {"stroke_m", p.rod_stroke},
                                 {"stroke_time_s", all.at("rod_stroke_time_s")},
                                 {"pause_s", all.at("rod_pause_s")}});
  const auto guess_of = [](double angle) { return json{{"guess_rad", angle}}; };
  joints["ball"]["freedoms"] = {
      {"z", guess_of(guess.psi_13)}, {"y", guess_of(guess.theta_13)}, {"x", guess_of(guess.phi_13)}};
  joints["guide"].update({{"at_m", {0.0, all.at("guide_offset_y_m"), all.at("guide_offset_z_m")}},
                          {"guess_m", guess.z_21},
                          {"turned_deg", {0.0, -all.at("guide_angle_deg").get<double>(), 0.0}}});
  joints["yoke"].update({{"axis", all.at("yoke_axis") == "guide" ? "x" : "y"}, {"guess_rad", guess.psi_22}});
  for (const char* const key : {"duration_s", "run_up_s", "clearance_mm", "bearing_length_mm",
                                "radial_levels", "axial_stiffness_n_m"})
    described[key] = all.at(key);
  return described;
}

// Four jumps of the parabolic law's acceleration, and the guide turned about y.
const json kTurned{{"duration_s", 0.05},    {"run_up_s", 0.02},         {"crank_start_rad", 0.5},
                   {"guide_angle_deg", 20}, {"guide_offset_y_m", 0.03}, {"rod_law", "parabolic"},
                   {"rod_start_m", 0.17},   {"rod_stroke_time_s", 0.02}};

TEST(RpsupByData, GivesTheSameBytesOfAnotherGeometry) {
  expect_same_bytes(describe_geometry(kTurned), kTurned, same_with_clearance());
  json ideal = kTurned;
  ideal["clearance_mm"] = 0;
  expect_same_bytes(describe_geometry(ideal), ideal, kSame);
}

TEST(RpsupByData, GivesTheSameBytesOfAnotherGeometryWithAFlexibleCoupler) {
  json flexible = kTurned, described = describe_geometry(kTurned);
  flexible.update({{"coupler", "flexible"}, {"coupler_damping_ratio", 0.01}});
  described["linkage"]["bodies"]["coupler"] = make_beam(0.01);
  expect_same_bytes(described, flexible, same_with_clearance());
}

// The cross link turns across the guide, the crank's axis is level.
TEST(RpsupByData, GivesTheSameBytesWithTheYokeAcross) {
  json across{{"duration_s", 0.05},         {"yoke_axis", "across"},        {"gravity_direction", "-y"},
              {"guide_offset_z_m", 0.2},    {"rod_start_m", 0.2},           {"rod_law", "cycloidal"},
              {"rod_stroke_mm", 50},        {"bearing_length_mm", 20},      {"radial_levels", 2},
              {"axial_stiffness_n_m", 1e8}, {"coupler_damping_ratio", 0.01}};
  json described = describe_geometry(across);
  described["linkage"]["gravity_m_s2"] = {0, -9.81, 0};
  expect_same_bytes(described, across, same_with_clearance());
  described["linkage"]["bodies"]["coupler"] = make_beam(0.01);
  across["coupler"] = "flexible";
  expect_same_bytes(described, across, same_with_clearance());
}

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
    {"unknown_kind", R"([{"op": "replace", "path": "/linkage/joints/rocker/kind", "value": "hinge"},
     {"op": "remove", "path": "/linkage/joints/rocker/guess_rad"}])",
     "/linkage/joints/rocker/kind", "revolute"},
    {"unit_of_the_other_kind",
     R"([{"op": "move", "from": "/linkage/joints/rocker/guess_rad",
        "path": "/linkage/joints/rocker/guess_m"}])",
     "/linkage/joints/rocker/guess_m", "unknown key"},
    {"clearance_in_a_chain", R"([{"op": "add", "path": "/linkage/joints/crank/clearance", "value": {}}])",
     "/linkage/joints/crank/clearance", "closes a loop"},
    {"clearance_too_large",
     R"([{"op": "add", "path": "/linkage/joints/rocker_pin/clearance", "value": {"clearance_mm": 6}}])",
     "/linkage/joints/rocker_pin/clearance/clearance_mm", "bearing_radius_mm"},
    {"unknown_law", R"([{"op": "replace", "path": "/linkage/joints/crank/drive", "value": {"law": "sine"}}])",
     "/linkage/joints/crank/drive/law", "harmonic"},
    {"table_that_turns_back", R"([{"op": "replace", "path": "/linkage/joints/crank/drive",
       "value": {"law": "table", "times_s": [0, 2, 1], "values_rad": [0, 1, 2]}}])",
     "/linkage/joints/crank/drive/times_s", "later"},
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
     "/linkage/springs/stay", "a damping_n_s_m or both"},
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

// q = 1 + 2 t + 3 t^2 by either name.
TEST(PolynomialDrive, HasCoefficientsOfThePosition) {
  for (const char* const key : {"coefficients_rad", "coefficients_rad_s"}) {
    const json given{{"duration_s", 0.5}, {"run_up_s", 0}, {"output_rate_hz", 10},
                     {"linkage", {{"bodies", {{"b", {{"mass_kg", 1}, {"inertia_kg_m2", {1, 1, 1}}}}}},
                                  {"joints", {{"j", {{"kind", "revolute"}, {"from", "ground"}, {"to", "b"},
                                                     {"drive", {{"law", "polynomial"},
                                                                {key, {1, 2, 3}}}}}}}}}}};
    const engine::RunResult result = run(given);
    ASSERT_EQ(result.status, engine::RunStatus::kSucceeded) << result.detail;
    EXPECT_NEAR(column(result.trajectory, "j_rad").back(), 1.0 + 2.0 * 0.5 + 3.0 * 0.25, 1e-12) << key;
    EXPECT_NEAR(column(result.trajectory, "j_rad_s").back(), 2.0 + 6.0 * 0.5, 1e-12) << key;
    EXPECT_NEAR(column(result.trajectory, "j_rad_s2").back(), 6.0, 1e-12) << key;
  }
}

TEST(LinkageSprings, AreSweptAndLeaveChannelsAndPeaks) {
  json given = example("four_bar");
  given["duration_s"] = 0.05;
  given["linkage"]["springs"]["stay"] = {
      {"from", "ground"},     {"at_m", {0, 1, 0}},  {"to", "rocker"},      {"to_at_m", {0.1, 0, 0}},
      {"stiffness_n_m", 100}, {"damping_n_s_m", 1}, {"free_length_m", 0.2}};
  const jobs::Outcome outcome = jobs::run_job(given, [](double) { return false; });
  ASSERT_EQ(outcome.job.at("state"), "succeeded") << outcome.job.at("error");
  const std::vector<double> length = column(outcome.trajectory, "stay_length_m"),
                            tension = column(outcome.trajectory, "stay_tension_n");
  EXPECT_NEAR(tension.front(), 100.0 * (length.front() - 0.2), 2e-5);  // at rest; kept in single precision
  EXPECT_GE(outcome.job.at("metrics").at("peak_stay_tension_n"), std::abs(tension.back()));
  const nlohmann::ordered_json request{{"parameters", given},
                                       {"sweep", {{"linkage.springs.stay.stiffness_n_m", {50, 100, 200}}}}};
  EXPECT_EQ(jobs::plan_sweep(request, 100).jobs.size(), 3U);
}

TEST(LinkageSweep, GoesOverNumbersInsideADescription) {
  nlohmann::ordered_json request{{"parameters", example("slider_crank")},
                                 {"sweep", {{"linkage.joints.crank_pin.clearance.clearance_mm", {0.05, 0.1}},
                                            {"linkage.bodies.rod.mass_kg", {0.2, 0.3}},
                                            {"linkage.joints.slider_pin.clearance.restitution", {0.8}}}}};
  const jobs::SweepPlan plan = jobs::plan_sweep(request, 100);
  ASSERT_EQ(plan.jobs.size(), 4U);
  const json first = json::parse(plan.jobs[1].parameters);
  EXPECT_EQ(first.at("linkage").at("bodies").at("rod").at("mass_kg"), 0.3);
  EXPECT_EQ(first.at("linkage").at("joints").at("slider_pin").at("clearance").at("restitution"), 0.8);
  EXPECT_EQ(plan.jobs[1].swept, "[0.05,0.3,0.8]");
}

// Rows of one point are known by the values that they show.
TEST(LinkageSweep, ShowsDifferentLinkagesDifferently) {
  json light = example("slider_crank").at("linkage");
  light.erase("name");
  json heavy = light, called = light, namesake = heavy;
  heavy["bodies"]["rod"]["mass_kg"] = 0.3;
  called["name"] = "described #2";
  namesake["name"] = "rpsup";
  const std::string path = "linkage.bodies.rod.mass_kg";
  const auto shown = [](const nlohmann::ordered_json& request) {
    std::vector<std::string> swept;
    for (const jobs::PlannedJob& job : jobs::plan_sweep(request, 100).jobs) swept.push_back(job.swept);
    return swept;
  };
  const json cases{{{"linkage", light}},  {{"linkage", heavy}},    {{"linkage", light}, {"friction", "none"}},
                   {{"linkage", called}}, {{"linkage", namesake}}, {{"linkage", "rpsup"}}};
  EXPECT_EQ(shown({{"cases", cases}}),
            (std::vector<std::string>{R"(["described","lugre"])", R"(["described #2","lugre"])",
                                      R"(["described","none"])", R"(["described #2 #2","lugre"])",
                                      R"(["rpsup #2","lugre"])", R"(["rpsup","lugre"])"}));
  json many = json::array();
  for (int k = 0; k < 3000; ++k) {
    light["bodies"]["rod"]["mass_kg"] = 0.2 + 1e-5 * k;
    many.push_back({{"linkage", light}});
  }
  EXPECT_EQ(jobs::plan_sweep({{"cases", many}}, 10'000).jobs.back().swept, R"(["described #3000"])");
  EXPECT_EQ(shown({{"cases", {{{"linkage", light}}}}, {"sweep", {{path, {0.2, 0.3}}}}}),
            (std::vector<std::string>{R"([0.2,"described"])", R"([0.3,"described"])"}))
      << "one description, with two of its numbers";
}

TEST(LinkageSweep, IsComputedAndTabulated) {
  const TemporaryStore store;
  jobs::ServiceOptions options;
  options.store = store.file();
  options.threads = 1;
  jobs::Service service(std::move(options));
  json parameters = example("slider_crank");
  parameters["duration_s"] = 0.01;
  const std::string path = "linkage.joints.crank_pin.clearance.clearance_mm";
  const auto sweep = service.submit_sweep({{"parameters", parameters}, {"sweep", {{path, {0.05, 0.1}}}}});
  const std::string id = sweep.at("id");
  ASSERT_TRUE(service.wait_for_sweep(id, std::chrono::minutes(2)));
  const auto table = service.find_results(id);
  ASSERT_TRUE(table);
  const auto place_of = [&](const std::string& column) {
    return static_cast<std::size_t>(std::find(table->columns.begin(), table->columns.end(), column) -
                                    table->columns.begin());
  };
  ASSERT_EQ(table->rows.size(), 2U);
  for (const std::size_t row : {0U, 1U}) {
    EXPECT_EQ(table->rows[row].at(place_of("state")), "succeeded");
    EXPECT_EQ(table->rows[row].at(place_of(path)), row == 0 ? 0.05 : 0.1);
    EXPECT_GT(table->rows[row].at(place_of("peak_guide_acceleration_whole_run_m_s2")).get<double>(), 0.0);
  }
  EXPECT_EQ(place_of("peak_slider_acceleration_m_s2"), table->columns.size())
      << "a metric of another linkage";
}

// Mean and largest value over the replicates, against those of the rows themselves.
void expect_statistics_of(const jobs::ResultTable& table, const std::string& metric) {
  const auto column = static_cast<std::size_t>(
      std::find(table.columns.begin(), table.columns.end(), metric) - table.columns.begin());
  ASSERT_LT(column, table.columns.size());
  double sum = 0.0, most = -1e300;
  for (const auto& row : table.rows) {
    sum += row.at(column).get<double>();
    most = std::max(most, row.at(column).get<double>());
  }
  ASSERT_EQ(table.replicates.size(), table.rows.size());
  const double mean = sum / static_cast<double>(table.rows.size());
  EXPECT_NEAR(table.replicates[0].mean.value(), mean, 1e-9 * most) << metric;
  EXPECT_EQ(table.replicates[0].max.value(), most) << metric;
}

TEST(LinkageSweep, ComparesReplicatesByTheMetricThatIsChosen) {
  const TemporaryStore store;
  jobs::ServiceOptions options;
  options.store = store.file();
  options.threads = 1;
  jobs::Service service(std::move(options));
  json parameters = example("slider_crank");
  parameters["duration_s"] = 0.01;
  parameters["run_up_s"] = 0;
  const std::string metric = "peak_crank_pin_contact_force_n";
  const json replicates{{"count", 3}, {"perturbation", 1e-3}};
  const std::string id =
      service.submit_sweep({{"parameters", parameters}, {"replicates", replicates}}).at("id");
  ASSERT_TRUE(service.wait_for_sweep(id, std::chrono::minutes(2)));
  const auto unasked = service.find_results(id);
  expect_statistics_of(*unasked, unasked->columns.at(3));  // behind job_id, state, replicate: the first one
  expect_statistics_of(*service.find_results(id, {.metric = metric}), metric);
  EXPECT_EQ(pointers_of(faults_of([&] { (void)service.find_results(id, {.metric = "no_metric"}); })),
            std::vector<std::string>{"/metric"});
}

TEST(LinkageSweep, RefusesWhatIsNoPlaceOrNoValueOfTheDescription) {
  const auto pointers = [](const json& axes, const json& parameters) {
    return pointers_of(faults_of([&] {
      (void)jobs::plan_sweep({{"parameters", parameters}, {"sweep", axes}}, 100);
    }));
  };
  const json parameters = example("slider_crank");
  EXPECT_EQ(pointers({{"linkage.bodies.pod.mass_kg", {1, 2}}}, parameters),
            std::vector<std::string>{"/sweep/linkage.bodies.pod.mass_kg"});
  EXPECT_EQ(pointers({{"linkage.bodies.rod.mass_kg", {1, 2}}}, json::object()),
            std::vector<std::string>{"/sweep/linkage.bodies.rod.mass_kg"});
  EXPECT_EQ(pointers({{"linkage.bodies.rod.mass_kg", {1, "heavy"}}}, parameters),
            std::vector<std::string>{"/sweep/linkage.bodies.rod.mass_kg/1"});
  EXPECT_EQ(pointers({{"linkage.bodies.rod.mass_kg", {1, -1}}}, parameters),
            std::vector<std::string>{"/sweep/linkage.bodies.rod.mass_kg"});
  EXPECT_EQ(pointers({{"linkage", {"rpsup"}}}, json::object()), std::vector<std::string>{"/sweep/linkage"});
  json with_centre = parameters;
  with_centre["linkage"]["bodies"]["rod"] = {
      {"mass_kg", 0.2}, {"centre_of_mass_m", {0.1, 0, 0}}, {"inertia_kg_m2", {1e-5, 1e-3, 1e-3}}};
  EXPECT_EQ(pointers({{"linkage.bodies.rod.centre_of_mass_m.0", {0.1, 0.2}}}, with_centre),
            std::vector<std::string>{});
  for (const std::string place : {"3", "00", "-", "x", "123456789012345678901", ""}) {
    const std::string path = "linkage.bodies.rod.centre_of_mass_m." + place;
    EXPECT_EQ(pointers({{path, {1, 2}}}, with_centre), std::vector<std::string>{"/sweep/" + path});
  }
}

// Where the description has no value of its own, or none that is a number, the design has no centre.
TEST(LinkageSweep, NeedsACentreForOneAtATime) {
  const auto pointers = [](const std::string& path, const json& centre) {
    const json span{{"from", 0.1}, {"to", 0.2}, {"count", 2}};
    nlohmann::ordered_json request{{"parameters", example("slider_crank")},
                                   {"design", {{"type", "one_at_a_time"}, {"over", {{path, span}}}}}};
    if (!centre.is_null()) request["design"]["centre"] = {{path, centre}};
    return pointers_of(faults_of([&] { (void)jobs::plan_sweep(request, 100); }));
  };
  EXPECT_EQ(pointers("linkage.bodies.rod.mass_kg", nullptr), std::vector<std::string>{});
  EXPECT_EQ(pointers("linkage.joints.slider_pin.clearance.restitution", nullptr),
            std::vector<std::string>{"/design/centre"});
  EXPECT_EQ(pointers("linkage.joints.slider_pin.clearance.restitution", 0.8), std::vector<std::string>{});
  EXPECT_EQ(pointers("crank_length_m", nullptr), std::vector<std::string>{"/design/centre"})
      << "a described linkage has no such parameter";
  EXPECT_EQ(pointers("linkage.bodies.rod", nullptr), std::vector<std::string>{"/design/centre"});
  EXPECT_EQ(pointers("linkage.bodies.rod.mass_kg.123456789012345678901", nullptr),
            std::vector<std::string>{"/design/centre"});
}

}  // namespace
}  // namespace jobs_tests
