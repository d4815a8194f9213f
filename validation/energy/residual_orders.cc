// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "engine/dynamics/loop_closure.h"
#include "engine/model/rpsup.h"
#include "charts/chart.h"
#include "validation/energy/parts.h"
#include "validation/support/across_rpsup.h"
#include "validation/support/equal_steps.h"
#include "validation/support/largest.h"
#include "validation/support/runs.h"
#include "validation/support/text.h"

namespace validation {

namespace {

constexpr double kContactDuration = 0.3;  // [s]; the journal falls, bounces and comes to lie in the bore
constexpr double kIdealDuration = 1.0;    // [s]

/// Residuals over steps, and their slope in logarithms.
struct Line {
  std::vector<std::string> settings;
  std::vector<double> steps, residuals;

  void add(const std::string& setting, double step, double residual) {
    settings.push_back(setting);
    steps.push_back(step);
    residuals.push_back(residual);
  }

  /// By least squares.
  [[nodiscard]] double slope() const {
    double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const double x = std::log(steps[k]);
      const double y = std::log(residuals[k]);
      sx += x;
      sy += y;
      sxx += x * x;
      sxy += x * y;
    }
    const auto n = static_cast<double>(steps.size());
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
  }
};

void add_run(Line& line, const std::string& setting, const RpsupParameters& parameters,
             const RunOptions& options) {
  const RunResult run = run_rpsup(parameters, options);
  line.add(setting, options.duration / metric(run, "steps"), metric(run, "energy_residual"));
}

Line run_rk4(const RpsupParameters& parameters, double duration, const std::vector<double>& steps) {
  Line line;
  for (const double step : steps)
    add_run(line, "rk4, " + number(1e6 * step, 4) + " us", parameters,
            {.duration = duration, .output_rate = 10.0, .integrator = Integrator::kRk4, .step = step});
  return line;
}

Line run_dopri5(const RpsupParameters& parameters, double duration, const std::vector<double>& tolerances) {
  Line line;
  for (const double tolerance : tolerances)
    add_run(line, "dopri5, tolerance " + number(tolerance), parameters,
            {.duration = duration, .output_rate = 10.0, .integrator = Integrator::kDopri5,
             .relative_tolerance = tolerance, .absolute_tolerance = 0.1 * tolerance});
  return line;
}

/// The balance's largest drift at seven instants, over the kinetic energy at the last one.
/// @param before  balance at the start, [J]
double find_balance_drift(const Mechanism& mechanism, const Evaluation& assembled, double before,
                          double step) {
  Largest drift;
  double kinetic = 0.0;
  for (int instant = 1; instant <= 7; ++instant) {
    const double duration = 0.2 * instant;
    const auto count = static_cast<int>(std::lround(duration / step));
    const EnergyAccount account = take_equal_steps(mechanism, assembled, duration, count).energy;
    drift.take(account.calc_balance() - before);
    kinetic = account.kinetic;
  }
  return drift.value() / kinetic;
}

Line run_equal_steps(const RpsupParameters& parameters, const std::vector<double>& steps) {
  const Rpsup rpsup = build_rpsup(parameters);
  Evaluation assembled = MotionSystem(rpsup.mechanism).make_evaluation();
  (void)LoopClosure(rpsup.mechanism).assemble(0.0, assembled);
  const double before = take_equal_steps(rpsup.mechanism, assembled, 0.0, 0).energy.calc_balance();
  Line line;
  for (const double step : steps)
    line.add("dopri5, equal steps of " + number(1e6 * step, 4) + " us", step,
             find_balance_drift(rpsup.mechanism, assembled, before, step));
  return line;
}

void add_rows(Table& table, const std::string& name, const Line& line) {
  for (std::size_t k = 0; k < line.steps.size(); ++k)
    table.rows.push_back(
        {name, line.settings[k], number(1e6 * line.steps[k], 4), number(line.residuals[k], 2)});
}

charts::Series make_series(const std::string& label, const Line& line, const char* colour) {
  return {.label = label, .x = line.steps, .y = line.residuals, .colour = colour, .markers = true};
}

struct ResidualLines {
  Line ideal_rk4, ideal_dopri5, contact_rk4, contact_dopri5;
};

ResidualLines find_residuals() {
  RpsupParameters ideal;
  ideal.c_r = 0.0;
  ideal.rod_law = StrokeLaw::kCycloidal;  // equal steps do not end where an acceleration jumps
  return {.ideal_rk4 = run_rk4(ideal, kIdealDuration, {2e-3, 1e-3, 5e-4, 2.5e-4}),
          .ideal_dopri5 = run_equal_steps(ideal, {2e-3, 1e-3, 5e-4}),
          .contact_rk4 = run_rk4(across_rpsup(), kContactDuration, {2e-5, 1e-5, 5e-6, 2.5e-6}),
          .contact_dopri5 =
              run_dopri5(across_rpsup(), kContactDuration, {1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10})};
}

constexpr const char* kMethodsOrder = "the method's order";
constexpr const char* kExponent = "exponent of the energy residual over the ";

void add_ideal_slopes(Findings& findings, const ResidualLines& lines) {
  const char* why = "the next term of the error, one order higher: a part of the longest step, 2 ms";
  const std::string ideal = "ideal rigid linkage, rod by the cycloidal law, ";
  findings.checks.push_back(compare(ideal + "rk4: " + kExponent + "step, 2 to 0.25 ms", kMethodsOrder,
                                    lines.ideal_rk4.slope(), 4.0, 0.15, "1", why));
  findings.checks.push_back(compare(ideal + "dopri5 in equal steps: " + kExponent + "step, 2 to 0.5 ms",
                                    kMethodsOrder, lines.ideal_dopri5.slope(), 5.0, 0.15, "1", why));
}

void add_contact_slopes(Findings& findings, const ResidualLines& lines) {
  const std::string contact = "second geometry, rigid, 0.25 mm, 0.3 s, ";
  findings.checks.push_back(
      compare(contact + "dopri5: " + kExponent + "mean step, tolerance 1e-5 to 1e-10", kMethodsOrder,
              lines.contact_dopri5.slope(), 5.0, 0.5, "1",
              "which step falls on which impact: a factor of two at either end is 0.3"));
  const double rk4_slope = lines.contact_rk4.slope();
  findings.checks.push_back(
      limit(contact + "rk4: how far the " + kExponent + "step, 20 to 2.5 us, lies outside 2 to 2.5",
            "what an onset inside a step leaves", std::max({0.0, 2.0 - rk4_slope, rk4_slope - 2.5}), 0.3, "1",
            "which step falls on which impact: a factor of two at an end is 0.3"));
}

Table tabulate_residuals(const ResidualLines& lines) {
  Table table{.caption =
                  "Energy residual over the step. Ideal joint, rod by the cycloidal law: 1 s (equal steps: "
                  "1.4 s); with clearance: the "
                  "second geometry's first 0.3 s, in which the journal falls and bounces.",
              .head = {"case", "integrator", "mean step [us]", "residual"},
              .reproducible_to = 0.3,
              .keys = 3};
  add_rows(table, "ideal, rigid", lines.ideal_rk4);
  add_rows(table, "ideal, rigid", lines.ideal_dopri5);
  add_rows(table, "second geometry, rigid, 0.25 mm", lines.contact_rk4);
  add_rows(table, "second geometry, rigid, 0.25 mm", lines.contact_dopri5);
  return table;
}

charts::Chart make_residual_chart(const ResidualLines& lines) {
  charts::Chart chart{.title = "energy residual",
                      .x_label = "step, or mean step [s]",
                      .y_label = "",
                      .x_scale = charts::Scale::kLog,
                      .y_scale = charts::Scale::kLog,
                      .y_min = 2e-13,
                      .y_max = 1e-1};
  chart.series = {make_series("rk4, with clearance", lines.contact_rk4, charts::kBlue),
                  make_series("dopri5, with clearance", lines.contact_dopri5, charts::kOrange),
                  make_series("rk4, ideal joint", lines.ideal_rk4, charts::kPurple),
                  make_series("dopri5 in equal steps, ideal joint", lines.ideal_dopri5, charts::kGreen)};
  return chart;
}

}  // namespace

Findings compute_residual_orders() {
  const ResidualLines lines = find_residuals();
  Findings findings;
  add_ideal_slopes(findings, lines);
  add_contact_slopes(findings, lines);
  findings.tables.push_back(tabulate_residuals(lines));
  findings.figures.push_back({"energy_residual.svg",
                              "The energy account closes as the steps become smaller (ideal joint: rod by "
                              "the cycloidal law; with clearance: the "
                              "second geometry).",
                              charts::draw({make_residual_chart(lines)}, 1)});
  return findings;
}

}  // namespace validation
