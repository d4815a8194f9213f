// SPDX-License-Identifier: Apache-2.0
// Descriptions with clearance in joints of every kind: coordinates, and the motion by numbers known otherwise.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/simulate_linkage.h"
#include "jobs/requests/parameters.h"
#include "tests/jobs/request_support.h"

namespace jobs_tests {
namespace {

using nlohmann::json;

/// A body on one joint with the ground.
json one_joint(const json& joint) {
  json whole = joint;
  whole["from"] = "ground";
  whole["to"] = "body";
  return {{"linkage", {{"bodies", {{"body", {{"mass_kg", 1}, {"inertia_kg_m2", {1e-3, 1e-3, 1e-3}}}}}},
                       {"joints", {{"j", whole}}}}},
          {"duration_s", 0.05},
          {"friction", "none"}};
}

std::vector<std::string> positions_of(const json& parameters) {
  const jobs::JobSpec spec = jobs::to_job_spec(jobs::complete_parameters(parameters, ""));
  std::vector<std::string> keys;
  for (const auto& channel : engine::linkage_tables(*spec.linkage).channels)
    if (channel.key.starts_with("j") && (channel.key.ends_with("_m") || channel.key.ends_with("_rad")) &&
        channel.key.find("_n_m") == std::string::npos)
      keys.push_back(channel.key);
  return keys;
}

TEST(LooseJoints, HaveAllFreedomsByTheirNames) {
  using Names = std::vector<std::string>;
  const json block{{"block_width_mm", 20}, {"block_height_mm", 20}};
  EXPECT_EQ(positions_of(one_joint({{"kind", "revolute"}, {"clearance", json::object()}})),
            (Names{"j_slide_x_m", "j_slide_y_m", "j_slide_z_m", "j_rad", "j_turn_y_rad", "j_turn_x_rad"}));
  EXPECT_EQ(positions_of(one_joint({{"kind", "revolute"}, {"axis", "x"}, {"clearance", json::object()}})),
            (Names{"j_slide_x_m", "j_slide_y_m", "j_slide_z_m", "j_rad", "j_turn_z_rad", "j_turn_y_rad"}));
  EXPECT_EQ(positions_of(one_joint({{"kind", "prismatic"}, {"axis", "y"}, {"clearance", block}})),
            (Names{"j_slide_x_m", "j_m", "j_slide_z_m", "j_turn_y_rad", "j_turn_z_rad", "j_turn_x_rad"}));
  EXPECT_EQ(positions_of(one_joint({{"kind", "cylindrical"}, {"clearance", json::object()}})),
            (Names{"j_slide_x_m", "j_slide_y_m", "j_slide_m", "j_turn_rad", "j_turn_y_rad", "j_turn_x_rad"}));
  EXPECT_EQ(positions_of(one_joint({{"kind", "spherical"}, {"clearance", json::object()}})),
            (Names{"j_slide_x_m", "j_slide_y_m", "j_slide_z_m", "j_z_rad", "j_y_rad", "j_x_rad"}));
  const json universal{{"kind", "universal"},
                       {"clearance", json::object()},
                       {"cross", {{"mass_kg", 0.1}, {"inertia_kg_m2", {1e-5, 1e-5, 1e-5}}}}};
  EXPECT_EQ(positions_of(one_joint(universal)).size(), 12U);
}

TEST(LooseJoints, WithoutPlayAreIdeal) {
  for (const char* const kind : {"revolute", "cylindrical", "spherical"}) {
    const json ideal{{"kind", kind}}, closed{{"kind", kind}, {"clearance", {{"clearance_mm", 0}}}};
    EXPECT_EQ(positions_of(one_joint(closed)), positions_of(one_joint(ideal))) << kind;
  }
}

// The job's other parameters, those of all points of a sweep too, are what a joint or beam does not say.
TEST(LooseJoints, AreJudgedWithTheJobsOtherParameters) {
  json parameters = one_joint({{"kind", "revolute"}, {"clearance", {{"clearance_mm", 8}}}});
  const auto pointers = [](const json& given, const json& beside) {
    return pointers_of(jobs::find_value_faults(given, beside));
  };
  const std::string place = "/linkage/joints/j/clearance/clearance_mm";
  EXPECT_EQ(pointers(parameters, json::object()), std::vector<std::string>{place});
  EXPECT_EQ(pointers(parameters, {{"bearing_radius_mm", 20}}), std::vector<std::string>{});
  parameters["bearing_radius_mm"] = 20;
  EXPECT_EQ(pointers(parameters, json::object()), std::vector<std::string>{});
  json& body = parameters["linkage"]["bodies"]["body"];
  body = {{"mass_kg", 1}, {"beam", {{"length_m", 1}, {"diameter_mm", 20}, {"youngs_modulus_pa", 2.6e11}}}};
  EXPECT_EQ(pointers(parameters, json::object()).size(), 1U);
  parameters["shear_modulus_pa"] = 1e11;
  EXPECT_EQ(pointers(parameters, json::object()), std::vector<std::string>{});
}

TEST(LooseJoints, WithoutABoreHaveNoBoreToFitInto) {
  const json block{{"block_width_mm", 20}, {"block_height_mm", 20}, {"clearance_mm", 0.1}};
  json parameters = one_joint({{"kind", "prismatic"}, {"clearance", block}});
  parameters["clearance_mm"] = 6;
  EXPECT_NO_THROW((void)jobs::complete_parameters(parameters, ""));
}

/// The last sample of a channel.
double last_of(const json& parameters, const std::string& key) {
  const jobs::JobSpec spec = jobs::to_job_spec(jobs::complete_parameters(parameters, ""));
  const engine::RunResult run = engine::simulate_linkage(*spec.linkage, spec.options, spec.parameters.run_up, {});
  EXPECT_EQ(run.status, engine::RunStatus::kSucceeded) << run.detail;
  for (std::size_t k = 0; k < run.trajectory.channels.size(); ++k)
    if (run.trajectory.channels[k].key == key) return run.trajectory.columns[k].back();
  ADD_FAILURE() << "no channel " << key;
  return 0.0;
}

// Two shafts at 30 degrees: tan(output) = tan(input) / cos(30 degrees), but for the play of 5 um over trunnions of 20 mm.
TEST(LooseJoints, AUniversalJointTurnsAsItsCrossDoes) {
  json parameters = json::parse(R"({"linkage": {
    "bodies": {"in": {"mass_kg": 1, "inertia_kg_m2": [1e-3, 1e-3, 1e-3]}, "out": {"mass_kg": 1, "inertia_kg_m2": [1e-3, 1e-3, 1e-3]}},
    "joints": {
      "input": {"kind": "revolute", "axis": "x", "from": "ground", "to": "in", "drive": {"law": "run_up", "velocity_rad_s": 10, "time_s": 0.05}},
      "output": {"kind": "revolute", "axis": "x", "from": "ground", "to": "out", "at_m": [0.1, 0, 0], "turned_deg": [0, 0, 30],
        "damping_n_m_s_rad": 0.01},
      "u": {"kind": "universal", "from": "in", "to": "out", "axis": "y", "second_axis": "z", "at_m": [0.1, 0, 0], "closes_loop": true,
        "clearance": {"clearance_mm": 0.005, "friction": "none"}, "cross": {"mass_kg": 0.05, "inertia_kg_m2": [1e-5, 1e-5, 1e-5]}}}},
    "duration_s": 0.12})");
  const double input = last_of(parameters, "input_rad"), output = last_of(parameters, "output_rad");
  ASSERT_NEAR(input, 0.95, 0.01);
  EXPECT_NEAR(output, std::atan(std::tan(input) / std::cos(std::acos(-1.0) / 6.0)), 2e-3);
  // The cross turns alike where the loop is cut at the output instead.
  const double cut_there = last_of(parameters, "u_first_rad");
  json& joints = parameters["linkage"]["joints"];
  joints["u"].erase("closes_loop");
  joints["output"].erase("damping_n_m_s_rad");
  joints["output"]["closes_loop"] = true;
  EXPECT_GT(std::abs(cut_there), 0.1);
  EXPECT_NEAR(last_of(parameters, "u_first_rad"), cut_there, 2e-3);
}

}  // namespace
}  // namespace jobs_tests
