// SPDX-License-Identifier: Apache-2.0
// Described linkages as parameters of a job.

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
#include "tests/jobs/requests/example_linkage.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {
namespace {

using nlohmann::json;

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

/// A cantilever at rest under a moment about its axis: its potential energy is M^2 L / (2 G J).
TEST(LinkageLoads, AMomentTwistsABeamUpToItsPlace) {
  json parameters = json::parse(R"({"linkage": {
      "bodies": {"b": {"mass_kg": 1, "beam": {"length_m": 1, "diameter_mm": 20, "elements": 8, "damping_ratio": 0.5}}},
      "joints": {"w": {"kind": "weld", "from": "ground", "to": "b"}}, "gravity_m_s2": [0, 0, 0],
      "loads": {"m": {"body": "b", "direction": [1, 0, 0], "torque_n_m": 3}}},
    "duration_s": 0.3, "run_up_s": 0})");
  const auto energy_at = [&](double x) {
    parameters["linkage"]["loads"]["m"]["at_m"] = {x, 0, 0};
    return column(run(parameters).trajectory, "potential_energy_j").back();
  };
  const double GJ = 0.8e11 * std::numbers::pi * std::pow(0.02, 4) / 32.0;
  EXPECT_NEAR(energy_at(1.0) / (9.0 / (2.0 * GJ)), 1.0, 0.01);
  EXPECT_NEAR(energy_at(0.5) / energy_at(1.0), 0.5, 0.08);  // up to half an element
}

/// The cubic spline through 0, 0.1 and 0 m with level ends turns at 0.1 s with 30 m/s^2, also where the
/// motion is integrated for the sake of a load.
TEST(MotionTable, HasItsPeakAtAKnot) {
  const json parameters = json::parse(R"({"linkage": {
      "bodies": {"b": {"mass_kg": 1}},
      "joints": {"s": {"kind": "prismatic", "from": "ground", "to": "b", "load_n": {"law": "harmonic",
        "amplitude_n": 0.001, "frequency_hz": 1}, "drive": {"law": "table", "times_s": [0, 0.1, 0.2],
        "values_m": [0, 0.1, 0]}}}, "gravity_m_s2": [0, 0, 0]}, "duration_s": 0.4, "run_up_s": 0})");
  const json job = jobs::run_job(parameters, [](double) { return false; }).job;
  EXPECT_NEAR(job.at("metrics").at("peak_s_acceleration_m_s2").get<double>(), 30.0, 1e-6);
}

/// A damper on an angle of a ball joint has no limit at a right angle of the middle one: the run names it,
/// and a start there is refused.
TEST(GimbalLock, IsNamedWhereSomethingActsOnTheAngles) {
  json parameters = json::parse(R"({"linkage": {
      "bodies": {"b": {"mass_kg": 1, "centre_of_mass_m": [0.3, 0, 0], "inertia_kg_m2": [0.001, 0.01, 0.01]}},
      "joints": {"j": {"kind": "spherical", "from": "ground", "to": "b", "freedoms": {
        "z": {"start_rate_rad_s": 0.2, "damping_n_m_s_rad": 0.02}}}}, "gravity_m_s2": [0, 0, -9.81]},
    "duration_s": 1, "run_up_s": 0})");
  const engine::RunResult ended = run(parameters);
  EXPECT_EQ(ended.status, engine::RunStatus::kStepUnderflow);
  EXPECT_EQ(ended.detail.find("at a right angle of j_y"), 0U) << ended.detail;
  parameters["linkage"]["joints"]["j"]["freedoms"]["y"] = {{"start_rad", std::numbers::pi / 2}};
  try {
    (void)run(parameters);
    ADD_FAILURE() << "a start in gimbal lock is no start";
  } catch (const std::exception& refused) {
    EXPECT_NE(std::string(refused.what()).find("at a right angle of j_y"), std::string::npos)
        << refused.what();
  }
}

class LinkageExample : public testing::TestWithParam<const char*> {};

TEST_P(LinkageExample, Runs) {
  json parameters = example(GetParam());
  parameters["duration_s"] = 0.1;
  const jobs::Outcome outcome = jobs::run_job(parameters, [](double) { return false; });
  ASSERT_EQ(outcome.job.at("state"), "succeeded") << outcome.job.at("error");
  const json& metrics = outcome.job.at("metrics");
  // The imbalance of the energy account is small against the largest kinetic energy.
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
                         testing::Values("rpsup", "rsup", "slider_crank", "four_bar", "bricard", "motor_press",
                                         "loose_guide", "loose_socket", "double_pendulum"),
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

constexpr double kOmega = 10.0 * std::numbers::pi;  // [rad/s], of the harmonic drives of joint j below

/// @param force  of the drive at a phase, [N]
template <typename Force>
void expect_drive_force(const json& driven, const Force& force) {
  const engine::RunResult result = run(driven);
  ASSERT_EQ(result.status, engine::RunStatus::kSucceeded) << result.detail;
  const std::vector<double> t = column(result.trajectory, "t_s");
  const std::vector<double> found = column(result.trajectory, "j_drive_n");
  ASSERT_EQ(t.size(), 21U);
  for (std::size_t k = 0; k < t.size(); ++k) EXPECT_NEAR(found[k], force(kOmega * t[k]), 1e-9) << t[k];
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
  expect_drive_force(driven, [](double phase) {
    return 2.0 * (10.0 - 0.1 * kOmega * kOmega * std::sin(phase));
  });
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

TEST(RpsupByData, HasARigidCouplerOfABeamOfOneElement) {
  json described = example("rpsup");
  described["duration_s"] = 0.05;
  described["linkage"]["bodies"]["coupler"] = make_beam(0.0005);
  described["linkage"]["bodies"]["coupler"]["beam"]["elements"] = 1;
  expect_same_bytes(described, {{"duration_s", 0.05}}, same_with_clearance());
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

// The drive works against the mass and the drag, whichever way from the ground the spring points.
TEST(LinkageSprings, DragABodyThatIsDriven) {
  const json driven = json_of(
      R"({"duration_s": 0.2, "output_rate_hz": 100, "linkage": {"bodies": {"b": {"mass_kg": 2}},
    "joints": {"j": {"kind": "prismatic", "axis": "y", "from": "ground", "to": "b",
         "drive": {"law": "harmonic", "amplitude_m": 0.1, "frequency_hz": 5}}},
    "springs": {"air": {"from": "ground", "at_m": [1, 0, 0], "to": "b", "drag_n_s_m": 3}}},
    "gravity_m_s2": 0})");
  expect_drive_force(driven, [](double phase) {
    return 0.1 * kOmega * (3.0 * std::cos(phase) - 2.0 * kOmega * std::sin(phase));
  });
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

}  // namespace
}  // namespace jobs_tests
