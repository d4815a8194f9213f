// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "validation/kinematics/parts.h"
#include "validation/support/largest.h"
#include "validation/support/runs.h"
#include "validation/support/text.h"

namespace validation {

namespace {

using std::numbers::pi;

constexpr double kTurn = 0.5;                // [s] of a turn of the crank
constexpr double kSliderCrankOmega = 2.0 * pi / kTurn;  // [rad/s], constant from the start

/// A slider-crank with the crank about z and the slider along x at (y = e, z): seen along z it is a planar
/// one whose rod is as long as the coupler's projection, L = sqrt(l^2 - z^2), for the coupler keeps its slope
/// against the crank's plane. About which axis the yoke turns makes no difference to the slider; about the
/// guide it can turn where z is not 0.
struct SliderCrank {
  const char* name;
  double r, l, e, z;
  YokeAxis yoke;

  [[nodiscard]] double rod() const { return std::sqrt(l * l - z * z); }
  /// The rod's projection on the slider's direction.
  [[nodiscard]] double reach(double angle) const {
    return std::sqrt(rod() * rod() - std::pow(r * std::sin(angle) - e, 2));
  }
  [[nodiscard]] double position(double angle) const { return r * std::cos(angle) + reach(angle); }
  [[nodiscard]] double velocity(double angle) const {
    return -r * kSliderCrankOmega *
           (std::sin(angle) + (r * std::sin(angle) - e) * std::cos(angle) / reach(angle));
  }
  [[nodiscard]] double acceleration(double angle) const {
    const double side = r * std::sin(angle) - e;
    const double w = reach(angle);
    return -r * kSliderCrankOmega * kSliderCrankOmega *
           (std::cos(angle) + (r * std::pow(std::cos(angle), 2) - side * std::sin(angle)) / w +
            r * std::pow(side * std::cos(angle), 2) / (w * w * w));
  }
  /// Crank and rod in line, seen along z.
  [[nodiscard]] double outer_dead_centre() const { return std::sqrt(std::pow(rod() + r, 2) - e * e); }
  [[nodiscard]] double inner_dead_centre() const { return std::sqrt(std::pow(rod() - r, 2) - e * e); }
};

RpsupParameters parameters_of(const SliderCrank& c) {
  RpsupParameters p;
  p.c_r = 0.0;
  p.rod_length = p.rod_start = c.r;
  p.yoke_axis = c.yoke;
  p.coupler_length = c.l;
  p.guide_offset_y = c.e;
  p.guide_offset_z = c.z;
  p.rod_stroke = 0.0;
  p.run_up = 0.0;
  p.crank_velocity = kSliderCrankOmega;
  return p;
}

struct Compared {
  const char* key;
  const char* name;
  const char* unit;
  double bound;
  const char* why;
  std::function<double(double)> expected;  ///< of the crank's angle
};

void add_motion(const SliderCrank& c, const RunResult& run, Findings& findings,
                std::vector<std::string>& row) {
  const std::vector<Compared> compared{
      {"slider_position_m", "displacement", "m", 1e-12, "Newton's method closes the loop to 1e-13 m",
       [&](double a) { return c.position(a); }},
      {"slider_velocity_m_s", "velocity", "m/s", 1e-11, "1e-13 m at rates of up to 50 1/s",
       [&](double a) { return c.velocity(a); }},
      {"slider_acceleration_m_s2", "acceleration", "m/s^2", 1e-9,
       "1e-13 m at squared rates of up to 2,500 1/s^2", [&](double a) { return c.acceleration(a); }}};
  const std::vector<double>& t = column(run, "t_s");
  for (const Compared& quantity : compared) {
    const std::vector<double>& found = column(run, quantity.key);
    Largest worst;
    for (std::size_t k = 0; k < t.size(); ++k)
      worst.take(found[k] - quantity.expected(kSliderCrankOmega * t[k]));
    findings.checks.push_back(limit(std::string(quantity.name) + " of the slider over a turn, " + c.name,
                                    "closed form of the slider-crank at constant speed", worst.value(),
                                    quantity.bound, quantity.unit, quantity.why));
    row.push_back(number(worst.value(), 2));
  }
}

void add_stroke(const SliderCrank& c, const RunResult& run, Findings& findings, Table& strokes) {
  const std::vector<double>& z = column(run, "slider_position_m");
  const auto [least, most] = std::minmax_element(z.begin(), z.end());
  const double stroke = c.outer_dead_centre() - c.inner_dead_centre();
  findings.checks.push_back(
      compare(std::string("stroke of the slider, ") + c.name,
              "sqrt((L + r)^2 - e^2) - sqrt((L - r)^2 - e^2), L^2 = l^2 - z^2", *most - *least, stroke, 1e-8,
              "m", "samples 25 us apart miss a dead centre by a t^2 / 2 = 45 m/s^2 (12.5 us)^2 / 2 each"));
  strokes.rows.push_back({c.name, number(*most - *least, 9), number(stroke, 9)});
}

/// The textbook's slider-crank: its dead centres lie at 0 and half a turn.
void add_planar(const SliderCrank& c, const RunResult& run, Findings& findings) {
  const std::vector<double>& z = column(run, "slider_position_m");
  const std::vector<double>& a = column(run, "slider_acceleration_m_s2");
  const std::size_t half = (z.size() - 1) / 2;
  const double rw2 = c.r * kSliderCrankOmega * kSliderCrankOmega;
  const auto add = [&](const std::string& what, const char* formula, double found, double expected,
                       const char* unit, double bound) {
    findings.checks.push_back(compare(what + ", " + c.name, formula, found, expected, bound, unit,
                                      "Newton's method closes the loop to 1e-13 m"));
  };
  add("acceleration at the outer dead centre", "-r omega^2 (1 + r / l)", a.front(), -rw2 * (1.0 + c.r / c.l),
      "m/s^2", 1e-9);
  add("acceleration at the inner dead centre", "r omega^2 (1 - r / l)", a[half], rw2 * (1.0 - c.r / c.l),
      "m/s^2", 1e-9);
  add("stroke, from the two dead centres' samples,", "2 r", z.front() - z[half], 2.0 * c.r, "m", 1e-12);
}

}  // namespace

Findings compute_slider_crank() {
  Findings findings;
  Table table{.caption =
                  "With the rod locked the linkage is a slider-crank: one turn at 4 pi rad/s, 20,001 "
                  "samples, largest differences.",
              .head = {"case", "displacement [m]", "velocity [m/s]", "acceleration [m/s^2]"},
              .rows = {},
              .reproducible_to = 10.0};
  Table strokes{.caption = "Stroke of the slider with the rod locked.",
                .head = {"case", "run [m]", "closed form [m]"},
                .rows = {}};
  const SliderCrank planar{"planar in-line: r = 0.2 m, l = 0.5 m", 0.2, 0.5, 0.0, 0.0, YokeAxis::kAcross};
  for (const SliderCrank& c :
       {planar,
        SliderCrank{"planar offset: r = 0.15 m, l = 0.5 m, e = 0.1 m", 0.15, 0.5, 0.1, 0.0,
                    YokeAxis::kAcross},
        SliderCrank{"spatial: r = 0.2 m, l = 0.5 m, z = 0.2 m, yoke about the guide", 0.2, 0.5, 0.0, 0.2,
                    YokeAxis::kGuide},
        SliderCrank{"spatial: r = 0.2 m, l = 0.5 m, z = 0.2 m, yoke across the guide", 0.2, 0.5, 0.0, 0.2,
                    YokeAxis::kAcross},
        SliderCrank{"spatial offset: r = 0.17 m, l = 0.55 m, e = -0.08 m, z = 0.3 m, yoke about the guide",
                    0.17, 0.55, -0.08, 0.3, YokeAxis::kGuide}}) {
    const RunResult run = run_rpsup(parameters_of(c), {.duration = kTurn, .output_rate = 40'000.0});
    std::vector<std::string> row{c.name};
    add_motion(c, run, findings, row);
    add_stroke(c, run, findings, strokes);
    if (c.e == 0.0 && c.z == 0.0) add_planar(c, run, findings);
    table.rows.push_back(std::move(row));
  }
  findings.tables = {std::move(table), std::move(strokes)};
  return findings;
}

}  // namespace validation
