// SPDX-License-Identifier: Apache-2.0
// Dry friction in joints without play, under a given normal force.

#include <cmath>
#include <string>
#include <utility>

#include "validation/actuators/mover.h"
#include "validation/actuators/parts.h"
#include "validation/friction/published_law.h"

namespace validation {

namespace {

constexpr double kInclineGravity = 9.81;
constexpr double kInclineAngle = 0.6;  // of the incline, [rad]

LinkageJoint make_slide(const std::string& body, LinkageFreedom freedom) {
  return {.name = body,
          .kind = JointKind::kPrismatic,
          .from = kGroundName,
          .to = body,
          .placement = {},
          .axes = {Axis::kX, Axis::kY},
          .freedoms = {std::move(freedom)}};
}

Linkage make_incline(double angle, const FrictionParameters& law, double velocity) {
  Linkage linkage;
  linkage.gravity_W = kInclineGravity * Eigen::Vector3d(std::sin(angle), -std::cos(angle), 0.0);
  linkage.bodies = {{.name = "block", .mass = kBlockMass}};
  linkage.joints = {make_slide("block", {.name = "q",
                                         .start = 0.0,
                                         .start_rate = velocity,
                                         .friction = JointFriction{law, kBlockMass * kInclineGravity * std::cos(angle)}})};
  return linkage;
}

/// 1 kg under 1 N of normal force, pulled by a spring of 2 N/m whose other end moves at 0.1 m/s.
Linkage make_belt() {
  constexpr double kApart = 10.0;  // [m]: a spring has a direction while its ends are apart
  Linkage linkage;
  linkage.bodies = {{.name = "block", .mass = 1.0}, {.name = "carriage", .mass = 1.0}};
  linkage.joints = {make_slide("block", {.name = "block", .friction = JointFriction{published_law(), 1.0}}),
                    make_slide("carriage", {.name = "carriage", .drive = Polynomial{{kApart, 0.1}}})};
  linkage.springs = {
      {.name = "pull", .from = "block", .to = "carriage", .stiffness = 2.0, .free_length = kApart}};
  return linkage;
}

void add_sliding_down(Findings& findings) {
  FrictionParameters lugre = published_law();
  lugre.mu_s = 0.4;
  lugre.mu_k = 0.3;
  lugre.sigma_1 = lugre.sigma_2 = 0.0;  // a bristle that is not bent at 1 m/s would brake by its damping
  const FrictionParameters coulomb{.mu_k = 0.3, .law = FrictionLaw::kCoulomb, .v_0 = 1e-6};
  const double expected = 1.0 + kInclineGravity * (std::sin(kInclineAngle) - 0.3 * std::cos(kInclineAngle));
  for (const auto& [name, law] : {std::pair{"Coulomb", coulomb}, std::pair{"LuGre", lugre}}) {
    const RunResult run = run_linkage(make_incline(kInclineAngle, law, 1.0), Integrator::kDopri5, 1.0);
    findings.checks.push_back(
        compare(std::string("velocity of a block that slides down an incline from 1 m/s, after 1 s, ") + name,
                "v_0 + g (sin a - mu_k cos a) t", column(run, "q_m_s").back(), expected, 2e-5, "m/s",
                "LuGre's friction is whole only after 3e-6 m; steps of 1e-10"));
  }
}

void add_sticking(Findings& findings) {
  FrictionParameters lugre = published_law();
  lugre.sigma_2 = 0.0;
  lugre.mu_s = 0.5;
  lugre.mu_k = 0.4;
  const RunResult stuck = run_linkage(make_incline(0.3, lugre, 0.0), Integrator::kDopri5, 2.0);
  findings.checks.push_back(limit("velocity of a block on an incline below the angle of friction, after 2 s",
                                  "0", std::abs(column(stuck, "q_m_s").back()), 1e-9, "m/s", kStepTolerance));
  findings.checks.push_back(compare("friction that holds it", "-m g sin a",
                                    column(stuck, "q_friction_n").back(),
                                    -kBlockMass * kInclineGravity * std::sin(0.3), 1e-6, "N", kStepTolerance));
}

Check compare_belt() {
  const RunOptions options{.duration = 25.0,
                           .integrator = Integrator::kDopri5,
                           .relative_tolerance = 1e-10,
                           .absolute_tolerance = 1e-13,
                           .step_limit = 1'000'000};
  const RunResult belt = simulate_linkage(make_belt(), options, 0.0, {});
  return compare(
      "stick-slip of 1 kg in a joint without play under 1 N, spring 2 N/m pulled at 0.1 m/s: position after 25 s",
      "a program of its own for this experiment: the law for one direction, 80-bit numbers, Fehlberg 7(8) at "
      "1e-15",
      column(belt, "block_m").back(), 1.9088391992, 1e-9, "m",
      "the reference is known to ten decimals; dopri5 at a tolerance of 1e-10");
}

}  // namespace

Findings compute_joint_friction() {
  Findings findings;
  add_sliding_down(findings);
  add_sticking(findings);
  findings.checks.push_back(compare_belt());
  return findings;
}

}  // namespace validation
