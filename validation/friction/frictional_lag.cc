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

constexpr int kLoopSamples = 400;

/// One for each of kLoops.
std::vector<Loop> trace_loops() {
  std::vector<Loop> loops;
  for (const ReferenceLoop& loop : kLoops)
    loops.push_back(trace_loop({1.3e-3, 1.2e-3, loop.omega}, kLoopSamples));
  return loops;
}

/// Friction forces at the mean velocity.
double rising_force(const Loop& loop) { return loop.force[kLoopSamples / 4]; }
double falling_force(const Loop& loop) { return loop.force[3 * kLoopSamples / 4]; }

Check compare_area(const Loop& loop, const ReferenceLoop& reference) {
  return compare("frictional lag, velocity 1.3 - 1.2 cos(w t) mm/s, w = " + number(reference.omega) +
                     " rad/s: area of the loop",
                 "a program of its own for this experiment: the law for one direction, "
                 "80-bit numbers, Fehlberg 7(8) at 1e-15",
                 loop.area, reference.area, 1e-9 * reference.area, "N m/s",
                 "a hundred times the tolerance of the integration, 1e-11");
}

Check compare_widths(const std::vector<Loop>& loops) {
  double last_width = 0.0;
  double narrower = 0.0;
  for (const Loop& loop : loops) {
    const double width = rising_force(loop) - falling_force(loop);
    narrower = std::max(narrower, last_width - width);
    last_width = width;
  }
  return limit(
      "frictional lag: how much a loop is narrower at 1.3 mm/s than that of the next lower frequency",
      "published: friction is larger for rising than for falling velocity, and the loop wider at "
      "higher frequency",
      std::max(narrower, 0.0), 0.0, "N", "an ordering");
}

Check compare_small_loop(double omega) {
  const double expected = std::numbers::pi * 1e-12 * calc_lag(1e-3, omega);
  return compare(
      "frictional lag, velocity 1 mm/s +- 1 um/s, w = " + number(omega) + " rad/s: area of the loop",
      "closed form: pi amplitude^2 Im H(i w) of the law made linear", trace_loop({1e-3, 1e-6, omega}, 4).area,
      expected, 1e-5 * expected, "N m/s", "quadratic in the amplitude: 1e-6 times a factor of a few");
}

Table tabulate_loops(const std::vector<Loop>& loops) {
  Table table{.caption = "Loops of the friction force over a velocity that swings between 0.1 and 2.5 mm/s.",
              .head = {"frequency [rad/s]", "integral of F dv [N m/s]", "force at 1.3 mm/s, rising [N]",
                       "force at 1.3 mm/s, falling [N]"}};
  for (std::size_t i = 0; i < loops.size(); ++i)
    table.rows.push_back({number(kLoops[i].omega), number(loops[i].area, 6),
                          number(rising_force(loops[i]), 5), number(falling_force(loops[i]), 5)});
  return table;
}

charts::Chart make_loop_chart(const std::vector<Loop>& loops) {
  charts::Chart chart{
      .title = "friction force over velocity", .x_label = "velocity [mm/s]", .y_label = "[N]"};
  const std::array<const char*, 3> colours{charts::kBlue, charts::kOrange, charts::kGreen};
  for (std::size_t i = 0; i < loops.size(); ++i) {
    charts::Series series{.label = number(kLoops[i].omega) + " rad/s",
                          .x = loops[i].v,
                          .y = loops[i].force,
                          .colour = colours[i]};
    for (double& v : series.x) v *= 1e3;
    chart.series.push_back(std::move(series));
  }
  return chart;
}

}  // namespace

Findings compute_frictional_lag() {
  const std::vector<Loop> loops = trace_loops();
  Findings findings;
  for (std::size_t i = 0; i < loops.size(); ++i)
    findings.checks.push_back(compare_area(loops[i], kLoops[i]));
  findings.checks.push_back(compare_widths(loops));
  for (const double omega : {1.0, 10.0, 25.0}) findings.checks.push_back(compare_small_loop(omega));
  findings.tables.push_back(tabulate_loops(loops));
  findings.figures.push_back({"friction_lag.svg",
                              "Friction lags behind the velocity: it is larger on the way up, the more so "
                              "the faster the velocity swings.",
                              charts::draw({make_loop_chart(loops)}, 1)});
  return findings;
}

}  // namespace validation
