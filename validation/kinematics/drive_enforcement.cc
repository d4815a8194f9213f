// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "validation/kinematics/parts.h"
#include "validation/support/across_rpsup.h"
#include "validation/support/largest.h"
#include "validation/support/runs.h"
#include "validation/support/text.h"

namespace validation {

namespace {

constexpr double kEnforcementDuration = 0.5;  // [s]

struct Tables {
  Table differences, peaks;
};

/// The same run with drives prescribed and with drives by multipliers.
struct Pair {
  RunResult prescribed, baumgarte;

  [[nodiscard]] double slider_difference() const {
    const std::vector<double>& a = column(prescribed, "slider_position_m");
    const std::vector<double>& b = column(baumgarte, "slider_position_m");
    Largest worst;
    for (std::size_t k = 0; k < a.size(); ++k) worst.take(a[k] - b[k]);
    return worst.value();
  }
  [[nodiscard]] static double peak(const RunResult& run) {
    return metric(run, "peak_slider_acceleration_whole_run_m_s2");
  }
  void add_rows(const std::string& name, Tables& tables) const {
    const auto count = [](const RunResult& run) { return number(metric(run, "impact_count")); };
    tables.differences.rows.push_back({name, number(slider_difference(), 2)});
    tables.peaks.rows.push_back(
        {name, number(peak(prescribed), 9), number(peak(baumgarte), 9), count(prescribed), count(baumgarte)});
  }
};

Pair run_pair(RpsupParameters p, const RunOptions& options) {
  p.drive = DriveEnforcement::kPrescribed;
  RunResult prescribed = run_rpsup(p, options);
  p.drive = DriveEnforcement::kBaumgarte;
  return {std::move(prescribed), run_rpsup(p, options)};
}

RunOptions at_tolerance(double tolerance) {
  return {.duration = kEnforcementDuration, .integrator = Integrator::kDopri5,
          .relative_tolerance = tolerance, .absolute_tolerance = 0.1 * tolerance, .step_limit = 500'000};
}

/// The prescribed motion of an ideal joint is solved, not integrated: the difference is all the
/// integration's.
void add_ideal(Findings& findings, Tables& tables) {
  RpsupParameters p;
  p.c_r = 0.0;
  p.run_up = 0.25;
  const std::string of = ", ideal joint, rigid coupler, 10 rad/s after 0.25 s, 0.5 s";
  const std::string reference = "drives prescribed";
  std::array<double, 3> differences{};
  std::array<double, 3> steps{1e-3, 5e-4, 2.5e-4};
  RpsupParameters smooth = p;
  smooth.rod_law = StrokeLaw::kCycloidal;
  const RunResult smooth_solved = run_rpsup(smooth, {.duration = kEnforcementDuration});
  smooth.drive = DriveEnforcement::kBaumgarte;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const Pair pair{smooth_solved, run_rpsup(smooth, {.duration = kEnforcementDuration,
                                                      .integrator = Integrator::kRk4,
                                                      .step = steps[k]})};
    differences[k] = pair.slider_difference();
    pair.add_rows("ideal joint, rod by the cycloidal law, rk4 with steps of " + number(steps[k]) + " s",
                  tables);
  }
  const RunResult solved = run_rpsup(p, {.duration = kEnforcementDuration});
  p.drive = DriveEnforcement::kBaumgarte;
  for (std::size_t k = 0; k + 1 < steps.size(); ++k)
    findings.checks.push_back(
        compare("slider with drives by multipliers less the exact one: order in the step from " +
                    number(steps[k]) + " s to half of it, rk4, rod by the cycloidal law" + of,
                "order of rk4", std::log2(differences[k] / differences[k + 1]), 4.0, 0.15, "1",
                "higher orders of h beta = 0.1 count some per cent, a tenth of an order"));
  for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
    const Pair pair{solved, run_rpsup(p, at_tolerance(tolerance))};
    findings.checks.push_back(
        limit("slider with drives by multipliers, dopri5 with relative tolerance " + number(tolerance) + of,
              reference, pair.slider_difference(), std::min(tolerance, 1e-9), "m",
              "the tolerance; at loose ones the longest step of 1 ms decides, with a drift below 1e-9 m"));
    findings.checks.push_back(
        compare("peak acceleration with drives by multipliers, dopri5 with relative tolerance " +
                    number(tolerance) + of,
                reference, Pair::peak(pair.baumgarte), Pair::peak(pair.prescribed),
                1e-7 * Pair::peak(pair.prescribed), "m/s^2",
                "1e-7 of it: the quadratic in steps of up to 1 ms that reads the peak"));
    pair.add_rows("ideal joint, dopri5, " + number(tolerance), tables);
  }
}

/// Of the second geometry. In the study's, contacts of single rings just occur or just do not, so that any
/// two runs part within 0.1 s by some 1e-9 m, whatever the tolerance and with prescribed drives too: the
/// number of impacts differs by one or two.
void add_clearance(Findings& findings, Tables& tables) {
  const RpsupParameters p = across_rpsup();
  const std::string of = ", second geometry, clearance of 0.25 mm, rigid coupler, 10 rad/s, 0.5 s";
  const std::string reference = "drives prescribed, same tolerance";
  std::vector<double> differences;
  for (const double tolerance : {1e-5, 1e-6, 1e-7, 1e-8}) {
    const Pair pair = run_pair(p, at_tolerance(tolerance));
    differences.push_back(pair.slider_difference());
    const double peak = Pair::peak(pair.prescribed);
    const std::string at = ", dopri5 with relative tolerance " + number(tolerance) + of;
    findings.checks.push_back(limit(
        "slider with drives by multipliers" + at, reference, differences.back(), 0.01 * tolerance, "m",
        "a hundredth of the tolerance: it allows each step an error of its size, of coordinates near 1"));
    findings.checks.push_back(compare(
        "peak acceleration with drives by multipliers" + at, reference, Pair::peak(pair.baumgarte), peak,
        100.0 * tolerance * peak, "m/s^2",
        "100 times the tolerance: positions differ by a thousandth of it, and penetrations are of 1e-5 m"));
    pair.add_rows("second geometry, clearance 0.25 mm, dopri5, " + number(tolerance), tables);
  }
  findings.checks.push_back(
      compare("digits by which the sliders' difference falls from tolerance 1e-5 to 1e-7" + of,
              "the tolerance's two digits", std::log10(differences[0] / differences[2]), 2.0, 0.7, "1",
              "errors of both runs, each of its own sign and size: a factor of five"));
}

}  // namespace

Findings compute_drive_enforcement() {
  Findings findings;
  const std::string tolerances = "; tolerances are relative ones, absolute ones a tenth of them.";
  Tables tables{
      {.caption = "Drives by multipliers against prescribed ones over 0.5 s: largest difference of the "
                  "slider's position" +
                  tolerances,
       .head = {"run", "difference [m]"},
       .rows = {},
       .reproducible_to = 10.0},
      {.caption =
           "Drives by multipliers against prescribed ones over 0.5 s: peak slider acceleration and impacts" +
           tolerances,
       .head = {"run", "peak, prescribed [m/s^2]", "peak, by multipliers [m/s^2]", "impacts, prescribed",
                "impacts, by multipliers"},
       .rows = {}}};
  add_ideal(findings, tables);
  add_clearance(findings, tables);
  findings.tables = {std::move(tables.differences), std::move(tables.peaks)};
  return findings;
}

}  // namespace validation
