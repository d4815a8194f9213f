// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "charts/chart.h"
#include "validation/friction/parts.h"
#include "validation/friction/published_law.h"
#include "validation/support/largest.h"
#include "validation/support/random.h"

namespace validation {

namespace {

struct LawCase {
  std::string name;
  FrictionParameters law;
};

std::vector<LawCase> law_cases() {
  return {{"values of the article", published_law()},
          {"defaults", {}},
          {"defaults with sigma_2 = 0.3 s/m", {.sigma_2 = 0.3}}};
}

double stribeck(const FrictionParameters& p, double v) {
  return p.mu_k + (p.mu_s - p.mu_k) * std::exp(-(v / p.v_s) * (v / p.v_s));
}

/// From rest to `duration` at a constant velocity. @returns force against the motion; the force across it
/// goes to `across`
double slide(const FrictionParameters& law, double v, double duration, double& across) {
  const auto rates = [&](const OdeState& z, OdeState& d, double) {
    const BristleForce f = calc_on_line(law, v, z[0], z[1]);
    d = {f.bristle_rate[0], f.bristle_rate[1]};
  };
  auto stepper = make_fehlberg(1e-18, 1e-13);
  OdeState z(2);
  double t = 0.0;
  double dt = 1e-3 * duration;
  advance(stepper, rates, z, t, duration, dt);
  const Eigen::Vector2d force = calc_on_line(law, v, z[0], z[1]).force_ratio;
  across = kLine.x() * force.y() - kLine.y() * force.x();
  return kLine.dot(force);
}

constexpr std::array<double, 7> kSpeeds{1e-4, 3e-4, 1e-3, 2e-3, 5e-3, 0.05, 0.5};

/// Bristles bend, then slip: F(t) = g (1 - e) + sigma_1 v e + sigma_2 v with e = exp(-t / tau), tau = g /
/// (sigma_0 v).
Check compare_transient(const LawCase& c) {
  Largest worst;
  for (const double v : kSpeeds) {
    const double g = stribeck(c.law, v);
    for (const double parts : {0.1, 1.0, 3.0}) {
      const double e = std::exp(-parts);
      const double expected = g * (1.0 - e) + c.law.sigma_1 * v * e + c.law.sigma_2 * v;
      double across = 0.0;
      const double found = slide(c.law, v, parts * g / (c.law.sigma_0 * v), across);
      worst.take((found - expected) / expected);
      worst.take(across / expected);
    }
  }
  return limit("force after 0.1, 1 and 3 time constants of sliding at 0.1 mm/s to 0.5 m/s, " + c.name,
               "closed form: g (1 - e) + sigma_1 v e + sigma_2 v, e = exp(-t sigma_0 v / g), and none across "
               "the motion",
               worst.value(), 1e-11, "1", "tolerance of the integration, 1e-13, over its steps");
}

Check compare_steady(const LawCase& c) {
  Largest worst;
  for (const double v : kSpeeds) {
    const double g = stribeck(c.law, v);
    double across = 0.0;
    const double found = slide(c.law, v, 40.0 * g / (c.law.sigma_0 * v), across);
    worst.take((found - g - c.law.sigma_2 * v) / g);
  }
  return limit("steady force when sliding at 0.1 mm/s to 0.5 m/s, " + c.name,
               "Stribeck's curve: mu_k + (mu_s - mu_k) exp(-(v / v_s)^2) + sigma_2 v", worst.value(), 1e-11,
               "1", "after 40 time constants 4e-18 is missing; tolerance of the integration");
}

/// Both vectors turned, the force has turned with them.
Check compare_turned() {
  Random random(41);
  Largest worst;
  for (int k = 0; k < 200; ++k) {
    const FrictionParameters law{};
    const Eigen::Vector2d v(random.symmetric(3e-3), random.symmetric(3e-3));
    const Eigen::Vector2d z(random.symmetric(2e-3), random.symmetric(2e-3));
    const Eigen::Rotation2Dd turn(random.symmetric(3.14));
    const BristleForce straight = calc_bristle_force(law, v, z);
    const BristleForce turned = calc_bristle_force(law, turn * v, turn * z);
    worst.take((turned.force_ratio - turn * straight.force_ratio).norm() / 0.2);
    worst.take((turned.bristle_rate - turn * straight.bristle_rate).norm() / 3e-3);
  }
  return limit("force and bristle rate for 200 random velocities and bristles, both turned by the same angle",
               "the law knows no direction", worst.value(), 2e-15, "1", "rounding of products near 1");
}

/// A bristle at rest is a spring, however its direction.
Check compare_at_rest() {
  Random random(42);
  Largest worst;
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector2d z(random.symmetric(2e-3), random.symmetric(2e-3));
    const BristleForce f = calc_bristle_force({}, {0.0, 0.0}, z);
    worst.take((f.force_ratio - 100.0 * z).norm());
    worst.take(f.bristle_rate.norm());
  }
  return limit("a bristle that does not slide: force and rate", "sigma_0 z and 0", worst.value(), 0.0, "1",
               "one product");
}

charts::Series make_stribeck_curve(const FrictionParameters& law) {
  charts::Series curve{.label = "Stribeck's curve", .colour = charts::kGrey};
  for (int k = 0; k <= 200; ++k) {
    curve.x.push_back(1e-5 * std::pow(10.0, 0.025 * k));
    curve.y.push_back(stribeck(law, curve.x.back()) + law.sigma_2 * curve.x.back());
  }
  return curve;
}

charts::Series make_steady_dots(const FrictionParameters& law) {
  charts::Series dots{
      .label = "after 40 time constants", .colour = charts::kOrange, .markers = true, .width = 0.0};
  for (const double v : kSpeeds) {
    double across = 0.0;
    dots.x.push_back(v);
    dots.y.push_back(slide(law, v, 40.0 * stribeck(law, v) / (law.sigma_0 * v), across));
  }
  return dots;
}

Figure draw_stribeck() {
  std::vector<charts::Chart> charts;
  for (const LawCase& c : {law_cases()[0], law_cases()[1]})
    charts.push_back({.title = c.name,
                      .x_label = "velocity [m/s]",
                      .y_label = "force per normal force",
                      .x_scale = charts::Scale::kLog,
                      .y_min = 0.95 * std::min(c.law.mu_s, c.law.mu_k),
                      .y_max = 1.2 * std::max(c.law.mu_s, c.law.mu_k),
                      .series = {make_stribeck_curve(c.law), make_steady_dots(c.law)}});
  return {"friction_stribeck.svg",
          "Steady sliding. With the defaults (mu_s < mu_k, as printed in the paper) friction grows with the "
          "velocity.",
          charts::draw(charts, 2)};
}

}  // namespace

Findings compute_sliding() {
  Findings findings;
  for (const LawCase& c : law_cases()) {
    findings.checks.push_back(compare_transient(c));
    findings.checks.push_back(compare_steady(c));
  }
  findings.checks.push_back(compare_turned());
  findings.checks.push_back(compare_at_rest());
  findings.figures.push_back(draw_stribeck());
  return findings;
}

}  // namespace validation
