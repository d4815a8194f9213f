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
#include "engine/validation/chart.h"
#include "engine/validation/kinematics/parts.h"
#include "engine/validation/reference/ideal_linkage.h"
#include "engine/validation/support/differences.h"
#include "engine/validation/support/largest.h"

namespace engine::validation {

namespace {

using std::numbers::pi;

constexpr double kDuration = 5.0;  // [s]

/// One of the study's two drives: the engine's law and the same written down a second time.
struct Law {
  const char* name;
  const char* unit;
  DriveLaw law;
  std::function<Taylor(double)> closed_form;
  std::array<double, 3> largest;     ///< of position, velocity and acceleration in the run
  std::vector<double> seams;         ///< where its formula changes, [s]
};

std::vector<Law> make_laws() {
  const RpsupParameters p;
  return {{"crank", "rad", RunUp{p.crank_velocity, p.run_up}, [p](double t) { return calc_crank_angle(p, t); }, {40.0, 10.0, 10.0}, {2.0}},
          {"rod", "m", RiseReturnPause{p.rod_stroke, p.rod_stroke_time, p.rod_pause}, [p](double t) { return calc_rod_displacement(p, t); },
           {0.05, 0.2, 0.4 * pi}, {0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5}}};
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
    const double t = kDuration * k / 10'000.0;
    const std::array<double, 3> found = values(calc_driven_motion(law.law, t));
    const Taylor expected = law.closed_form(t);
    for (std::size_t order = 0; order < 3; ++order) worst[order].take(found[order] - expected.derivative(order));
  }
  for (std::size_t order = 0; order < 3; ++order)
    findings.checks.push_back(limit(std::string(kOrders[order]) + " of the " + law.name + "'s drive over 5 s",
                                    "cycloidal law C(u) = u - sin(2 pi u) / (2 pi), derivatives by Taylor arithmetic", worst[order].value(),
                                    2e-14 * law.largest[order], unit_of(law, order), "rounding of times near 5 s and of sines"));
}

/// Velocity and acceleration against differences of position and velocity, away from the seams.
void add_differences(const Law& law, Findings& findings) {
  constexpr double h = 2e-3;
  std::array<Largest, 2> worst;
  for (double t = 0.0137; t < kDuration - 0.01; t += 0.0371) {
    if (std::any_of(law.seams.begin(), law.seams.end(), [t](double seam) { return std::abs(t - seam) < 5.0 * h; })) continue;
    const std::array<double, 3> at = values(calc_driven_motion(law.law, t));
    for (std::size_t order = 0; order < 2; ++order) {
      const double slope = first_derivative([&](double s) { return values(calc_driven_motion(law.law, t + s))[order]; }, h);
      worst[order].take(at[order + 1] - slope);
    }
  }
  for (std::size_t order = 0; order < 2; ++order) {
    const double rounding = 1e-15 * law.largest[order] / h;
    findings.checks.push_back(limit(std::string(kOrders[order + 1]) + " of the " + law.name + "'s drive",
                                    std::string("central differences of order 8 of its ") + kOrders[order] + " over 2 ms", worst[order].value(),
                                    10.0 * rounding, unit_of(law, order + 1),
                                    "rounding of values and of times near 5 s, over the step; "
                                    "truncation (2 pi / 0.5 s x 2 ms)^8 / 630 = 3e-16 of the velocity"));
  }
}

/// Position, velocity and acceleration go on without a jump where the formula changes.
void add_continuity(const Law& law, Findings& findings) {
  constexpr double kAside = 1e-9;
  std::array<Largest, 3> worst;
  for (const double seam : law.seams) {
    const std::array<double, 3> before = values(calc_driven_motion(law.law, seam - kAside));
    const std::array<double, 3> after = values(calc_driven_motion(law.law, seam + kAside));
    for (std::size_t order = 0; order < 3; ++order) worst[order].take(after[order] - before[order]);
  }
  const double jerk = 4.0 * pi * pi * 0.05 / 0.125;  // of the rod where its acceleration crosses zero; the crank's is zero at its seam
  const std::array<double, 3> slope{law.largest[1], law.largest[2], jerk};
  for (std::size_t order = 0; order < 3; ++order)
    findings.checks.push_back(limit(std::string(kOrders[order]) + " of the " + law.name + "'s drive: jump where its formula changes", "none",
                                    worst[order].value(), 1.01 * 2.0 * kAside * slope[order], unit_of(law, order),
                                    "looked at 1 ns before and behind, at its largest slope"));
}

constexpr const char* kLaw = "the cycloidal law";
constexpr const char* kFigure = "the paper's Fig. 4";  // run-up of 2 s to omega_0; rise, return and pause of 0.5 s each; stroke of 0.05 m

void add_feature(Findings& findings, const std::string& what, double found, double expected, const char* unit, const char* reference = kLaw) {
  findings.checks.push_back(compare(what, reference, found, expected,
                                    1e-14 * std::max(1.0, std::abs(expected)), unit, "rounding"));
}

void add_features(Findings& findings) {
  const RunUp crank{10.0, 2.0};
  const std::string of_crank = " of the crank, omega_0 = 10 rad/s";
  add_feature(findings, "velocity at the start" + of_crank, calc_driven_motion(crank, 0.0).qd, 0.0, "rad/s");
  add_feature(findings, "velocity after 1 s, half the run-up," + of_crank, calc_driven_motion(crank, 1.0).qd, 5.0, "rad/s");
  add_feature(findings, "acceleration after 1 s, its largest," + of_crank, calc_driven_motion(crank, 1.0).qdd, 10.0, "rad/s^2");
  add_feature(findings, "velocity after 2 s, the run-up's end," + of_crank, calc_driven_motion(crank, 2.0).qd, 10.0, "rad/s", kFigure);
  add_feature(findings, "angle after 3 s, a second at full speed," + of_crank, calc_driven_motion(crank, 3.0).q, 20.0, "rad");
  add_feature(findings, "velocity at the start, without run-up," + of_crank, calc_driven_motion(RunUp{10.0, 0.0}, 0.0).qd, 10.0, "rad/s");
  add_feature(findings, "angle after 0.5 s, without run-up," + of_crank, calc_driven_motion(RunUp{10.0, 0.0}, 0.5).q, 5.0, "rad");

  const auto rod = [](double t) { return calc_driven_motion(RiseReturnPause{0.05, 0.5, 0.5}, t); };
  const std::string of_rod = " of the rod";
  add_feature(findings, "velocity at half the rise, its largest," + of_rod, rod(0.25).qd, 0.2, "m/s");
  add_feature(findings, "acceleration at a quarter of the rise, its largest," + of_rod, rod(0.125).qdd, 0.4 * pi, "m/s^2");
  add_feature(findings, "position after the rise of 0.5 s" + of_rod, rod(0.5).q, 0.05, "m", kFigure);
  add_feature(findings, "position at half the return" + of_rod, rod(0.75).q, 0.025, "m");
  add_feature(findings, "velocity at half the return" + of_rod, rod(0.75).qd, -0.2, "m/s");
  add_feature(findings, "position at half the second cycle's rise, at 1.75 s," + of_rod, rod(1.75).q, 0.025, "m");
  Largest pause;
  for (double t = 1.0; t < 1.5; t += 0.01)
    for (const double value : values(rod(t))) pause.take(value);
  add_feature(findings, "largest magnitude of position, velocity and acceleration in the pause of 0.5 s" + of_rod, pause.value(), 0.0,
              "m, m/s, m/s^2", kFigure);
}

Figure draw_laws(const std::vector<Law>& laws) {
  std::vector<Chart> charts;
  for (const Law& law : laws) {
    const std::size_t order = charts.empty() ? 1 : 0;  // the paper shows the crank's velocity and the rod's position
    Chart chart{.title = std::string("Drive of the ") + law.name, .x_label = "t [s]",
                .y_label = order == 1 ? "velocity [rad/s]" : "displacement [m]"};
    Series series{.label = "", .x = {}, .y = {}};
    for (int k = 0; k <= 500; ++k) {
      series.x.push_back(kDuration * k / 500.0);
      series.y.push_back(values(calc_driven_motion(law.law, series.x.back()))[order]);
    }
    chart.series.push_back(std::move(series));
    charts.push_back(std::move(chart));
  }
  return {"drive_laws.svg", "The drives as in the paper's Fig. 4, at 10 rad/s.", draw(charts, 2)};
}

}  // namespace

Findings compute_drive_laws() {
  Findings findings;
  add_features(findings);
  const std::vector<Law> laws = make_laws();
  for (const Law& law : laws) {
    add_values(law, findings);
    add_differences(law, findings);
    add_continuity(law, findings);
  }
  findings.figures.push_back(draw_laws(laws));
  return findings;
}

}  // namespace engine::validation
