// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include "validation/energy/parts.h"
#include "validation/support/quiet_observer.h"
#include "validation/support/simple_mechanisms.h"
#include "validation/support/text.h"

namespace validation {

namespace {

/// The account at the end of a run; a mass that has left the bore again ends it.
class LastAccount : public QuietObserver {
 public:
  explicit LastAccount(double gap) : gap_(gap) {}
  void on_step(const Evaluation& start, const Evaluation& end) override {
    energy = end.energy;
    gone_ = start.q[0] > gap_ && end.q[0] <= gap_;
  }
  [[nodiscard]] bool stop_requested(double /*t*/) override { return gone_; }
  EnergyAccount energy;

 private:
  double gap_;
  bool gone_ = false;
};

/// The rebound e of the law f = f_e (1 + c rate / onset rate): c (1 + e) = ln((1 + c) / (1 - c e)), whatever
/// f_e.
double calc_rebound(double c) {
  double low = 0.0;
  double high = 1.0;
  for (int k = 0; k < 60; ++k) {
    const double e = 0.5 * (low + high);
    (c * (1.0 + e) - std::log((1.0 + c) / (1.0 - c * e)) > 0.0 ? low : high) = e;
  }
  return 0.5 * (low + high);
}

Check compare_impact(double k_r) {
  constexpr double kImpactMass = 1.0, kImpactSpeed = 0.3, kImpactGap = 0.25e-3;
  const double chi = 0.75 * (1.0 - k_r * k_r);
  const Mechanism mass =
      make_free_mass(kImpactMass, {.c_r = kImpactGap, .K = 4.7e10, .chi = chi, .friction = {}, .worn = {}});
  LastAccount last(kImpactGap);
  run_from(mass, {.duration = 2e-3, .output_rate = 1.0, .integrator = Integrator::kDopri5,
                  .relative_tolerance = 1e-9, .absolute_tolerance = 1e-10}, Eigen::VectorXd::Zero(1),
           Eigen::VectorXd::Constant(1, kImpactSpeed), last);
  const double e = calc_rebound(chi);
  const double expected = 0.5 * kImpactMass * kImpactSpeed * kImpactSpeed * (1.0 - e * e);
  return compare("impact loss of 1 kg that meets the bore at 0.3 m/s, k_r = " + number(k_r),
                 "closed form: m v^2 (1 - e^2) / 2, chi (1 + e) = ln((1 + chi) / (1 - chi e))",
                 last.energy.impact_loss, expected, 5e-9, "J",
                 "tolerance of the integration, 1e-9 of 0.045 J, over some hundred steps");
}

/// F v integrated: F(t) = g (1 - e) + sigma_1 v e + sigma_2 v with e = exp(-t / tau), tau = g / (sigma_0 v).
Check compare_friction(double v) {
  const FrictionParameters law{.sigma_2 = 0.3};
  const double g = law.mu_k + (law.mu_s - law.mu_k) * std::exp(-(v / law.v_s) * (v / law.v_s));
  const double tau = g / (law.sigma_0 * v);
  const double duration = 3.0 * tau;
  Mechanism slider = make_slider(law, v, 0.0);
  slider.coordinates.erase(slider.coordinates.begin() + 1);  // no spring: the mass stands on the carriage
  slider.coordinates[1].parent = 0;
  slider.cut_joints[0].journal_frame = 1;
  LastAccount last(1e9);
  run_from(slider, {.duration = duration, .output_rate = 1.0, .integrator = Integrator::kDopri5,
                    .relative_tolerance = 1e-10, .absolute_tolerance = 1e-13},
           Eigen::Vector2d(0.0, resting_height(slider)), Eigen::Vector2d(v, 0.0), last);
  const double passed = 1.0 - std::exp(-3.0);
  const double expected =
      v * (g * (duration - tau * passed) + law.sigma_1 * v * tau * passed + law.sigma_2 * v * duration);
  return compare(
      "friction loss of a journal pulled along its axis at " + number(v) +
          " m/s under 1 N, for three of the bristle's time constants",
      "closed form: integral of F v, F = g (1 - e) + sigma_1 v e + sigma_2 v, e = exp(-t sigma_0 v / g)",
      last.energy.friction_loss, expected, 1e-9 * expected, "J", "tolerance of the integration, 1e-10");
}

}  // namespace

Findings compute_closed_form_losses() {
  Findings findings;
  for (const double k_r : {0.9, 0.5}) findings.checks.push_back(compare_impact(k_r));
  for (const double v : {5e-4, 0.02}) findings.checks.push_back(compare_friction(v));
  return findings;
}

}  // namespace validation
