// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "engine/model/drive_law.h"
#include "engine/model/rpsup_geometry.h"
#include "charts/chart.h"
#include "validation/kinematics/parts.h"
#include "validation/reference/ideal_linkage.h"
#include "validation/support/differences.h"
#include "validation/support/largest.h"

namespace validation {

namespace {

using std::numbers::pi;

constexpr double kDriveLawDuration = 5.0;  // [s]

/// Instant at which a law's formula changes.
struct Seam {
  double t;     ///< [s]
  double jump;  ///< of the acceleration
};

/// A law of the study's two drives: the engine's and the same written down a second time.
struct Law {
  std::string name;
  const char* unit;
  const char* formula;
  DriveLaw law;
  std::function<Taylor(double)> closed_form;
  std::array<double, 4> largest;     ///< of position, velocity, acceleration and its rate in the run
  std::vector<Seam> seams;
};

constexpr double kStroke = 0.015, kStrokeTime = 0.5, kPause = 0.5;  // of the study's rod, [m] and [s]

/// A law of the rod's strokes and its features: velocity in the middle of the stroke, accelerations at its
/// beginning and in its middle, by stroke and stroke time.
struct Stroke {
  StrokeLaw law;
  const char* name;
  const char* formula;
  double velocity;              ///< in the middle, its largest
  /// its largest, and the part of the stroke's time at which the law first has it
  double acceleration, when;
  double rate;                  ///< largest of the acceleration's
  /// jumps of the acceleration where a rise begins or a return ends, and in the middle of a rise
  double at_ends, in_middle;
};
constexpr Stroke kStrokes[] = {
    {StrokeLaw::kCycloidal, "cycloidal", "C(u) = u - sin(2 pi u) / (2 pi)", 2.0, 2.0 * pi, 0.25, 4.0 * pi* pi,
     0.0, 0.0},
    {StrokeLaw::kCosine, "cosine", "(1 - cos(pi u)) / 2", 0.5 * pi, 0.5 * pi* pi, 0.0, 0.5 * pi* pi* pi,
     0.5 * pi* pi, 0.0},
    {StrokeLaw::kParabolic, "parabolic", "2 u^2, then 1 - 2 (1 - u)^2", 2.0, 4.0, 0.0, 0.0, 4.0, -8.0}};

double per_time(double factor, int order) { return factor * kStroke / std::pow(kStrokeTime, order); }

/// Every half stroke of the run but its start and end: a rise, a return, a pause. At the top the acceleration
/// goes on.
std::vector<Seam> make_seams(const Stroke& stroke) {
  std::vector<Seam> seams;
  for (double cycle = 0.0; cycle < kDriveLawDuration; cycle += 2.0 * kStrokeTime + kPause)
    for (const auto& [halves, jump] : {std::pair{0, stroke.at_ends},
                                       {1, stroke.in_middle},
                                       {2, 0.0},
                                       {3, -stroke.in_middle},
                                       {4, -stroke.at_ends}}) {
      const double t = cycle + 0.5 * halves * kStrokeTime;
      if (t > 0.0 && t < kDriveLawDuration) seams.push_back({t, per_time(jump, 2)});
    }
  return seams;
}

RpsupParameters with_law(StrokeLaw law) {
  RpsupParameters p;
  p.rod_law = law;
  return p;
}

std::vector<Law> make_laws() {
  const RpsupParameters study;
  std::vector<Law> laws{{"crank's drive",
                         "rad",
                         "cycloidal law of the velocity, C(u) = u - sin(2 pi u) / (2 pi)",
                         crank_law(study),
                         [study](double t) { return calc_crank_angle(study, t); },
                         {40.0, 10.0, 10.0, 10.0 * pi},
                         {{2.0, 0.0}}}};
  for (const Stroke& stroke : kStrokes) {
    const RpsupParameters p = with_law(stroke.law);
    laws.push_back(
        {std::string("rod's drive, ") + stroke.name + " law",
         "m",
         stroke.formula,
         rod_law(p),
         [p](double t) { return calc_rod_displacement(p, t); },
         {0.05, per_time(stroke.velocity, 1), per_time(stroke.acceleration, 2), per_time(stroke.rate, 3)},
         make_seams(stroke)});
  }
  return laws;
}

std::array<double, 3> values(const DrivenMotion& motion) { return {motion.q, motion.qd, motion.qdd}; }

std::string unit_of(const Law& law, std::size_t order) {
  const std::array<const char*, 3> per{"", "/s", "/s^2"};
  return std::string(law.unit) + per[order];
}

constexpr std::array<const char*, 3> kOrders{"position", "velocity", "acceleration"};

/// Values against the second writing of the law, all through the run.
void add_values(const Law& law, Findings& findings) {
  std::array<Largest, 3> worst;
  for (int k = 0; k <= 10'000; ++k) {
    const double t = kDriveLawDuration * k / 10'000.0;
    const std::array<double, 3> found = values(calc_driven_motion(law.law, t));
    const Taylor expected = law.closed_form(t);
    for (std::size_t order = 0; order < 3; ++order)
      worst[order].take(found[order] - expected.derivative(order));
  }
  for (std::size_t order = 0; order < 3; ++order)
    findings.checks.push_back(limit(std::string(kOrders[order]) + " of the " + law.name + ", over 5 s",
                                    std::string(law.formula) + ", derivatives by Taylor arithmetic",
                                    worst[order].value(), 2e-14 * law.largest[order], unit_of(law, order),
                                    "rounding of times near 5 s and of sines"));
}

/// Velocity and acceleration against differences of position and velocity, away from the seams.
void add_differences(const Law& law, Findings& findings) {
  constexpr double h = 2e-3;
  std::array<Largest, 2> worst;
  for (double t = 0.0137; t < kDriveLawDuration - 0.01; t += 0.0371) {
    if (std::any_of(law.seams.begin(), law.seams.end(),
                    [t](const Seam& seam) { return std::abs(t - seam.t) < 5.0 * h; }))
      continue;
    const std::array<double, 3> at = values(calc_driven_motion(law.law, t));
    for (std::size_t order = 0; order < 2; ++order) {
      const double slope =
          first_derivative([&](double s) { return values(calc_driven_motion(law.law, t + s))[order]; }, h);
      worst[order].take(at[order + 1] - slope);
    }
  }
  for (std::size_t order = 0; order < 2; ++order) {
    const double rounding = 1e-15 * law.largest[order] / h;
    findings.checks.push_back(
        limit(std::string(kOrders[order + 1]) + " of the " + law.name,
              std::string("central differences of order 8 of its ") + kOrders[order] + " over 2 ms",
              worst[order].value(), 10.0 * rounding, unit_of(law, order + 1),
              "rounding of values and of times near 5 s, over the step; "
              "truncation (2 pi / 0.5 s x 2 ms)^8 / 630 = 3e-16 of the velocity"));
  }
}

/// Where the formula changes, position and velocity go on, and the acceleration goes on or jumps as the law
/// says.
void add_seams(const Law& law, Findings& findings) {
  constexpr double kAside = 1e-9;
  std::array<Largest, 3> worst;
  for (const Seam& seam : law.seams) {
    const std::array<double, 3> before = values(calc_driven_motion(law.law, seam.t - kAside));
    const std::array<double, 3> behind = values(calc_driven_motion(law.law, seam.t + kAside));
    const std::array<double, 3> jump{0.0, 0.0, seam.jump};
    for (std::size_t order = 0; order < 3; ++order)
      worst[order].take(behind[order] - before[order] - jump[order]);
  }
  for (std::size_t order = 0; order < 3; ++order) {
    const bool jumps = order == 2 && std::any_of(law.seams.begin(), law.seams.end(),
                                                 [](const Seam& seam) { return seam.jump != 0.0; });
    findings.checks.push_back(
        limit(std::string(kOrders[order]) + " of the " + law.name + ": jump where its formula changes" +
                  (jumps ? ", less that of the law" : ""),
              jumps ? "second derivatives of the formula" : "none", worst[order].value(),
              1.01 * 2.0 * kAside * law.largest[order + 1] + 1e-15 * law.largest[order], unit_of(law, order),
              "looked at 1 ns before and behind, at its largest slope; rounding"));
  }
}

/// Steps end where the engine says that an acceleration jumps: every jump must be among those instants.
void add_jumps(const Law& law, Findings& findings) {
  std::vector<double> found;
  for (double t = find_next_jump(law.law, 0.0); t < kDriveLawDuration; t = find_next_jump(law.law, t))
    found.push_back(t);
  Largest missed;
  for (const Seam& seam : law.seams) {
    if (seam.jump == 0.0) continue;
    double nearest = kDriveLawDuration;
    for (const double t : found) nearest = std::min(nearest, std::abs(t - seam.t));
    missed.take(nearest);
  }
  if (missed.value() >= 0.0)
    findings.checks.push_back(limit("instants of the jumps of the acceleration of the " + law.name,
                                    "those of the formula", missed.value(), 0.0, "s",
                                    "halves of a stroke are numbers without rounding"));
  else
    findings.checks.push_back(compare("number of jumps of the acceleration of the " + law.name,
                                      "it is continuous", static_cast<double>(found.size()), 0.0, 0.0, "1",
                                      "a count"));
}

constexpr const char* kLaw = "the cycloidal law";
// run-up of 2 s to omega_0; rise, return and pause of 0.5 s each; stroke of 0.015 m
constexpr const char* kFigure = "the paper's Fig. 4";

void add_feature(Findings& findings, const std::string& what, double found, double expected, const char* unit,
                 const char* reference) {
  findings.checks.push_back(compare(what, reference, found, expected,
                                    1e-14 * std::max(1.0, std::abs(expected)), unit, "rounding"));
}

void add_crank_features(Findings& findings) {
  const RunUp crank = crank_law({});
  const std::string of = " of the crank, omega_0 = 10 rad/s";
  add_feature(findings, "velocity at the start" + of, calc_driven_motion(crank, 0.0).qd, 0.0, "rad/s", kLaw);
  add_feature(findings, "velocity after 1 s, half the run-up," + of, calc_driven_motion(crank, 1.0).qd, 5.0,
              "rad/s", kLaw);
  add_feature(findings, "acceleration after 1 s, its largest," + of, calc_driven_motion(crank, 1.0).qdd, 10.0,
              "rad/s^2", kLaw);
  add_feature(findings, "velocity after 2 s, the run-up's end," + of, calc_driven_motion(crank, 2.0).qd, 10.0,
              "rad/s", kFigure);
  add_feature(findings, "angle after 3 s, a second at full speed," + of, calc_driven_motion(crank, 3.0).q,
              20.0, "rad", kLaw);
  add_feature(findings, "angle after 3 s" + of + ", which starts at 0.5 rad",
              calc_driven_motion(RunUp{10.0, 2.0, 0.5}, 3.0).q, 20.5, "rad", kLaw);
  add_feature(findings, "velocity at the start, without run-up," + of,
              calc_driven_motion(RunUp{10.0, 0.0}, 0.0).qd, 10.0, "rad/s", kLaw);
  add_feature(findings, "angle after 0.5 s, without run-up," + of,
              calc_driven_motion(RunUp{10.0, 0.0}, 0.5).q, 5.0, "rad", kLaw);
}

void add_rod_features(const Stroke& stroke, Findings& findings) {
  const RiseReturnPause law = rod_law(with_law(stroke.law));
  const auto rod = [&law](double t) { return calc_driven_motion(law, t); };
  const std::string of = std::string(" of the rod, ") + stroke.name + " law";
  const char* figure = stroke.law == RpsupParameters{}.rod_law ? kFigure : stroke.formula;
  const double rest = -0.05;  // the S joint is 0.15 m from the crank's axis, the rod 0.2 m long
  const double fastest = per_time(stroke.velocity, 1);
  add_feature(findings, "position at the start" + of, rod(0.0).q, rest, "m",
              "0.15 m from the crank's axis to the S joint, less the rod's 0.2 m");
  add_feature(findings, "velocity at the start" + of, rod(0.0).qd, 0.0, "m/s", stroke.formula);
  add_feature(findings, "acceleration at the start" + of, rod(0.0).qdd, per_time(stroke.at_ends, 2), "m/s^2",
              stroke.formula);
  add_feature(findings, "position at half the rise" + of, rod(0.25).q, rest + 0.0075, "m", stroke.formula);
  add_feature(findings, "velocity at half the rise, its largest," + of, rod(0.25).qd, fastest, "m/s",
              stroke.formula);
  add_feature(findings, "largest acceleration" + of, rod(stroke.when * kStrokeTime).qdd,
              per_time(stroke.acceleration, 2), "m/s^2", stroke.formula);
  add_feature(findings, "rise in 0.5 s" + of, rod(0.5).q - rod(0.0).q, 0.015, "m", figure);
  add_feature(findings, "position at half the return" + of, rod(0.75).q, rest + 0.0075, "m", stroke.formula);
  add_feature(findings, "velocity at half the return" + of, rod(0.75).qd, -fastest, "m/s", stroke.formula);
  add_feature(findings, "velocity at half the second cycle's rise, at 1.75 s," + of, rod(1.75).qd, fastest,
              "m/s", stroke.formula);
  Largest pause;
  for (double t = 1.0; t < 1.5; t += 0.01)
    for (const double value : {rod(t).q - rod(0.0).q, rod(t).qd, rod(t).qdd}) pause.take(value);
  add_feature(findings,
              "largest magnitude of displacement, velocity and acceleration in the pause of 0.5 s" + of,
              pause.value(), 0.0, "m, m/s, m/s^2", figure);
}

/// Instants of the charts.
std::vector<double> list_drawn_times() {
  std::vector<double> times;
  for (int k = 0; k <= 500; ++k) times.push_back(kDriveLawDuration * k / 500.0);
  return times;
}

charts::Chart draw_crank_velocity() {
  const RunUp crank = crank_law({});
  charts::Series velocity{.label = "", .x = list_drawn_times(), .y = {}};
  for (const double t : velocity.x) velocity.y.push_back(calc_driven_motion(crank, t).qd);
  return {.title = "Drive of the crank",
          .x_label = "t [s]",
          .y_label = "velocity [rad/s]",
          .series = {std::move(velocity)}};
}

charts::Chart draw_rod_displacement() {
  const RiseReturnPause rod = rod_law({});
  charts::Series displacement{.label = "", .x = list_drawn_times(), .y = {}};
  for (const double t : displacement.x) displacement.y.push_back(calc_driven_motion(rod, t).q - rod.start);
  return {.title = "Drive of the rod",
          .x_label = "t [s]",
          .y_label = "displacement from its rest [m]",
          .series = {std::move(displacement)}};
}

/// The paper's figure of the drives.
Figure draw_laws() {
  return {"drive_laws.svg",
          "The drives as in the paper's Fig. 4: the crank at 10 rad/s, the rod by its cosine law.",
          charts::draw({draw_crank_velocity(), draw_rod_displacement()}, 2)};
}

}  // namespace

Findings compute_drive_laws() {
  Findings findings;
  add_crank_features(findings);
  for (const Stroke& stroke : kStrokes) add_rod_features(stroke, findings);
  for (const Law& law : make_laws()) {
    add_values(law, findings);
    add_differences(law, findings);
    add_seams(law, findings);
    add_jumps(law, findings);
  }
  findings.figures.push_back(draw_laws());
  return findings;
}

}  // namespace validation
