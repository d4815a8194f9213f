// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include "validation/friction/parts.h"
#include "validation/friction/published_law.h"
#include "validation/support/quiet_observer.h"
#include "validation/support/simple_mechanisms.h"
#include "validation/support/text.h"

namespace validation {

namespace {

constexpr double kBristleMass = 1.0;         // [kg]
constexpr double kBristleSpeed = 0.3;        // across the bore, [m/s]
constexpr double kGap = 0.25e-3;      // [m]
constexpr double kBristleStiffness = 4.7e10; // [N/m^1.5]
constexpr int kContacts = 3;

class LastLoss : public QuietObserver {
 public:
  void on_step(const Evaluation& /*start*/, const Evaluation& end) override {
    loss = end.energy.friction_loss;
  }
  double loss = 0.0;
};

double duration_of_contact() {
  return 0.8 * std::beta(0.4, 0.5) *
         std::pow(5.0 * kBristleMass * kBristleSpeed * kBristleSpeed / (4.0 * kBristleStiffness), 0.4) /
         kBristleSpeed;
}

/// A mass that bounces from side to side of the bore, elastically, while it is drawn along the bearing's
/// axis.
double run_contacts(double sliding) {
  Mechanism m = make_free_mass(
      kBristleMass,
      {.c_r = kGap, .K = kBristleStiffness, .chi = 0.0, .friction = FrictionParameters{}, .worn = {}});
  m.cut_joints[0].clearance->c_a = 10.0;
  m.coordinates.insert(
      m.coordinates.begin(),
      {.name = "carriage", .placement = {}, .motion = Motion::kTranslation, .axis = Axis::kZ});
  m.coordinates[1].parent = 0;
  m.cut_joints[0].journal_frame = 1;
  m.drives = {{0, RunUp{sliding, 0.0}}};
  LastLoss last;
  // half way back from the last one
  const double duration = 2.0 * kContacts * kGap / kBristleSpeed + kContacts * duration_of_contact();
  run_from(m, {.duration = duration, .output_rate = 1.0, .integrator = Integrator::kDopri5,
               .relative_tolerance = 1e-10, .absolute_tolerance = 1e-12}, Eigen::Vector2d::Zero(),
           Eigen::Vector2d(sliding, kBristleSpeed), last);
  return last.loss;
}

/// One contact that begins with an unbent bristle: m d'' = -K d^1.5, z' = v (1 - sigma_0 z / mu_k), loss' = K
/// d^1.5 (sigma_0 z + sigma_1 z') v.
double integrate_contact(double sliding) {
  const auto rates = [sliding](const OdeState& y, OdeState& d, double) {
    const double force = kBristleStiffness * std::pow(std::max(0.0, y[0]), 1.5);
    const double bending = sliding * (1.0 - 100.0 * y[2] / 0.2);
    d = {y[1], -force / kBristleMass, bending, force * (100.0 * y[2] + 5.0 * bending) * sliding};
  };
  auto stepper = make_fehlberg(1e-16, 1e-13);
  OdeState y{0.0, kBristleSpeed, 0.0, 0.0};
  double t = 0.0;
  double dt = 1e-7;
  advance(stepper, rates, y, t, duration_of_contact(), dt);
  return y[3];
}

}  // namespace

Findings compute_fresh_bristles() {
  Findings findings;
  for (const double sliding : {0.05, 1.0}) {
    const double expected = kContacts * integrate_contact(sliding);
    findings.checks.push_back(compare(
        "friction loss of 1 kg that bounces three times between the sides of the bore, drawn along it at " +
            number(sliding) + " m/s",
        "three times one contact that begins with an unbent bristle: its equations written out, Fehlberg "
        "7(8)",
        run_contacts(sliding), expected, 1e-7 * expected, "J",
        "tolerance of the integration, 1e-10, over some thousand steps"));
  }
  return findings;
}

}  // namespace validation
