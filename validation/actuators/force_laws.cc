// SPDX-License-Identifier: Apache-2.0
// Forces and torques by laws over time, speed and position, and by controllers.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "validation/actuators/mover.h"
#include "validation/actuators/parts.h"

namespace validation {

namespace {

RunResult run_flywheel(LinkageFreedom freedom, double duration) {
  return run_linkage(make_mover(JointKind::kRevolute, std::move(freedom)), Integrator::kDopri5, duration);
}
RunResult run_block(LinkageFreedom freedom, double duration, Integrator integrator = Integrator::kDopri5) {
  return run_linkage(make_mover(JointKind::kPrismatic, std::move(freedom)), integrator, duration);
}

void add_constant_torque(Findings& findings) {
  const double torque = 0.5, speed = torque / kFlywheelInertia * 2.0;
  const double energy = 0.5 * kFlywheelInertia * speed * speed;
  const RunResult flywheel = run_flywheel({.name = "q", .actuator = ForceLaw{Constant{torque}}}, 2.0);
  findings.checks.push_back(compare("speed of a flywheel after 2 s of a constant torque", "T t / J",
                                    column(flywheel, "q_rad_s").back(), speed, 1e-8, "rad/s",
                                    kStepTolerance));
  findings.checks.push_back(compare("its energy", "J w^2 / 2", column(flywheel, "kinetic_energy_j").back(),
                                    energy, 1e-6, "J", kStepTolerance));
  findings.checks.push_back(compare("work of the torque", "J w^2 / 2",
                                    column(flywheel, "drive_work_j").back(), energy, 1e-6, "J",
                                    kStepTolerance));
}

Check compare_harmonic_force() {
  const Harmonic harmonic{.mean = 0.0, .amplitude = 3.0, .omega = 7.0};
  return compare("velocity of a block after 2 s of a harmonic force", "F (1 - cos(omega t)) / (m omega)",
                 column(run_block({.name = "q", .actuator = ForceLaw{harmonic}}, 2.0), "q_m_s").back(),
                 3.0 / (kBlockMass * 7.0) * (1.0 - std::cos(14.0)), 1e-8, "m/s", kStepTolerance);
}

void add_pulses(Findings& findings) {
  const TableCurve pulse({0.7, 0.7001, 0.7009, 0.701}, {0.0, 50.0, 50.0, 0.0}, TableInterpolation::kLinear);
  for (const auto& [name, integrator] :
       {std::pair{"dopri5", Integrator::kDopri5}, std::pair{"radau5", Integrator::kRadau5}})
    findings.checks.push_back(compare(
        std::string("velocity of a block after a pulse of 1 ms, ") + name, "integral of F / m",
        column(run_block({.name = "q", .actuator = ForceLaw{pulse}}, 1.0, integrator), "q_m_s").back(),
        50.0 * 0.9e-3 / kBlockMass, 1e-9, "m/s", "steps end at the kinks of a table"));
}

Check compare_falling_torque() {
  const double idle = 40.0, stall = 0.8;
  const TableCurve curve({0.0, idle}, {stall, 0.0}, TableInterpolation::kLinear);
  const RunResult run =
      run_flywheel({.name = "q", .actuator = ForceLaw{curve, ForceLaw::Variable::kVelocity}}, 2.0);
  return compare("speed of a flywheel after 2 s of a torque that falls in proportion to it",
                 "w_0 (1 - exp(-T_0 t / (J w_0)))", column(run, "q_rad_s").back(),
                 idle * (1.0 - std::exp(-2.0 * stall / (kFlywheelInertia * idle))), 1e-7, "rad/s",
                 kStepTolerance);
}

Check compare_spring_with_play() {
  const double k = 800.0, play = 0.01, v = 0.3;
  const TableCurve spring({-1.0 - play, -play, play, 1.0 + play}, {k, 0.0, 0.0, -k},
                          TableInterpolation::kLinear);
  const double period = 2.0 * std::numbers::pi * std::sqrt(kBlockMass / k) + 4.0 * play / v;
  const RunResult swing = run_block({.name = "q",
                                     .start = 0.0,
                                     .start_rate = v,
                                     .load = ForceLaw{spring, ForceLaw::Variable::kPosition}},
                                    3.0 * period);
  return compare("position of a block on a spring with play after three periods",
                 "period 2 pi sqrt(m / k) + 4 play / v", column(swing, "q_m").back(), 0.0, 1e-6, "m",
                 "kinks over the position are resolved by the steps' tolerance, not located");
}

/// Angle of a flywheel that starts at rest at zero, on its way to 1 rad.
double calc_controlled_angle(const Controller& spring, double t) {
  const double decay = 0.5 * spring.derivative / kFlywheelInertia,
               omega = std::sqrt(spring.proportional / kFlywheelInertia - decay * decay);
  const double swing = std::cos(omega * t) + decay / omega * std::sin(omega * t);
  return 1.0 - std::exp(-decay * t) * swing;
}

Check compare_position_control() {
  const Controller spring{.target = Polynomial{{1.0}},
                          .controlled = Controller::Controlled::kPosition,
                          .proportional = 5.0,
                          .derivative = 0.2};
  const RunResult run = run_flywheel({.name = "q", .actuator = spring}, 1.0);
  const std::vector<double>&t = column(run, "t_s"), &q = column(run, "q_rad");
  double largest = 0.0;
  for (std::size_t k = 0; k < t.size(); ++k)
    largest = std::max(largest, std::abs(q[k] - calc_controlled_angle(spring, t[k])));
  return limit("angle of a flywheel under control of its position",
               "a spring K_p and a damper K_d on the way from the target", largest, 1e-8, "rad",
               kStepTolerance);
}

void add_speed_control(Findings& findings) {
  Controller servo{.target = Polynomial{{0.0, 10.0}}, .proportional = 2.0};
  const auto speed = [&] {
    return column(run_flywheel({.name = "q", .actuator = servo, .load = ForceLaw{Constant{-1.0}}}, 4.0),
                  "q_rad_s")
        .back();
  };
  findings.checks.push_back(compare("speed under control with a load of 1 N m", "w_target - T / K_p", speed(),
                                    9.5, 1e-6, "rad/s", kStepTolerance));
  servo.integral = 20.0;
  findings.checks.push_back(compare("the same with an integral", "w_target", speed(), 10.0, 1e-6, "rad/s",
                                    "exp(-10 t) of the integral's own motion after 4 s, and the steps"));
}

}  // namespace

Findings compute_force_laws() {
  Findings findings;
  add_constant_torque(findings);
  findings.checks.push_back(compare_harmonic_force());
  add_pulses(findings);
  findings.checks.push_back(compare_falling_torque());
  findings.checks.push_back(compare_spring_with_play());
  return findings;
}

Findings compute_controllers() {
  Findings findings;
  findings.checks.push_back(compare_position_control());
  add_speed_control(findings);
  return findings;
}

}  // namespace validation
