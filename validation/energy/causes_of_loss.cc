// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "validation/energy/parts.h"
#include "validation/support/largest.h"
#include "validation/support/runs.h"

namespace validation {

namespace {

constexpr RunOptions kOptions{.duration = 0.06, .output_rate = 1000.0, .integrator = Integrator::kDopri5,
                              .relative_tolerance = 1e-8, .absolute_tolerance = 1e-9};

RpsupParameters flexible() {
  RpsupParameters p;
  p.coupler = Coupler::kFlexible;
  return p;
}

RpsupParameters lossless() {
  RpsupParameters p = flexible();
  p.restitution = 1.0;
  p.friction = FrictionLaw::kNone;
  p.coupler_damping_ratio = 0.0;
  return p;
}

/// The largest change of kinetic and potential energy since the start, over the largest kinetic energy.
double find_drift(const RunResult& run) {
  const auto& kinetic = column(run, "kinetic_energy_j");
  const auto& potential = column(run, "potential_energy_j");
  Largest change, energy;
  for (std::size_t k = 0; k < kinetic.size(); ++k) {
    change.take(kinetic[k] + potential[k] - kinetic[0] - potential[0]);
    energy.take(kinetic[k]);
  }
  return change.value() / energy.value();
}

struct Cause {
  const char* off;
  const char* key;
  const char* name;
  void (*turn_off)(RpsupParameters&);
};

constexpr Cause kCauses[] = {
    {"k_r = 1", "impact_loss_j", "impact loss", [](RpsupParameters& p) { p.restitution = 1.0; }},
    {"no friction", "friction_work_j", "friction loss",
     [](RpsupParameters& p) { p.friction = FrictionLaw::kNone; }},
    {"damping ratio 0", "structural_loss_j", "structural loss",
     [](RpsupParameters& p) { p.coupler_damping_ratio = 0.0; }},
};

constexpr const char* kShortRun = "flexible, 0.25 mm, 10 rad/s, 0.06 s, ";
constexpr const char* kEachStep = "ten times the tolerance, 1e-8: it holds for each of some 10,000 steps";

void add_cause(Findings& findings, const Cause& cause) {
  RpsupParameters parameters = flexible();
  cause.turn_off(parameters);
  const RunResult run = run_rpsup(parameters, kOptions);
  const std::string what = std::string(kShortRun) + cause.off + ": ";
  findings.checks.push_back(compare(what + cause.name, "its cause is off", metric(run, cause.key), 0.0, 0.0,
                                    "J", "no term is left"));
  findings.checks.push_back(
      limit(what + "energy less work plus the other two losses, change over the work turned over", "none",
            metric(run, "energy_residual"), 1e-7, "1", kEachStep));
}

Check compare_without_losses() {
  const RunResult driven = run_rpsup(lossless(), kOptions);
  return limit(std::string(kShortRun) + "all three off: energy less work, change over the work turned over",
               "conserved", metric(driven, "energy_residual"), 1e-7, "1", kEachStep);
}

Check compare_bouncing() {
  RpsupParameters still = lossless();
  still.coupler = Coupler::kRigid;
  still.crank_velocity = 0.0;
  still.rod_stroke = 0.0;
  const RunResult bouncing = run_rpsup(still, {.duration = 0.1,
                                               .output_rate = 1000.0,
                                               .integrator = Integrator::kDopri5,
                                               .relative_tolerance = 1e-10,
                                               .absolute_tolerance = 1e-13});
  return limit(
      "rigid, 0.25 mm, drives at rest, no losses, 0.1 s of bouncing: change of energy over the largest "
      "kinetic energy",
      "conserved", find_drift(bouncing), 1e-8, "1",
      "a hundred times the tolerance, 1e-10: it holds for each of 26,000 steps");
}

}  // namespace

Findings compute_causes_of_loss() {
  Findings findings;
  for (const Cause& cause : kCauses) add_cause(findings, cause);
  findings.checks.push_back(compare_without_losses());
  findings.checks.push_back(compare_bouncing());
  return findings;
}

}  // namespace validation
