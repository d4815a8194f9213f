// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "charts/chart.h"
#include "validation/friction/parts.h"
#include "validation/friction/published_law.h"
#include "validation/support/text.h"

namespace validation {

namespace {

/// A velocity that swings about a mean.
struct Swing {
  double mean, amplitude;  ///< [m/s]
  double omega;            ///< [rad/s]

  [[nodiscard]] double v(double t) const { return mean - amplitude * std::cos(omega * t); }
  [[nodiscard]] double dv(double t) const { return amplitude * omega * std::sin(omega * t); }
  [[nodiscard]] double period() const { return 2.0 * std::numbers::pi / omega; }
};

struct Loop {
  double area = 0.0;              ///< integral of F dv over the period, [N m/s]
  std::vector<double> v, force;
};

/// One period, after the bristle has settled for two seconds or more.
Loop trace_loop(const Swing& swing, int samples) {
  const auto rates = [&swing](const OdeState& y, OdeState& d, double t) {
    const BristleForce f = calc_on_line(published_law(), swing.v(t), y[0], y[1]);
    d = {f.bristle_rate[0], f.bristle_rate[1], kLine.dot(f.force_ratio) * swing.dv(t)};
  };
  auto stepper = make_fehlberg(1e-16, 1e-11);
  OdeState y(3);  // bristle, and the integral of F dv so far
  double t = 0.0;
  double dt = 1e-5;
  const double settled = std::ceil(2.0 / swing.period()) * swing.period();
  advance(stepper, rates, y, t, settled, dt);
  const double before = y[2];
  Loop loop;
  for (int k = 0; k <= samples; ++k) {
    advance(stepper, rates, y, t, settled + swing.period() * k / samples, dt);
    loop.v.push_back(swing.v(t));
    loop.force.push_back(kLine.dot(calc_on_line(published_law(), swing.v(t), y[0], y[1]).force_ratio));
  }
  loop.area = y[2] - before;
  return loop;
}

/// Imaginary part of dF/dv at a steady speed, from the law made linear there: H(s) = (sigma_0 + sigma_1 s) b
/// / (s + a) + sigma_2 with a = sigma_0 v / g and b = v g' / g.
double calc_lag(double v, double omega) {
  const double fall = std::exp(-v * v / 1e-6);  // (v / v_s)^2, v_s = 1e-3 m/s
  const double g = 1.0 + 0.5 * fall;
  const double g_slope = -2.0 * v / 1e-6 * 0.5 * fall;
  const double a = 1e5 * v / g;
  const double b = v * g_slope / g;
  return b * omega * (std::sqrt(1e5) * a - 1e5) / (a * a + omega * omega);
}

struct ReferenceLoop {
  double omega;  ///< [rad/s]
  double area;   ///< [N m/s]
};
constexpr std::array<ReferenceLoop, 3> kLoops{
    {{1.0, 1.42774168589e-5}, {10.0, 1.04751574971e-4}, {25.0, 1.60199254456e-4}}};

}  // namespace

Findings compute_frictional_lag() {
  Findings findings;
  charts::Chart chart{
      .title = "friction force over velocity", .x_label = "velocity [mm/s]", .y_label = "[N]"};
  Table table{.caption = "Loops of the friction force over a velocity that swings between 0.1 and 2.5 mm/s.",
              .head = {"frequency [rad/s]", "integral of F dv [N m/s]", "force at 1.3 mm/s, rising [N]",
                       "force at 1.3 mm/s, falling [N]"}};
  const std::array<const char*, 3> colours{charts::kBlue, charts::kOrange, charts::kGreen};
  double last_width = 0.0;
  double narrower = 0.0;
  for (std::size_t i = 0; i < kLoops.size(); ++i) {
    constexpr int kSamples = 400;
    Loop loop = trace_loop({1.3e-3, 1.2e-3, kLoops[i].omega}, kSamples);
    const double rising = loop.force[kSamples / 4];
    const double falling = loop.force[3 * kSamples / 4];
    findings.checks.push_back(compare("frictional lag, velocity 1.3 - 1.2 cos(w t) mm/s, w = " +
                                          number(kLoops[i].omega) + " rad/s: area of the loop",
                                      "a program of its own for this experiment: the law for one direction, "
                                      "80-bit numbers, Fehlberg 7(8) at 1e-15",
                                      loop.area, kLoops[i].area, 1e-9 * kLoops[i].area, "N m/s",
                                      "a hundred times the tolerance of the integration, 1e-11"));
    narrower = std::max(narrower, last_width - (rising - falling));
    last_width = rising - falling;
    table.rows.push_back(
        {number(kLoops[i].omega), number(loop.area, 6), number(rising, 5), number(falling, 5)});
    for (double& v : loop.v) v *= 1e3;
    chart.series.push_back({.label = number(kLoops[i].omega) + " rad/s",
                            .x = std::move(loop.v),
                            .y = std::move(loop.force),
                            .colour = colours[i]});
  }
  findings.checks.push_back(
      limit("frictional lag: how much a loop is narrower at 1.3 mm/s than that of the next lower frequency",
            "published: friction is larger for rising than for falling velocity, and the loop wider at "
            "higher frequency",
            std::max(narrower, 0.0), 0.0, "N", "an ordering"));
  for (const double omega : {1.0, 10.0, 25.0}) {
    const double expected = std::numbers::pi * 1e-12 * calc_lag(1e-3, omega);
    findings.checks.push_back(compare(
        "frictional lag, velocity 1 mm/s +- 1 um/s, w = " + number(omega) + " rad/s: area of the loop",
        "closed form: pi amplitude^2 Im H(i w) of the law made linear",
        trace_loop({1e-3, 1e-6, omega}, 4).area, expected, 1e-5 * expected, "N m/s",
        "quadratic in the amplitude: 1e-6 times a factor of a few"));
  }
  findings.tables.push_back(std::move(table));
  findings.figures.push_back({"friction_lag.svg",
                              "Friction lags behind the velocity: it is larger on the way up, the more so "
                              "the faster the velocity swings.",
                              charts::draw({chart}, 1)});
  return findings;
}

}  // namespace validation
