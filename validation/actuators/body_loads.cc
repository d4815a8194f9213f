// SPDX-License-Identifier: Apache-2.0
// Forces and moments on bodies, and a ground that accelerates.

#include <cmath>
#include <string>
#include <utility>

#include "validation/actuators/mover.h"
#include "validation/actuators/parts.h"

namespace validation {

namespace {

constexpr double kLeverArm = 0.4;                             // of the force on the flywheel, [m]
constexpr double kOscillatorOmega = 9.0;                      // [rad/s]
constexpr double kShakerOmega = 5.0, kShakerAmplitude = 4.0;  // [rad/s], [m/s^2]
constexpr double kAccelerationAcross = 2.0;                   // of the shaker, across the slide, [m/s^2]

void add_thrust(Findings& findings) {
  Linkage wheel = make_mover(JointKind::kRevolute, {.name = "q"});
  wheel.loads = {{.name = "thrust",
                  .body = "body",
                  .at = {kLeverArm, 0.0, 0.0},
                  .force = {0.0, 1.0, 0.0},
                  .follows_body = true,
                  .law = Constant{0.5}}};
  for (const auto& [name, integrator] :
       {std::pair{"dopri5", Integrator::kDopri5}, std::pair{"radau5", Integrator::kRadau5}})
    findings.checks.push_back(
        compare(std::string("angle of a flywheel under a tangential force that turns with it, after 2 s, ") +
                    name,
                "F r t^2 / (2 J)", column(run_linkage(wheel, integrator, 2.0), "q_rad").back(),
                0.5 * kLeverArm / kFlywheelInertia * 2.0, 1e-7, "rad", kStepTolerance));
}

Check compare_pull() {
  Linkage wheel = make_mover(JointKind::kRevolute, {.name = "q", .start = 0.3});
  wheel.loads = {{.name = "pull",
                  .body = "body",
                  .at = {kLeverArm, 0.0, 0.0},
                  .force = {1.0, 0.0, 0.0},
                  .law = Constant{2.0}}};
  const RunResult pulled = run_linkage(wheel, Integrator::kDopri5, 1.1);
  const double w = column(pulled, "q_rad_s").back(), q = column(pulled, "q_rad").back();
  return compare("energy of the flywheel under a force of constant direction, after 1.1 s",
                 "F r (cos q - cos q_0)", 0.5 * kFlywheelInertia * w * w,
                 2.0 * kLeverArm * (std::cos(q) - std::cos(0.3)), 1e-8, "J", kStepTolerance);
}

Linkage make_shaken_oscillator() {
  const double stiffness = kBlockMass * kOscillatorOmega * kOscillatorOmega;
  Linkage shaken = make_mover(JointKind::kPrismatic, {.name = "q", .start = 0.0, .stiffness = stiffness});
  shaken.ground_acceleration[2] = Harmonic{.mean = 0.0, .amplitude = kShakerAmplitude, .omega = kShakerOmega};
  shaken.ground_acceleration[1] = Constant{kAccelerationAcross};
  return shaken;
}

/// Displacement against the shaker, from rest.
double calc_shaken_displacement(double t) {
  const double w0 = kOscillatorOmega, w1 = kShakerOmega;
  return -kShakerAmplitude / (w0 * w0 - w1 * w1) * (std::sin(t * w1) - w1 / w0 * std::sin(t * w0));
}

void add_shaker(Findings& findings) {
  const Linkage shaken = make_shaken_oscillator();
  const RunResult shake = run_linkage(shaken, Integrator::kDopri5, 2.0);
  findings.checks.push_back(compare("displacement of an oscillator on a shaker, after 2 s",
                                    "-a (sin(w t) - w / w_0 sin(w_0 t)) / (w_0^2 - w^2)",
                                    column(shake, "q_m").back(), calc_shaken_displacement(2.0), 1e-8, "m",
                                    kStepTolerance));
  findings.checks.push_back(compare("force that its slide bears across", "m a",
                                    column(shake, "joint_force_y_n").back(), kBlockMass * kAccelerationAcross,
                                    1e-8, "N", kStepTolerance));
  findings.checks.push_back(limit("energy residual on the shaker", "0",
                                  metric_of(shaken, shake, "energy_residual"), 1e-8, "1", kStepTolerance));
}

}  // namespace

Findings compute_body_loads() {
  Findings findings;
  add_thrust(findings);
  findings.checks.push_back(compare_pull());
  add_shaker(findings);
  return findings;
}

}  // namespace validation
