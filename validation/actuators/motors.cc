// SPDX-License-Identifier: Apache-2.0
// Direct-current motors on a flywheel.

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <string>
#include <vector>

#include "validation/actuators/mover.h"
#include "validation/actuators/parts.h"

namespace validation {

namespace {

constexpr double kSupplyVoltage = 12.0;

DcMotor make_motor() {
  return {.voltage = Signal(Constant{kSupplyVoltage}),
          .torque_constant = 0.05,
          .resistance = 0.8,
          .inductance = 2e-3};
}

/// Speed of a motor that starts at rest: J wd = n k i - B w, L id = V - R i - n k w.
/// @param inertia, B  all inertia and viscous friction on the coordinate
double calc_starting_speed(const DcMotor& m, double inertia, double B, double t) {
  const double nk = m.gear_ratio * m.torque_constant, R = m.resistance, L = m.inductance;
  const double steady = nk * kSupplyVoltage / (R * B + nk * nk);
  const std::complex<double> half = 0.5 * (R / L + B / inertia);
  const std::complex<double> root = std::sqrt(half * half - (R * B + nk * nk) / (L * inertia));
  const std::complex<double> s1 = -half + root, s2 = -half - root;
  return (steady * (1.0 + (s2 * std::exp(s1 * t) - s1 * std::exp(s2 * t)) / (s1 - s2))).real();
}

DcMotor make_starting_motor(double inductance) {
  DcMotor motor = make_motor();
  motor.gear_ratio = 3.0;
  motor.rotor_inertia = 1e-3;
  motor.viscous_friction = 1e-4;
  motor.inductance = inductance;
  return motor;
}

/// Largest error of the speed of a start, [rad/s]
double find_speed_error(const DcMotor& motor, const RunResult& run) {
  const double n2 = motor.gear_ratio * motor.gear_ratio;
  const double inertia = kFlywheelInertia + n2 * motor.rotor_inertia, B = n2 * motor.viscous_friction;
  const std::vector<double>&t = column(run, "t_s"), &speed = column(run, "q_rad_s");
  double largest = 0.0;
  for (std::size_t k = 0; k < t.size(); ++k)
    largest = std::max(largest, std::abs(speed[k] - calc_starting_speed(motor, inertia, B, t[k])));
  return largest;
}

void add_motor_start(Findings& findings, double inductance, Integrator integrator, const std::string& of) {
  const DcMotor motor = make_starting_motor(inductance);
  const Linkage linkage = make_mover(JointKind::kRevolute, {.name = "q", .actuator = motor});
  const RunResult run = run_linkage(linkage, integrator, 2.0);
  findings.checks.push_back(limit("speed of a motor that starts at 12 V with a winding of " + of,
                                  "the two exponentials of circuit and rotor", find_speed_error(motor, run),
                                  1e-7, "rad/s", kStepTolerance));
  findings.checks.push_back(limit("energy residual of that start, " + of, "0",
                                  metric_of(linkage, run, "energy_residual"), 1e-8, "1", kStepTolerance));
}

DcMotor make_geared_motor() {
  DcMotor motor = make_motor();
  motor.gear_ratio = 20.0;
  motor.gear_efficiency = 0.7;
  motor.dry_friction = 0.01;
  motor.viscous_friction = 2e-4;
  return motor;
}

/// Steady speed of the rotor under a load, [rad/s]: n (k i - b w - T_d) passed + load = 0 and R i + k w = V.
double calc_steady_speed(const DcMotor& motor, double load) {
  const double passed = load < 0.0 ? motor.gear_efficiency : 1.0 / motor.gear_efficiency;
  const double rotor = -load / (motor.gear_ratio * passed) + motor.dry_friction, k = motor.torque_constant;
  return (k * kSupplyVoltage / motor.resistance - rotor) /
         (k * k / motor.resistance + motor.viscous_friction);
}

void add_loaded_gear(Findings& findings, double load) {
  const DcMotor motor = make_geared_motor();
  const Linkage linkage = make_mover(
      JointKind::kRevolute, {.name = "q", .actuator = motor, .load = ForceLaw{Constant{load}}});
  const RunResult run = run_linkage(linkage, Integrator::kDopri5, 4.0);
  const std::string of = load < 0.0 ? "lifts its load" : "is driven by its load";
  findings.checks.push_back(compare("steady speed of a motor with friction and a gear of 70 % that " + of,
                                    "R i + k w = V with the torques in balance",
                                    column(run, "q_rad_s").back(),
                                    calc_steady_speed(motor, load) / motor.gear_ratio, 1e-6, "rad/s",
                                    kStepTolerance));
  findings.checks.push_back(limit("energy residual of a motor that " + of, "0",
                                  metric_of(linkage, run, "energy_residual"), 1e-8, "1", kStepTolerance));
}

}  // namespace

Findings compute_motor_start() {
  Findings findings;
  for (const double inductance : {2e-3, 2.0})
    for (const auto& [name, integrator] :
         {std::pair{"dopri5", Integrator::kDopri5}, std::pair{"radau5", Integrator::kRadau5}}) {
      const std::string winding = inductance > 1.0 ? "2 H, which swings" : "2 mH";
      add_motor_start(findings, inductance, integrator, winding + ", " + name);
    }
  return findings;
}

Findings compute_stalled_motor() {
  const DcMotor motor = make_motor();
  const double current = kSupplyVoltage / motor.resistance, torque = motor.torque_constant * current;
  const RunResult run = run_linkage(
      make_mover(JointKind::kRevolute,
                 {.name = "q", .damping = 1.0, .actuator = motor, .load = ForceLaw{Constant{-torque}}}),
      Integrator::kDopri5, 3.0);
  Findings findings;
  findings.checks.push_back(compare("current of a motor that its load stalls, after 3 s", "V / R",
                                    column(run, "q_current_a").back(), current, 1e-6, "A", kStepTolerance));
  findings.checks.push_back(compare("its torque", "k V / R", column(run, "q_drive_n_m").back(), torque, 1e-7,
                                    "N m", kStepTolerance));
  return findings;
}

Findings compute_gear() {
  Findings findings;
  for (const double load : {-3.0, 9.0}) add_loaded_gear(findings, load);
  return findings;
}

}  // namespace validation
