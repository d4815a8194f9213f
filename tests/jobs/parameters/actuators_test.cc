// SPDX-License-Identifier: Apache-2.0
// Actuators and loads, of the linkage "rpsup" and of described ones.

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "engine/simulate_rpsup.h"
#include "jobs/requests/expand.h"
#include "jobs/requests/parameters.h"
#include "jobs/run_job.h"
#include "tests/jobs/request_support.h"
#include "tests/jobs/requests/example_linkage.h"

namespace jobs_tests {
namespace {

using nlohmann::json;

json given_motor() {
  return {{"actuator", "dc_motor"}, {"voltage_v", 24}, {"torque_constant_n_m_a", 0.05}, {"resistance_ohm", 0.5}, {"inductance_h", 1e-3},
          {"gear_ratio", 20}, {"gear_efficiency", 0.9}, {"rotor_inertia_kg_m2", 2e-5}};
}

double metric(const json& job, const char* key) { return job.at("metrics").at(key).get<double>(); }

TEST(Actuator, OfTheCrankTakesThePlaceOfItsVelocityAlone) {
  const json completed = jobs::complete_parameters({{"crank_drive", given_motor()}, {"crank_start_rad", 0.5}}, "");
  EXPECT_FALSE(completed.contains("crank_velocity_rad_s"));
  EXPECT_EQ(completed.at("crank_start_rad"), 0.5);
  EXPECT_EQ(completed.at("crank_drive").at("voltage_v").dump(), "24.0");
  const jobs::JobSpec spec = jobs::to_job_spec(completed);
  ASSERT_TRUE(spec.parameters.crank_actuator);
  const auto& read = std::get<engine::DcMotor>(*spec.parameters.crank_actuator);
  EXPECT_EQ(read.gear_ratio, 20.0);
  EXPECT_EQ(std::get<engine::Constant>(std::get<engine::Signal>(read.voltage)).value, 24.0);
}

TEST(Actuator, MovesTheCrankAndIsMeasured) {
  const json given = jobs::complete_parameters({{"crank_drive", given_motor()}, {"duration_s", 1.5}, {"run_up_s", 0.5}}, "");
  const jobs::Outcome outcome = jobs::run_job(given, [](double) { return false; });
  ASSERT_EQ(outcome.job.at("state"), "succeeded") << outcome.job.at("error");
  EXPECT_GT(metric(outcome.job, "mean_crank_velocity_rad_s"), 10.0);
  EXPECT_LT(metric(outcome.job, "mean_crank_velocity_rad_s"), 24.0 / 0.05 / 20.0);
  EXPECT_GT(metric(outcome.job, "crank_speed_fluctuation"), 0.0);
  EXPECT_GT(metric(outcome.job, "peak_crank_current_a"), 1.0);
  EXPECT_GT(metric(outcome.job, "peak_crank_electric_work_j"), 1.0);
  EXPECT_LT(metric(outcome.job, "energy_residual"), 1e-6);
  EXPECT_TRUE(outcome.job.at("metrics").at("amplification").is_null());
  std::vector<std::string> keys;
  for (const auto& channel : outcome.trajectory.channels) keys.push_back(channel.key);
  for (const char* const key : {"crank_current_a", "crank_voltage_v", "crank_electric_work_j"})
    EXPECT_NE(std::ranges::find(keys, key), keys.end()) << key;
}

TEST(Actuator, OfTheRodHoldsItAsAControllerDoes) {
  const json rod{{"actuator", "controller"}, {"controlled", "position"}, {"target", {{"law", "polynomial"}, {"coefficients_m", {-0.05}}}},
                 {"proportional", 1e5}, {"derivative", 1e3}};
  const json given = jobs::complete_parameters({{"rod_drive", rod}, {"duration_s", 0.5}, {"run_up_s", 0.1}}, "");
  EXPECT_TRUE(given.contains("rod_start_m"));
  EXPECT_FALSE(given.contains("rod_stroke_mm"));
  const jobs::Outcome outcome = jobs::run_job(given, [](double) { return false; });
  ASSERT_EQ(outcome.job.at("state"), "succeeded") << outcome.job.at("error");
  EXPECT_TRUE(outcome.job.at("metrics").at("mean_crank_velocity_rad_s").is_null());
}

TEST(Actuator, OfTheRodMayBeAMotor) {
  json motor = given_motor();
  motor.erase("gear_ratio");
  motor["gear_ratio_rad_m"] = 2000;
  motor["voltage_v"] = {{"law", "harmonic"}, {"amplitude_v", 12}, {"frequency_hz", 5}};
  const json given =
      jobs::complete_parameters({{"rod_drive", motor}, {"duration_s", 0.2}, {"run_up_s", 0.1}}, "");
  const jobs::Outcome outcome = jobs::run_job(given, [](double) { return false; });
  ASSERT_EQ(outcome.job.at("state"), "succeeded") << outcome.job.at("error");
  EXPECT_GT(metric(outcome.job, "peak_rod_current_a"), 0.0);
  EXPECT_LT(metric(outcome.job, "peak_rod_current_a"), 2.0 * 12.0 / 0.5)
      << "voltage and back-EMF by resistance";
  EXPECT_GT(metric(outcome.job, "peak_rod_electric_work_j"), 0.0);
  EXPECT_TRUE(outcome.job.at("metrics").at("peak_crank_current_a").is_null());
  EXPECT_TRUE(outcome.job.at("metrics").at("peak_crank_electric_work_j").is_null());
}

TEST(Actuator, NumbersOfOneAreSwept) {
  const jobs::SweepPlan plan = jobs::plan_sweep(
      {{"parameters", {{"crank_drive", given_motor()}}}, {"sweep", {{"crank_drive.voltage_v", {12, 24}}, {"crank_drive.dry_friction_n_m", {0, 0.01}}}}}, 100);
  ASSERT_EQ(plan.jobs.size(), 4U);
  EXPECT_EQ(plan.jobs[0].swept, "[12.0,0.0]");
}

// A number inside a drive is checked as the drive itself is: a path must not bring in what the drive would refuse.
TEST(Actuator, NumbersOfOneAreCheckedWhereTheyAreSwept) {
  const json run_up{{"law", "run_up"}, {"velocity_rad_s", 5}};
  const struct {
    json drive;
    const char* path;
    json values;
  } cases[] = {{given_motor(), "crank_drive.gear_efficiency", {0.5, 2}},
               {given_motor(), "crank_drive.inductance_h", {0}},
               {given_motor(), "crank_drive.controller", {5, 6}},
               {given_motor(), "crank_drive.gear_ratio_rad_m", {1, 2}},
               {given_motor(), "crank_drive.", {1, 2}},
               {run_up, "crank_drive.voltage_v", {12, 24}},
               {run_up, "crank_drive.actuator", {5, 6}},
               {run_up, "crank_drive.law", {5, 6}},
               {{{"law", "harmonic"}, {"amplitude_rad", 1}, {"frequency_hz", 1}}, "crank_drive.frequency_hz", {-1}},
               {{{"actuator", "torque"}, {"torque_n_m", {{"law", "table"}, {"times_s", {0, 1}}, {"values_n_m", {0, 1}}}}},
                "crank_drive.torque_n_m.times_s.1", {-1, 0}}};
  for (const auto& [drive, path, values] : cases) {
    const json request{{"parameters", {{"crank_drive", drive}}}, {"sweep", {{path, values}}}};
    EXPECT_FALSE(faults_of([&] { (void)jobs::plan_sweep(request, 100); }).empty()) << path;
  }
}

TEST(Actuator, IsShownByItsKindInTheCasesOfASweep) {
  json faster = given_motor();
  faster["voltage_v"] = 30;
  const jobs::SweepPlan plan = jobs::plan_sweep({{"cases", {{{"crank_drive", given_motor()}}, {{"crank_drive", faster}}}}}, 100);
  EXPECT_EQ(plan.jobs.at(0).swept, R"(["dc_motor"])");
  EXPECT_EQ(plan.jobs.at(1).swept, R"(["dc_motor #2"])");
}

struct RefusedDrive {
  const char* name;
  const char* drive;    ///< of the crank
  const char* pointer;  ///< below /parameters/crank_drive
  const char* says;
};
void PrintTo(const RefusedDrive& refused, std::ostream* out) { *out << refused.name; }

class RefusedActuator : public testing::TestWithParam<RefusedDrive> {};

TEST_P(RefusedActuator, IsNamedWithItsPlace) {
  const json request{{"parameters", {{"crank_drive", json_of(GetParam().drive)}}}};
  const auto faults = faults_of([&] { (void)jobs::plan_sweep(request, 100); });
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].pointer, std::string("/parameters/crank_drive") + GetParam().pointer);
  EXPECT_NE(faults[0].detail.find(GetParam().says), std::string::npos) << faults[0].detail;
}

const RefusedDrive kRefusedActuators[] = {
    {"unknown_actuator", R"({"actuator": "steam"})", "/actuator", "dc_motor"},
    {"number_as_actuator", R"({"actuator": 3})", "/actuator", "dc_motor"},
    {"force_of_what_turns", R"({"actuator": "force", "force_n": 3})", "/actuator", "torque"},
    {"motion_beside_it", R"({"actuator": "torque", "torque_n_m": 1, "law": "run_up"})", "/law", "unknown key"},
    {"no_torque", R"({"actuator": "torque"})", "/torque_n_m", "missing"},
    {"word_as_torque", R"({"actuator": "torque", "torque_n_m": "much"})", "/torque_n_m", "a number or an object"},
    {"torque_out_of_range", R"({"actuator": "torque", "torque_n_m": 1e10})", "/torque_n_m", "1000000000"},
    {"unknown_law", R"({"actuator": "torque", "torque_n_m": {"law": "square"}})", "/torque_n_m/law", "harmonic"},
    {"no_law", R"({"actuator": "torque", "torque_n_m": {}})", "/torque_n_m/law", "harmonic"},
    {"no_variable", R"({"actuator": "torque", "torque_n_m": {"law": "table", "values_n_m": [1, 2]}})", "/torque_n_m", "one of times_s"},
    {"two_variables", R"({"actuator": "torque", "torque_n_m": {"law": "table", "values_n_m": [1, 2], "times_s": [0, 1], "positions_rad": [0, 1]}})",
     "/torque_n_m", "one of times_s"},
    {"positions_that_fall", R"({"actuator": "torque", "torque_n_m": {"law": "table", "values_n_m": [1, 2], "positions_rad": [1, 0]}})",
     "/torque_n_m/positions_rad", "rise"},
    {"fewer_values", R"({"actuator": "torque", "torque_n_m": {"law": "table", "values_n_m": [1, 2], "velocities_rad_s": [0, 1, 2]}})",
     "/torque_n_m/values_n_m", "each of the 3"},
    {"no_gain", R"({"actuator": "controller", "controlled": "velocity", "target": {"law": "run_up", "velocity_rad_s": 5}})", "", "gain"},
    {"negative_gain", R"({"actuator": "controller", "controlled": "velocity", "target": {"law": "run_up", "velocity_rad_s": 5}, "proportional": -1})",
     "/proportional", "(0"},
    {"no_target", R"({"actuator": "controller", "controlled": "velocity", "proportional": 1})", "/target", "missing"},
    {"actuator_as_target", R"({"actuator": "controller", "controlled": "velocity", "proportional": 1, "target": {"actuator": "torque"}})", "/target",
     "a law"},
    {"fault_in_the_target", R"({"actuator": "controller", "controlled": "velocity", "proportional": 1, "target": {"law": "run_up"}})",
     "/target/velocity_rad_s", "missing"},
    {"derivative_of_a_velocity",
     R"({"actuator": "controller", "controlled": "velocity", "proportional": 1, "derivative": 1, "target": {"law": "run_up", "velocity_rad_s": 5}})",
     "/derivative", "unknown key"},
    {"limit_in_volts", R"({"actuator": "controller", "controlled": "velocity", "proportional": 1, "limit_v": 1, "target": {"law": "run_up",
     "velocity_rad_s": 5}})", "/limit_v", "limit_n_m"},
    {"no_resistance", R"({"actuator": "dc_motor", "voltage_v": 1, "torque_constant_n_m_a": 1, "inductance_h": 1})", "/resistance_ohm", "missing"},
    {"no_inductance", R"({"actuator": "dc_motor", "voltage_v": 1, "torque_constant_n_m_a": 1, "inductance_h": 0, "resistance_ohm": 1})", "/inductance_h",
     "1e-07"},
    {"no_voltage", R"({"actuator": "dc_motor", "torque_constant_n_m_a": 1, "inductance_h": 1, "resistance_ohm": 1})", "", "voltage_v or a controller"},
    {"voltage_and_controller", R"({"actuator": "dc_motor", "voltage_v": 1, "torque_constant_n_m_a": 1, "inductance_h": 1, "resistance_ohm": 1,
     "controller": {"controlled": "velocity", "proportional": 1, "target": {"law": "run_up", "velocity_rad_s": 5}}})", "", "voltage_v or a controller"},
    {"voltage_over_the_angle", R"({"actuator": "dc_motor", "torque_constant_n_m_a": 1, "inductance_h": 1, "resistance_ohm": 1,
     "voltage_v": {"law": "table", "positions_rad": [0, 1], "values_v": [0, 1], "times_s": [0, 1]}})", "/voltage_v/positions_rad", "unknown key"},
    {"efficiency_above_1", R"({"actuator": "dc_motor", "voltage_v": 1, "torque_constant_n_m_a": 1, "inductance_h": 1, "resistance_ohm": 1,
     "gear_efficiency": 1.1})", "/gear_efficiency", "(0, 1]"},
};

INSTANTIATE_TEST_SUITE_P(All, RefusedActuator, testing::ValuesIn(kRefusedActuators), [](const auto& test) { return std::string(test.param.name); });

TEST(Load, StandsBesideADrive) {
  json given = example("motor_press");
  json& guide = given["linkage"]["joints"]["guide"];
  guide["load_n"] = {{"law", "harmonic"}, {"amplitude_n", 10}};
  EXPECT_EQ(pointers_of(faults_of([&] { (void)jobs::complete_parameters(given, ""); })),
            std::vector<std::string>{"/linkage/joints/guide/load_n/frequency_hz"});
  guide["load_n"] = 5;
  EXPECT_NO_THROW((void)jobs::complete_parameters(given, ""));
  guide["load_n_m"] = 5;
  EXPECT_EQ(pointers_of(faults_of([&] { (void)jobs::complete_parameters(given, ""); })),
            std::vector<std::string>{"/linkage/joints/guide/load_n_m"});
}

struct RefusedLoad {
  const char* name;
  const char* load;
  const char* pointer;  ///< below /linkage/loads/l
};
void PrintTo(const RefusedLoad& refused, std::ostream* out) { *out << refused.name; }

class RefusedBodyLoad : public testing::TestWithParam<RefusedLoad> {};

TEST_P(RefusedBodyLoad, IsNamedWithItsPlace) {
  json given = example("motor_press");
  given["linkage"]["loads"] = {{"l", json_of(GetParam().load)}};
  EXPECT_EQ(pointers_of(faults_of([&] { (void)jobs::complete_parameters(given, ""); })),
            std::vector<std::string>{std::string("/linkage/loads/l") + GetParam().pointer});
}

const RefusedLoad kRefusedLoads[] = {
    {"no_body", R"({"direction": [1, 0, 0], "force_n": 1})", "/body"},
    {"on_no_body", R"({"body": "slide", "direction": [1, 0, 0], "force_n": 1})", "/body"},
    {"on_the_ground", R"({"body": "ground", "direction": [1, 0, 0], "force_n": 1})", "/body"},
    {"no_direction", R"({"body": "slider", "force_n": 1})", "/direction"},
    {"direction_of_nothing", R"({"body": "slider", "direction": [0, 0, 0], "force_n": 1})", "/direction"},
    {"neither", R"({"body": "slider", "direction": [1, 0, 0]})", ""},
    {"both", R"({"body": "slider", "direction": [1, 0, 0], "force_n": 1, "torque_n_m": 1})", ""},
    {"over_the_position", R"({"body": "slider", "direction": [1, 0, 0], "force_n": {"law": "table", "positions_m": [0, 1], "values_n": [0, 1],
     "times_s": [0, 1]}})", "/force_n/positions_m"},
};

INSTANTIATE_TEST_SUITE_P(All, RefusedBodyLoad, testing::ValuesIn(kRefusedLoads), [](const auto& test) { return std::string(test.param.name); });

TEST(BodyLoad, AndTheGroundsAccelerationAreRead) {
  json given = example("motor_press");
  given["linkage"]["loads"] = {{"push", {{"body", "slider"}, {"direction", {0, 3, 4}}, {"force_n", 10}, {"at_m", {0, 0, 0.1}}}}};
  given["linkage"]["ground_acceleration_m_s2"] = {{"y", {{"law", "harmonic"}, {"amplitude_m_s2", 2}, {"frequency_hz", 3}}}};
  const engine::Linkage linkage = *jobs::to_job_spec(jobs::complete_parameters(given, "")).linkage;
  ASSERT_EQ(linkage.loads.size(), 1U);
  EXPECT_TRUE(linkage.loads[0].force.isApprox(Eigen::Vector3d(0.0, 0.6, 0.8)));
  given["linkage"]["loads"]["push"]["direction"] = {0, 3e-200, 4e-200};
  EXPECT_TRUE(jobs::to_job_spec(jobs::complete_parameters(given, "")).linkage->loads[0].force.isApprox(linkage.loads[0].force));
  EXPECT_FALSE(linkage.ground_acceleration[0]);
  EXPECT_EQ(std::get<engine::Harmonic>(*linkage.ground_acceleration[1]).amplitude, 2.0);
  given["linkage"]["ground_acceleration_m_s2"]["w"] = 3;
  EXPECT_EQ(pointers_of(faults_of([&] { (void)jobs::complete_parameters(given, ""); })),
            std::vector<std::string>{"/linkage/ground_acceleration_m_s2/w"});
}

const RefusedLoad kRefusedAccelerometers[] = {
    {"no_body", R"({"direction": [1, 0, 0]})", "/body"},
    {"on_no_body", R"({"body": "slide", "direction": [1, 0, 0]})", "/body"},
    {"on_the_ground", R"({"body": "ground", "direction": [1, 0, 0]})", "/body"},
    {"no_direction", R"({"body": "slider"})", "/direction"},
    {"direction_of_nothing", R"({"body": "slider", "direction": [0, 0.0, -0.0]})", "/direction"},
    {"two_directions", R"({"body": "slider", "direction": [[1, 0, 0], [0, 1, 0]]})", "/direction"},
    {"unknown_key", R"({"body": "slider", "direction": [1, 0, 0], "gain": 2})", "/gain"},
    {"no_flag", R"({"body": "slider", "direction": [1, 0, 0], "shows_gravity": 1})", "/shows_gravity"},
};

class RefusedAccelerometer : public testing::TestWithParam<RefusedLoad> {};

TEST_P(RefusedAccelerometer, IsNamedWithItsPlace) {
  json given = example("motor_press");
  given["linkage"]["accelerometers"] = {{"l", json_of(GetParam().load)}};
  EXPECT_EQ(pointers_of(faults_of([&] { (void)jobs::complete_parameters(given, ""); })),
            std::vector<std::string>{std::string("/linkage/accelerometers/l") + GetParam().pointer});
}

INSTANTIATE_TEST_SUITE_P(All, RefusedAccelerometer, testing::ValuesIn(kRefusedAccelerometers),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Accelerometer, IsRead) {
  json given = example("motor_press");
  given["linkage"]["accelerometers"] = {{"imu", {{"body", "slider"}, {"direction", {0, 3, 4}}, {"at_m", {0, 0, 0.1}}}}};
  const engine::Linkage linkage = *jobs::to_job_spec(jobs::complete_parameters(given, "")).linkage;
  ASSERT_EQ(linkage.accelerometers.size(), 1U);
  EXPECT_TRUE(linkage.accelerometers[0].direction.isApprox(Eigen::Vector3d(0.0, 0.6, 0.8)));
  EXPECT_EQ(linkage.accelerometers[0].at.z(), 0.1);
  EXPECT_TRUE(linkage.accelerometers[0].follows_body);
  EXPECT_TRUE(linkage.accelerometers[0].shows_gravity);
}

TEST(Friction, OfAFreedomIsRead) {
  json given = example("motor_press");
  given["linkage"]["joints"]["guide"]["friction"] = {{"normal_force_n", 20}, {"friction_kinetic", 0.25}};
  given["linkage"]["joints"]["wrist"]["friction"] = {{"normal_force_n", 30}, {"radius_mm", 5}, {"friction", "coulomb"}};
  const engine::Linkage linkage = *jobs::to_job_spec(jobs::complete_parameters(given, "")).linkage;
  for (const engine::LinkageJoint& joint : linkage.joints) {
    if (joint.name == "guide") {
      EXPECT_EQ(joint.freedoms[0].friction->law.mu_k, 0.25);
      EXPECT_EQ(joint.freedoms[0].friction->radius, 1.0);
    } else if (joint.name == "wrist") {
      EXPECT_EQ(joint.freedoms[0].friction->law.law, engine::FrictionLaw::kCoulomb);
      EXPECT_EQ(joint.freedoms[0].friction->radius, 0.005);
    }
  }
  const jobs::Outcome outcome = jobs::run_job(given, [](double) { return false; });
  ASSERT_EQ(outcome.job.at("state"), "succeeded") << outcome.job.at("error");
  EXPECT_GT(metric(outcome.job, "friction_work_j"), 0.1);
  json& wrist = given["linkage"]["joints"]["wrist"]["friction"];
  wrist.erase("radius_mm");
  EXPECT_EQ(pointers_of(faults_of([&] { (void)jobs::complete_parameters(given, ""); })),
            std::vector<std::string>{"/linkage/joints/wrist/friction/radius_mm"});
  wrist = {{"normal_force_n", 30}, {"radius_mm", 5}, {"friction", "ambrosio"}, {"friction_velocity_1_m_s", 1e-5}};
  EXPECT_EQ(pointers_of(faults_of([&] { (void)jobs::complete_parameters(given, ""); })),
            std::vector<std::string>{"/linkage/joints/wrist/friction/friction_velocity_1_m_s"});
}

TEST(Actuator, JointsRubByWhatTheyBear) {
  json given = example("motor_press");
  json& friction = given["linkage"]["joints"]["guide"]["friction"];
  friction = {{"by_reaction", true}, {"friction_kinetic", 0.25}, {"length_mm", 80}};
  const jobs::Outcome outcome = jobs::run_job(given, [](double) { return false; });
  ASSERT_EQ(outcome.job.at("state"), "succeeded") << outcome.job.at("error");
  EXPECT_GT(metric(outcome.job, "friction_work_j"), 1.0);
  EXPECT_LT(metric(outcome.job, "energy_residual"), 1e-6);
  friction = {{"friction_kinetic", 0.25}};
  EXPECT_EQ(pointers_of(faults_of([&] { (void)jobs::complete_parameters(given, ""); })),
            std::vector<std::string>{"/linkage/joints/guide/friction/normal_force_n"});
  friction = {{"normal_force_n", 3}, {"length_mm", 80}};
  EXPECT_EQ(pointers_of(faults_of([&] { (void)jobs::complete_parameters(given, ""); })),
            std::vector<std::string>{"/linkage/joints/guide/friction/length_mm"});
}

// A motion would say where the freedom is at t = 0; an actuator does not.
TEST(Actuator, LeavesTheStartToTheFreedom) {
  json given = example("motor_press");
  json& crank = given["linkage"]["joints"]["crank"];
  crank["start_rad"] = 1.0;
  crank["start_rate_rad_s"] = 5.0;
  EXPECT_NO_THROW((void)jobs::complete_parameters(given, ""));
  crank["drive"] = {{"law", "run_up"}, {"velocity_rad_s", 5}};
  EXPECT_EQ(pointers_of(faults_of([&] { (void)jobs::complete_parameters(given, ""); })).size(), 2U);
}

}  // namespace
}  // namespace jobs_tests
