// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "charts/chart.h"
#include "validation/friction/parts.h"
#include "validation/friction/published_law.h"
#include "validation/support/text.h"

namespace validation {

namespace {

/// @param y  velocity of the mass and bristle
double calc_friction(const OdeState& y) {
  return kLine.dot(calc_on_line(published_law(), y[0], y[1], y[2]).force_ratio);
}

/// Extreme of the parabola through three equally spaced values.
double parabola_top(double a, double b, double c) {
  const double slope = 0.5 * (c - a);
  return b - 0.5 * slope * slope / (a - 2.0 * b + c);
}

/// The largest friction force before it falls for the first time: the mass breaks away.
double find_break_away(double rate) {
  const auto rates = [rate](const OdeState& y, OdeState& d, double t) {
    const BristleForce f = calc_on_line(published_law(), y[0], y[1], y[2]);
    d = {rate * t - kLine.dot(f.force_ratio), f.bristle_rate[0], f.bristle_rate[1]};
  };
  constexpr double kSpacing = 1e-5;  // [s]
  auto stepper = make_fehlberg(1e-17, 1e-13);
  OdeState y(3);
  double t = 0.0;
  double dt = 1e-6;
  std::array<double, 3> last{};
  for (int k = 1; last[2] >= last[1]; ++k) {
    advance(stepper, rates, y, t, k * kSpacing, dt);
    last = {last[1], last[2], calc_friction(y)};
  }
  return parabola_top(last[0], last[1], last[2]);
}

struct ReferencePoint {
  double rate;   ///< of the force, [N/s]
  double force;  ///< [N]
};
constexpr std::array<ReferencePoint, 4> kPoints{
    {{1.0, 1.432415027}, {5.0, 1.313208596}, {10.0, 1.219951806}, {30.0, 1.024484811}}};

charts::Chart make_break_away_chart() {
  charts::Chart chart{.title = "break-away force",
                      .x_label = "force rate [N/s]",
                      .y_label = "[N]",
                      .y_min = 0.9,
                      .y_max = 1.5};
  charts::Series curve{.markers = true};
  for (const double rate : {0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 25.0, 30.0}) {
    curve.x.push_back(rate);
    curve.y.push_back(find_break_away(rate));
  }
  chart.series.push_back(std::move(curve));
  return chart;
}

}  // namespace

Findings compute_break_away() {
  Findings findings;
  for (const ReferencePoint& point : kPoints)
    findings.checks.push_back(
        compare("break-away force, the force on 1 kg at rest growing by " + number(point.rate) + " N/s",
                "largest friction before it first falls, by a program of its own: the law for one direction, "
                "80-bit numbers, Fehlberg 7(8) at 1e-15",
                find_break_away(point.rate), point.force, 1e-9, "N",
                "the reference is known to nine decimals; tolerance of the integration, 1e-13"));
  findings.figures.push_back({"friction_break_away.svg",
                              "The faster the force grows, the less of it the friction withstands: its "
                              "largest value before the mass slides.",
                              charts::draw({make_break_away_chart()}, 1)});
  return findings;
}

}  // namespace validation
