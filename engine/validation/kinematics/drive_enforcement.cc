#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "engine/validation/kinematics/parts.h"
#include "engine/validation/support/runs.h"
#include "engine/validation/support/text.h"

namespace engine::validation {

namespace {

constexpr double kDuration = 0.5;  // [s]

/// The same run with drives prescribed and with drives by multipliers.
struct Pair {
  RunResult prescribed, baumgarte;

  [[nodiscard]] double slider_difference() const {
    const std::vector<double>& a = column(prescribed, "slider_position_m");
    const std::vector<double>& b = column(baumgarte, "slider_position_m");
    double worst = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      const double difference = std::abs(a[k] - b[k]);
      worst = difference <= worst ? worst : difference;
    }
    return worst;
  }
  [[nodiscard]] static double peak(const RunResult& run) { return metric(run, "peak_slider_acceleration_whole_run_m_s2"); }
  [[nodiscard]] std::vector<std::string> row(const std::string& name) const {
    const auto count = [](const RunResult& run) { return number(metric(run, "impact_count")); };
    return {name, number(slider_difference(), 2), number(peak(prescribed), 9), number(peak(baumgarte), 9),
            count(prescribed) + ", " + count(baumgarte)};
  }
};

Pair run_pair(RpsupParameters p, const RunOptions& options) {
  p.drive = DriveEnforcement::kPrescribed;
  RunResult prescribed = run_rpsup(p, options);
  p.drive = DriveEnforcement::kBaumgarte;
  return {std::move(prescribed), run_rpsup(p, options)};
}

RunOptions with_tolerance(double tolerance) {
  return {.duration = kDuration, .relative_tolerance = tolerance, .absolute_tolerance = 0.1 * tolerance, .step_limit = 500'000};
}

/// The prescribed motion of an ideal joint is solved, not integrated: the difference is all the integration's.
void add_ideal(Findings& findings, Table& table) {
  RpsupParameters p;
  p.c_r = 0.0;
  p.run_up = 0.25;
  const std::string of = ", ideal joint, rigid coupler, 10 rad/s after 0.25 s, 0.5 s";
  const std::string reference = "drives prescribed";
  std::array<double, 3> differences{};
  std::array<double, 3> steps{1e-3, 5e-4, 2.5e-4};
  const RunResult solved = run_rpsup(p, {.duration = kDuration});
  p.drive = DriveEnforcement::kBaumgarte;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const Pair pair{solved, run_rpsup(p, {.duration = kDuration, .integrator = Integrator::kRk4, .step = steps[k]})};
    differences[k] = pair.slider_difference();
    table.rows.push_back(pair.row("ideal joint, rk4 with steps of " + number(steps[k]) + " s"));
  }
  for (std::size_t k = 0; k + 1 < steps.size(); ++k)
    findings.checks.push_back(compare("slider with drives by multipliers less the exact one: order in the step from " +
                                          number(steps[k]) + " s to half of it, rk4" + of,
                                      "order of rk4", std::log2(differences[k] / differences[k + 1]), 4.0, 0.15, "1",
                                      "higher orders of h beta = 0.1 count some per cent, a tenth of an order"));
  for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
    const Pair pair{solved, run_rpsup(p, with_tolerance(tolerance))};
    findings.checks.push_back(limit("slider with drives by multipliers, dopri5 with relative tolerance " + number(tolerance) + of, reference,
                                    pair.slider_difference(), std::min(tolerance, 1e-9), "m",
                                    "the tolerance; at loose ones the longest step of 1 ms decides, with a drift below 1e-9 m"));
    findings.checks.push_back(compare("peak acceleration with drives by multipliers, dopri5 with relative tolerance " + number(tolerance) + of,
                                      reference, Pair::peak(pair.baumgarte), Pair::peak(pair.prescribed), 1e-7 * Pair::peak(pair.prescribed), "m/s^2",
                                      "1e-7 of it: the quadratic in steps of up to 1 ms that reads the peak"));
    table.rows.push_back(pair.row("ideal joint, dopri5, " + number(tolerance)));
  }
}

void add_clearance(Findings& findings, Table& table) {
  const RpsupParameters p;
  const std::string of = ", clearance of 0.25 mm, rigid coupler, 10 rad/s, 0.5 s";
  const std::string reference = "drives prescribed, same tolerance";
  std::vector<double> differences;
  for (const double tolerance : {1e-5, 1e-6, 1e-7, 1e-8}) {
    const Pair pair = run_pair(p, with_tolerance(tolerance));
    differences.push_back(pair.slider_difference());
    const double peak = Pair::peak(pair.prescribed);
    const std::string at = ", dopri5 with relative tolerance " + number(tolerance) + of;
    findings.checks.push_back(limit("slider with drives by multipliers" + at, reference, differences.back(), tolerance, "m", "the tolerance"));
    findings.checks.push_back(compare("peak acceleration with drives by multipliers" + at, reference, Pair::peak(pair.baumgarte), peak,
                                      100.0 * tolerance * peak, "m/s^2",
                                      "100 times the tolerance: positions are right to a thousandth of it, penetrations of 1e-5 m accordingly"));
    table.rows.push_back(pair.row("clearance 0.25 mm, dopri5, " + number(tolerance)));
  }
  findings.checks.push_back(compare("digits by which the sliders' difference falls from tolerance 1e-5 to 1e-7" + of, "the tolerance's two digits",
                                    std::log10(differences[0] / differences[2]), 2.0, 0.7, "1",
                                    "errors of both runs, each of its own sign and size: a factor of five"));
}

}  // namespace

Findings compute_drive_enforcement() {
  Findings findings;
  Table table{.caption = "Drives by multipliers against prescribed ones over 0.5 s; tolerances are relative ones, absolute ones a tenth of them.",
              .head = {"run", "largest difference of slider position [m]", "peak acceleration, prescribed [m/s^2]", "by multipliers [m/s^2]",
                       "impacts, both"},
              .rows = {}, .reproducible_to = 10.0};
  add_ideal(findings, table);
  add_clearance(findings, table);
  findings.tables.push_back(std::move(table));
  return findings;
}

}  // namespace engine::validation
