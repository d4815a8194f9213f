// SPDX-License-Identifier: Apache-2.0
// Forces that move a freedom: laws, controllers and motors, against closed forms and against their energy account.

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/model/applied_force.h"
#include "tests/engine/linkage_cases.h"
#include "tests/engine/linkage_run.h"

namespace engine {
namespace {

constexpr double kWheelInertia = 0.02;  // of the rotor, [kg m^2]
constexpr double kBlockMass = 2.0;      // of the block, [kg]

/// A flywheel on a shaft, or a block on a level slide, that only its actuator and its load move.
Linkage make_mover(JointKind kind, LinkageFreedom freedom) {
  Linkage linkage;
  linkage.bodies = {make_body("body", kBlockMass, {0.0, 0.0, 0.0}, {kWheelInertia, kWheelInertia, kWheelInertia})};
  linkage.joints = {{.name = "joint", .kind = kind, .from = kGroundName, .to = "body", .placement = {}, .freedoms = {std::move(freedom)}}};
  return linkage;
}
Linkage make_flywheel(LinkageFreedom freedom) { return make_mover(JointKind::kRevolute, std::move(freedom)); }
Linkage make_block(LinkageFreedom freedom) { return make_mover(JointKind::kPrismatic, std::move(freedom)); }

DcMotor make_test_motor() {
  return {.voltage = Signal(Constant{12.0}), .torque_constant = 0.05, .resistance = 0.8, .inductance = 2e-3};
}

RunOptions implicit(double duration) {
  RunOptions options = accurate(duration);
  options.integrator = Integrator::kRadau5;
  return options;
}

/// The speed of a motor that starts at rest: J wd = n k i - B w, L id = V - R i - n k w, the two exponentials of which it is the sum.
/// @param B  all viscous friction on the coordinate
double calc_speed(const DcMotor& m, double inertia, double B, double voltage, double t) {
  const double nk = m.gear_ratio * m.torque_constant, R = m.resistance, L = m.inductance;
  const double steady = nk * voltage / (R * B + nk * nk);
  const std::complex<double> half = 0.5 * (R / L + B / inertia);
  const std::complex<double> root = std::sqrt(half * half - (R * B + nk * nk) / (L * inertia));
  const std::complex<double> s1 = -half + root, s2 = -half - root;
  return (steady * (1.0 + (s2 * std::exp(s1 * t) - s1 * std::exp(s2 * t)) / (s1 - s2))).real();
}

TEST(Actuators, AMotorStartsAsItsTwoExponentialsSay) {
  DcMotor motor = make_test_motor();
  motor.viscous_friction = 1e-4;
  motor.gear_ratio = 3.0;
  motor.rotor_inertia = 1e-3;
  const double inertia = kWheelInertia + 9e-3, B = 9e-4;
  for (const double inductance : {2e-3, 2.0}) {  // the second one swings
    motor.inductance = inductance;
    const LinkageRun run(make_flywheel({.name = "q", .actuator = motor}), accurate(2.0));
    const std::vector<double>& t = run.column("t_s");
    for (std::size_t k = 0; k < t.size(); ++k)
      EXPECT_NEAR(run.column("q_rad_s")[k], calc_speed(motor, inertia, B, 12.0, t[k]), 1e-7) << t[k];
    EXPECT_LT(run.metric("energy_residual"), 1e-9);
  }
}

TEST(Actuators, AStalledMotorDrawsTheCurrentOfItsResistance) {
  const DcMotor motor = make_test_motor();
  const double torque = motor.torque_constant * 12.0 / motor.resistance;
  const LinkageRun run(make_flywheel({.name = "q", .damping = 1.0, .actuator = motor, .load = ForceLaw{Constant{-torque}}}), accurate(3.0));
  EXPECT_NEAR(run.last("q_current_a"), 12.0 / motor.resistance, 1e-6);
  EXPECT_NEAR(run.last("q_rad_s"), 0.0, 1e-6);
  EXPECT_NEAR(run.last("q_drive_n_m"), torque, 1e-7);
  EXPECT_EQ(run.last("q_load_n_m"), -torque);
}

// In the steady state the gear passes on eta of the torque beyond the rotor's friction, and takes 1 / eta when the load drives the rotor.
TEST(Actuators, AGearLosesWhatItDoesNotPassOn) {
  DcMotor motor = make_test_motor();
  motor.gear_ratio = 20.0;
  motor.gear_efficiency = 0.7;
  motor.dry_friction = 0.01;
  motor.viscous_friction = 2e-4;
  for (const double load : {-3.0, 9.0}) {
    const LinkageRun run(make_flywheel({.name = "q", .actuator = motor, .load = ForceLaw{Constant{load}}}), accurate(4.0));
    const double w = 20.0 * run.last("q_rad_s"), i = run.last("q_current_a");
    ASSERT_GT(w, 10.0);
    const double shaft = 0.05 * i - 2e-4 * w - 0.01;
    const double passed = shaft > 0.0 ? 0.7 : 1.0 / 0.7;
    EXPECT_NEAR(20.0 * passed * shaft, -load, 1e-6) << load;
    EXPECT_NEAR(0.8 * i + 0.05 * w, 12.0, 1e-6);
    EXPECT_LT(run.metric("energy_residual"), 1e-9);
    EXPECT_GT(run.metric("structural_loss_j"), 0.0);
  }
}

// Supply = copper loss + kinetic and magnetic energy: the account itself, from the channels.
TEST(Actuators, TheSupplyPaysForAllEnergies) {
  const DcMotor motor = make_test_motor();
  const LinkageRun run(make_flywheel({.name = "q", .actuator = motor}), accurate(1.0));
  const double w = run.last("q_rad_s"), i = run.last("q_current_a");
  const double stored = 0.5 * kWheelInertia * w * w + 0.5 * motor.inductance * i * i;
  EXPECT_NEAR(run.last("kinetic_energy_j"), stored, 1e-8);
  EXPECT_NEAR(run.last("q_electric_work_j"), stored + run.metric("structural_loss_j"), 1e-7);
  EXPECT_NEAR(run.last("drive_work_j"), run.last("q_electric_work_j"), 1e-7);
}

TEST(Actuators, AConstantTorqueSpeedsUpAFlywheel) {
  const LinkageRun run(make_flywheel({.name = "q", .actuator = ForceLaw{Constant{0.5}}}), accurate(2.0));
  EXPECT_NEAR(run.last("q_rad_s"), 0.5 / kWheelInertia * 2.0, 1e-8);
  EXPECT_NEAR(run.last("kinetic_energy_j"), 0.5 * kWheelInertia * 50.0 * 50.0, 1e-6);
  EXPECT_NEAR(run.metric("peak_q_drive_power_w"), 25.0, 1e-7);
  EXPECT_NEAR(run.metric("mean_q_velocity_rad_s"), 25.0, 1e-8);
  EXPECT_NEAR(run.metric("q_speed_fluctuation"), 2.0, 1e-9);
}

TEST(Actuators, AHarmonicForceMovesABlock) {
  const double omega = 7.0;
  const LinkageRun run(make_block({.name = "q", .actuator = ForceLaw{Harmonic{.mean = 0.0, .amplitude = 3.0, .omega = omega}}}), accurate(2.0));
  const double v = 3.0 / kBlockMass / omega * (1.0 - std::cos(omega * 2.0));
  EXPECT_NEAR(run.last("q_m_s"), v, 1e-8);
  EXPECT_NEAR(run.last("drive_work_j"), 0.5 * kBlockMass * v * v, 1e-8);
}

// A pulse far shorter than a step that could be taken is not stepped over.
TEST(Actuators, AShortPulseOfATableIsNotMissed) {
  const TableCurve pulse({0.7, 0.7001, 0.7009, 0.701}, {0.0, 50.0, 50.0, 0.0}, TableInterpolation::kLinear);
  for (const RunOptions& options : {accurate(1.0), implicit(1.0), RunOptions{.duration = 1.0}}) {
    const LinkageRun run(make_block({.name = "q", .actuator = ForceLaw{pulse}}), options);
    EXPECT_NEAR(run.last("q_m_s"), 50.0 * 0.9e-3 / kBlockMass, 1e-9);
  }
}

// A smooth table has no kinks; its points are not passed either, from rest or under a load.
TEST(Actuators, AShortPulseOfASmoothTableIsNotMissed) {
  const TableCurve pulse({0.0, 1.0, 1.0008, 1.001, 1.0012, 1.002, 2.0}, {0.0, 0.0, 0.0, 100.0, 0.0, 0.0, 0.0},
                         TableInterpolation::kMonotoneCubic);
  const double impulse = pulse.calc(2.0).integral;
  ASSERT_GT(impulse, 0.01);
  for (const RunOptions& options : {accurate(1.5), implicit(1.5), RunOptions{.duration = 1.5}}) {
    Linkage loaded = make_block({.name = "q"});
    loaded.loads = {{.name = "push", .body = "body", .force = {0.0, 0.0, 1.0}, .law = pulse}};
    Linkage shaken = make_block({.name = "q"});
    shaken.ground_acceleration[2] = pulse;
    EXPECT_NEAR(LinkageRun(make_block({.name = "q", .actuator = ForceLaw{pulse}}), options).last("q_m_s"), impulse / kBlockMass, 1e-8);
    EXPECT_NEAR(LinkageRun(loaded, options).last("q_m_s"), impulse / kBlockMass, 1e-8);
    EXPECT_NEAR(LinkageRun(shaken, options).last("q_m_s"), -impulse, 1e-8);
  }
}

// An induction motor whose torque falls in proportion to the speed: T = T_0 (1 - w / w_0).
TEST(Actuators, ATorqueSpeedCurveLeadsToItsIdleSpeed) {
  const TableCurve curve({0.0, 40.0}, {0.8, 0.0}, TableInterpolation::kLinear);
  const LinkageRun run(make_flywheel({.name = "q", .actuator = ForceLaw{curve, ForceLaw::Variable::kVelocity}}), accurate(2.0));
  const double tau = kWheelInertia * 40.0 / 0.8;
  EXPECT_NEAR(run.last("q_rad_s"), 40.0 * (1.0 - std::exp(-2.0 / tau)), 1e-7);
}

// A spring with play by a table over the position: it swings with the period of the spring and the two flights through the play.
TEST(Actuators, ATableOverThePositionIsASpringWithPlay) {
  const double k = 800.0, play = 0.01, v = 0.3;
  const TableCurve spring({-1.0 - play, -play, play, 1.0 + play}, {k, 0.0, 0.0, -k}, TableInterpolation::kLinear);
  const double period = 2.0 * std::numbers::pi * std::sqrt(kBlockMass / k) + 4.0 * play / v;
  for (RunOptions options : {accurate(3.0 * period), implicit(3.0 * period)}) {
    const LinkageRun run(make_block({.name = "q", .start = 0.0, .start_rate = v, .load = ForceLaw{spring, ForceLaw::Variable::kPosition}}), options);
    EXPECT_NEAR(run.last("q_m"), 0.0, 1e-6);
    EXPECT_NEAR(run.last("q_m_s"), v, 1e-6);
  }
}

// A controller of the position without limits is a spring and a damper on the way from the target.
// A block at 10 m/s runs over 1 mm of force in a fiftieth of its longest step. The force does 2 J.
TEST(Actuators, ANarrowStretchOfATableOverThePositionIsNotPassedBy) {
  for (const Integrator integrator : {Integrator::kDopri5, Integrator::kRadau5, Integrator::kRodas5})
    for (const double begin : {0.9, 0.95, 1.003}) {
      LinkageFreedom freedom{.name = "q", .start = 0.0, .start_rate = 10.0};
      freedom.load = ForceLaw{TableCurve({begin, begin + 5e-4, begin + 1e-3}, {0.0, 4000.0, 0.0}, TableInterpolation::kLinear),
                              ForceLaw::Variable::kPosition};
      const Linkage block = make_block(freedom);
      const LinkageRun run(block, {.duration = 0.2, .output_rate = 100.0, .integrator = integrator});
      EXPECT_NEAR(run.last("q_m_s"), std::sqrt(102.0), 1e-3) << begin;
    }
}

TEST(Actuators, AControllerOfThePositionIsASpringAndADamper) {
  const Controller controller{.target = Polynomial{{1.0}}, .controlled = Controller::Controlled::kPosition, .proportional = 5.0, .derivative = 0.2};
  const LinkageRun run(make_flywheel({.name = "q", .actuator = controller}), accurate(1.0));
  const double decay = 0.2 / kWheelInertia / 2.0, omega = std::sqrt(5.0 / kWheelInertia - decay * decay);
  const std::vector<double>& t = run.column("t_s");
  for (std::size_t k = 0; k < t.size(); ++k)
    EXPECT_NEAR(run.column("q_rad")[k],
                1.0 - std::exp(-decay * t[k]) * (std::cos(omega * t[k]) + decay / omega * std::sin(omega * t[k])), 1e-8);
}

// Against a constant load a proportional controller leaves an error; the integral takes it away.
TEST(Actuators, TheIntegralTakesAwayTheErrorOfALoad) {
  const RunUp target{.omega = 10.0, .run_up = 0.5};
  const ForceLaw load{Constant{-1.0}};
  Controller controller{.target = target, .proportional = 2.0};
  const LinkageRun without(make_flywheel({.name = "q", .actuator = controller, .load = load}), accurate(3.0));
  EXPECT_NEAR(without.last("q_rad_s"), 10.0 - 1.0 / 2.0, 1e-6);
  controller.integral = 20.0;
  const LinkageRun with(make_flywheel({.name = "q", .actuator = controller, .load = load}), accurate(3.0));
  EXPECT_NEAR(with.last("q_rad_s"), 10.0, 1e-6);
  EXPECT_LT(with.metric("energy_residual"), 1e-8);
}

// A bristle that is not bent yet follows the surfaces, r qd.
TEST(JointFriction, SlidesAtTheRadiusOfThePin) {
  JointFriction friction;
  friction.normal_force = 50.0;
  friction.radius = 0.02;
  const Actuation actuation{.coordinate = 0, .element = friction};
  std::vector<AppliedForceValue> values(list_applied_forces(actuation).size());
  ASSERT_EQ(values.size(), 2U);
  calc_applied_forces(actuation, 0.0, {.v = 3.0}, values.data());
  EXPECT_NEAR(values[1].force, friction.law.sigma_0 * 0.02 * 3.0, 1e-12 * friction.law.sigma_0);
}

// At its limit the controller is a constant torque. With back-calculation it does not overshoot by what the integral has gathered meanwhile.
TEST(Actuators, ALimitHoldsAndTheIntegralDoesNotWindUp) {
  Controller controller{.target = RunUp{.omega = 20.0, .run_up = 0.0}, .proportional = 2.0, .integral = 4.0, .limit = 0.5};
  std::vector<double> overshoots;
  for (const double tracking : {0.5, 1e6}) {
    controller.tracking_time = tracking;
    const LinkageRun run(make_flywheel({.name = "q", .actuator = controller}), accurate(6.0));
    EXPECT_NEAR(run.metric("peak_q_drive_n_m"), 0.5, 1e-3);  // a parabola passes by the corner where it leaves the limit
    EXPECT_EQ(*std::max_element(run.column("q_drive_n_m").begin(), run.column("q_drive_n_m").end()), 0.5);
    EXPECT_NEAR(run.column("q_rad_s")[50], 0.5 / kWheelInertia * 0.5, 1e-7);
    overshoots.push_back(*std::max_element(run.column("q_rad_s").begin(), run.column("q_rad_s").end()) - 20.0);
  }
  EXPECT_GT(overshoots[1], 2.0 * overshoots[0]);
  EXPECT_GT(overshoots[1], 1.0);
}

// A servo: the controller feeds the motor, which follows a spatial slider-crank's angle.
TEST(Actuators, AMotorFollowsItsTargetThroughALinkage) {
  Linkage linkage = make_spatial_slider_crank(JointKind::kSpherical);
  DcMotor motor = make_test_motor();
  motor.gear_ratio = 10.0;
  motor.rotor_inertia = 1e-5;
  motor.voltage = Controller{.target = RunUp{.omega = 6.0, .run_up = 0.5}, .controlled = Controller::Controlled::kPosition,
                             .proportional = 400.0, .integral = 800.0, .derivative = 8.0, .limit = 60.0, .tracking_time = 0.5};
  linkage.joints[0].freedoms[0] = {.name = "theta", .start = 0.0, .start_rate = 0.0, .actuator = motor};
  const LinkageRun explicit_run(linkage, accurate(2.0)), implicit_run(linkage, implicit(2.0));
  EXPECT_NEAR(explicit_run.last("theta_rad"), calc_driven_motion(RunUp{.omega = 6.0, .run_up = 0.5}, 2.0).q, 0.02);
  EXPECT_LT(explicit_run.metric("energy_residual"), 1e-7);
  for (const char* const key : {"theta_rad", "theta_rad_s", "theta_current_a", "theta_voltage_v", "x_m"})
    EXPECT_NEAR(explicit_run.last(key), implicit_run.last(key), 1e-5 * std::max(1.0, std::abs(explicit_run.last(key)))) << key;
}

// A load on a freedom whose motion is given is what its drive must bear as well.
TEST(Actuators, ADriveBearsTheLoad) {
  const Harmonic motion{.mean = 0.0, .amplitude = 0.1, .omega = 5.0};
  const LinkageRun run(make_block({.name = "q", .drive = motion, .load = ForceLaw{Constant{7.0}}}), accurate(1.0));
  EXPECT_NEAR(run.last("q_drive_n"), -kBlockMass * 0.1 * 25.0 * std::sin(5.0) - 7.0, 1e-9);
  EXPECT_LT(run.metric("energy_imbalance_j"), 1e-9);
}

// A stiff controller tends to the prescribed motion as its gain grows: the error falls in proportion to the gain.
TEST(Actuators, AStiffControllerTendsToThePrescribedMotion) {
  const RunUp target{.omega = 6.0, .run_up = 0.5};
  Linkage linkage = make_spatial_slider_crank(JointKind::kSpherical);
  linkage.joints[0].freedoms[0] = {.name = "theta", .drive = target};
  const double peak = LinkageRun(linkage, accurate(2.0)).metric("peak_x_acceleration_m_s2");
  std::vector<double> errors;
  for (const double gain : {1e3, 1e4, 1e5}) {
    linkage.joints[0].freedoms[0] = {.name = "theta", .start = 0.0, .start_rate = 0.0,
                                     .actuator = Controller{.target = target, .controlled = Controller::Controlled::kPosition,
                                                            .proportional = gain, .derivative = 2.0 * std::sqrt(gain * 1e-2)}};
    errors.push_back(std::abs(LinkageRun(linkage, implicit(2.0)).metric("peak_x_acceleration_m_s2") / peak - 1.0));
  }
  EXPECT_LT(errors[1], 0.3 * errors[0]);
  EXPECT_LT(errors[2], 0.3 * errors[1]);
  EXPECT_LT(errors[2], 1e-3);
}

}  // namespace
}  // namespace engine
