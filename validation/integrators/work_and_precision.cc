// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "charts/chart.h"
#include "validation/integrators/parts.h"
#include "validation/support/across_rpsup.h"
#include "validation/support/runs.h"
#include "validation/support/text.h"

namespace validation {

namespace {

struct Point {
  std::string setting;
  double peak;         ///< [m/s²]
  double time;         ///< of it, [s]
  double evaluations;
};

Point measure_point(const RpsupParameters& parameters, RunOptions options) {
  options.duration = 4.0;
  options.output_rate = 10.0;
  const RunResult run = run_rpsup(parameters, options);
  const std::string setting = options.integrator == Integrator::kRk4 ? number(1e6 * options.step) + " us"
                                                                     : number(options.relative_tolerance);
  return {setting, metric(run, "peak_slider_acceleration_m_s2"),
          metric(run, "peak_slider_acceleration_time_s"), metric(run, "rhs_evaluations")};
}

RunOptions with_tolerance(double relative) {
  return {.integrator = Integrator::kDopri5,
          .relative_tolerance = relative,
          .absolute_tolerance = 0.1 * relative};
}

/// Every setting of one case against its tight reference.
class Comparison {
 public:
  Comparison(std::string name, const RpsupParameters& parameters, double reference_tolerance)
      : name_(std::move(name)),
        parameters_(parameters),
        reference_(measure_point(parameters, with_tolerance(reference_tolerance))) {}

  void run_dopri5(const std::vector<double>& tolerances) {
    for (const double tolerance : tolerances)
      dopri5_.push_back(measure_point(parameters_, with_tolerance(tolerance)));
  }
  void run_implicit(const std::vector<double>& tolerances) {
    for (const auto& [integrator, points] :
         {std::pair{Integrator::kRadau5, &radau5_}, {Integrator::kRodas5, &rodas5_}})
      for (const double tolerance : tolerances)
        points->push_back(measure_point(
            parameters_,
            {.integrator = integrator, .relative_tolerance = tolerance, .absolute_tolerance = tolerance}));
  }
  void run_rk4(const std::vector<double>& steps) {
    for (const double step : steps)
      rk4_.push_back(measure_point(parameters_, {.integrator = Integrator::kRk4, .step = step}));
  }

  [[nodiscard]] const Point& reference() const { return reference_; }
  [[nodiscard]] double relative_error(const Point& point) const {
    return std::abs(point.peak - reference_.peak) / reference_.peak;
  }
  [[nodiscard]] const Point& dopri5(const std::string& setting) const { return find(dopri5_, setting); }
  [[nodiscard]] const Point& radau5(const std::string& setting) const { return find(radau5_, setting); }
  [[nodiscard]] const Point& rodas5(const std::string& setting) const { return find(rodas5_, setting); }
  [[nodiscard]] const Point& rk4(const std::string& setting) const { return find(rk4_, setting); }

  [[nodiscard]] charts::Chart draw_chart() const {
    charts::Chart chart{.title = name_,
                        .x_label = "evaluations of the equations of motion",
                        .y_label = "relative error of the peak",
                        .x_scale = charts::Scale::kLog,
                        .y_scale = charts::Scale::kLog};
    chart.series.push_back(make_series("dopri5", dopri5_, charts::kOrange));
    chart.series.push_back(make_series("radau5", radau5_, charts::kRed));
    chart.series.push_back(make_series("rodas5", rodas5_, charts::kGreen));
    chart.series.push_back(make_series("rk4", rk4_, charts::kBlue));
    return chart;
  }

  void add_rows(Table& table) const {
    for (const auto& [method, points] : {std::pair{"radau5, tolerance ", &radau5_},
                                         {"rodas5, tolerance ", &rodas5_},
                                         {"dopri5, tolerance ", &dopri5_},
                                         {"rk4, step ", &rk4_}})
      for (const Point& point : *points) {
        const double error = relative_error(point);
        table.rows.push_back({name_, method + point.setting, number(1e-3 * point.evaluations, 4),
                              number(point.peak, 6), error < kResolved ? "< 1e-5" : number(error, 1)});
      }
  }

 private:
  static constexpr double kResolved = 1e-5;  // below, which step falls on which impact decides

  static const Point& find(const std::vector<Point>& points, const std::string& setting) {
    for (const Point& point : points)
      if (point.setting == setting) return point;
    throw std::out_of_range(setting);
  }

  [[nodiscard]] charts::Series make_series(const char* label, const std::vector<Point>& points,
                                           const char* colour) const {
    charts::Series series{.label = label, .colour = colour, .markers = true};
    for (const Point& point : points) {
      series.x.push_back(point.evaluations);
      series.y.push_back(relative_error(point));
    }
    return series;
  }

  std::string name_;
  RpsupParameters parameters_;
  Point reference_;
  std::vector<Point> dopri5_, radau5_, rodas5_, rk4_;
};

}  // namespace

Findings compute_work_and_precision() {
  Comparison fast("second geometry, rigid, 0.25 mm, 10 rad/s", across_rpsup(), 1e-10);
  fast.run_dopri5({1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9});
  fast.run_implicit({1e-3, 1e-4, 7.5e-6, 1e-6, 1e-7});
  fast.run_rk4({2e-5, 1e-5, 5e-6, 2.5e-6});
  RpsupParameters parameters = across_rpsup();
  parameters.crank_velocity = 5.0;
  Comparison slow("second geometry, rigid, 0.25 mm, 5 rad/s", parameters, 1e-9);
  slow.run_dopri5({1e-4, 1e-5, 1e-6, 1e-7});
  slow.run_implicit({1e-4, 7.5e-6, 1e-6});
  slow.run_rk4({2e-5, 1e-5});

  const std::string what =
      "second geometry, rigid, 0.25 mm, 10 rad/s, 4 s: peak acceleration of the slider by ";
  const double peak = fast.reference().peak;
  const char* tight = "dopri5 at a tolerance of 1e-10";
  Findings findings;
  findings.checks.push_back(compare(what + "rk4 in steps of 2.5 us", tight, fast.rk4("2.5 us").peak, peak,
                                    1e-5 * peak, "m/s²", "twice its error at 5 us, 4e-6"));
  findings.checks.push_back(
      compare("second geometry, rigid, 0.25 mm, 10 rad/s, 4 s: time of the peak by rk4 in steps of 2.5 us",
              tight, fast.rk4("2.5 us").time, fast.reference().time, 1e-7, "s", "a twentieth of the step"));
  findings.checks.push_back(compare(what + "dopri5 at a tolerance of 1e-6", tight, fast.dopri5("1e-06").peak,
                                    peak, 1e-5 * peak, "m/s²",
                                    "ten times the tolerance: four seconds of impacts add up and magnify"));
  findings.checks.push_back(compare(what + "dopri5 at a tolerance of 1e-6", "rk4 in steps of 5 us",
                                    fast.dopri5("1e-06").peak, fast.rk4("5 us").peak, 5e-5 * peak, "m/s²",
                                    "mostly that of rk4, which comes upon an onset within a step"));
  findings.checks.push_back(
      compare("second geometry, rigid, 0.25 mm, 5 rad/s, 4 s: peak acceleration of the slider by dopri5 at a "
              "tolerance of 1e-6",
              "dopri5 at a tolerance of 1e-9", slow.dopri5("1e-06").peak, slow.reference().peak,
              1e-5 * slow.reference().peak, "m/s²", "ten times the tolerance"));
  findings.checks.push_back(compare(what + "the default, radau5 at 7.5e-6", tight,
                                    fast.radau5("7.5e-06").peak, peak, 1e-3 * peak, "m/s²",
                                    "a thousandth: what the default tolerance is chosen for"));
  findings.checks.push_back(compare(what + "rodas5 at that tolerance", tight, fast.rodas5("7.5e-06").peak,
                                    peak, 1e-3 * peak, "m/s²", "a thousandth"));
  findings.checks.push_back(
      compare("second geometry, rigid, 0.25 mm, 5 rad/s, 4 s: peak acceleration of the slider by the "
              "default, radau5 at 7.5e-6",
              "dopri5 at a tolerance of 1e-9", slow.radau5("7.5e-06").peak, slow.reference().peak,
              1e-3 * slow.reference().peak, "m/s²", "a thousandth"));
  const double rk4_cost = fast.rk4("10 us").evaluations / fast.dopri5("1e-06").evaluations;
  const double decade_cost = std::cbrt(fast.dopri5("1e-09").evaluations / fast.dopri5("1e-06").evaluations);
  Table table{.caption =
                  "Cost and error of the peak acceleration in 4 s, against dopri5 at a tolerance of 1e-10 "
                  "(10 rad/s) and 1e-9 (5 rad/s). "
                  "Absolute tolerances: of dopri5 a tenth of the relative one, in the state's units; of the "
                  "others the same number, in m and m/s. At 10 rad/s rk4 in steps of 10 us takes " +
                  number(rk4_cost, 2) + " times the evaluations of dopri5 at a tolerance of 1e-6 and is " +
                  number(fast.relative_error(fast.rk4("10 us")), 1) +
                  " off; a decade of tolerance below 1e-6 costs a factor of " + number(decade_cost, 2) +
                  " on average.",
              .head = {"case", "integrator", "thousand evaluations", "peak [m/s²]", "relative error"},
              .reproducible_to = 0.5,
              .keys = 2};
  fast.add_rows(table);
  slow.add_rows(table);
  findings.tables.push_back(std::move(table));
  findings.figures.push_back({"integrators_work_precision.svg", "Error of the peak over the work it took.",
                              charts::draw({fast.draw_chart(), slow.draw_chart()}, 2)});
  return findings;
}

}  // namespace validation
