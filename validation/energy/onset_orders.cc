// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include "validation/energy/parts.h"
#include "validation/support/quiet_observer.h"
#include "validation/support/simple_mechanisms.h"

namespace validation {

namespace {

constexpr double kOnsetSpeed = 0.3;     // [m/s]
constexpr double kOnsetGap = 0.25e-3;   // [m]

class LastBalance : public QuietObserver {
 public:
  void on_step(const Evaluation& /*start*/, const Evaluation& end) override {
    balance = end.energy.calc_balance();
  }
  double balance = 0.0;
};

/// 1 kg that meets the bore, or with its face the bearing's shoulder.
Mechanism make_mass(Axis direction) {
  Mechanism mass = make_free_mass(
      1.0, {.c_r = kOnsetGap, .K = 4.7e10, .K_a = 1e8, .chi = 0.0, .friction = {}, .worn = {}});
  mass.coordinates[0].axis = direction;
  if (direction == Axis::kZ) mass.cut_joints[0].clearance->c_a = kOnsetGap;
  return mass;
}

/// Root mean square of the energy's error after one impact, the onset falling on 40 places of a step.
double measure_error(const Mechanism& mass, double step) {
  constexpr int kPlaces = 40;
  double sum = 0.0;
  for (int place = 0; place < kPlaces; ++place) {
    LastBalance last;
    run_from(mass,
             {.duration = kOnsetGap / kOnsetSpeed + 6e-4,
              .output_rate = 1.0,
              .integrator = Integrator::kRk4,
              .step = step},
             Eigen::VectorXd::Constant(1, -kOnsetSpeed * step * place / kPlaces),
             Eigen::VectorXd::Constant(1, kOnsetSpeed), last);
    sum += std::pow(last.balance - 0.5 * kOnsetSpeed * kOnsetSpeed, 2) / kPlaces;
  }
  return std::sqrt(sum);
}

double find_exponent(const Mechanism& mass) {
  return std::log(measure_error(mass, 2e-5) / measure_error(mass, 1.25e-6)) / std::log(16.0);
}

}  // namespace

Findings compute_onset_orders() {
  const std::string what =
      ", elastic, rk4 in steps of 20 to 1.25 us: exponent of the energy's error over the step";
  const char* reference = "force times displacement within the step of the onset: ";
  Findings findings;
  findings.checks.push_back(
      compare("1 kg against the bore at 0.3 m/s" + what, std::string(reference) + "h^1.5 h",
              find_exponent(make_mass(Axis::kX)), 2.5, 0.25, "1",
              "the order 4 of the rest of the contact, still seen at the longest step"));
  findings.checks.push_back(compare("1 kg against a shoulder at 0.3 m/s" + what,
                                    std::string(reference) + "h h", find_exponent(make_mass(Axis::kZ)), 2.0,
                                    0.1, "1",
                                    "a factor of 1.3 at an end: the places of an onset in a step are 40"));
  return findings;
}

}  // namespace validation
