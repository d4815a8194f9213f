// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/precision/summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ostream>
#include <sstream>

#include "charts/chart.h"
#include "tests/bench/support/table.h"

namespace bench {

namespace {

using engine::Coupler;
using charts::Chart;
using charts::Series;

constexpr double kFailed = std::numeric_limits<double>::infinity();

/// One setting over all cases of a coupler.
struct Group {
  const Setting* setting = nullptr;
  double cpu_seconds = 0.0;    ///< sums
  double simulated = 0.0;      ///< [s]
  double evaluations = 0.0;
  std::array<double, 2> worst{-1.0, -1.0};  ///< by CaseKind; < 0: no such case, infinite: a run failed

  [[nodiscard]] double ms_per_second() const { return 1e3 * cpu_seconds / simulated; }
  [[nodiscard]] double worst_of_all() const { return std::max(worst[0], worst[1]); }
};

std::vector<Group> group(const std::vector<Measurement>& measurements, Coupler coupler) {
  std::vector<Group> groups;
  for (const Measurement& m : measurements) {
    if (m.what->parameters.coupler != coupler) continue;
    auto found =
        std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.setting == m.setting; });
    if (found == groups.end()) found = groups.insert(groups.end(), Group{.setting = m.setting});
    found->cpu_seconds += m.cpu_seconds;
    found->simulated += m.setting->options.duration;
    found->evaluations += m.evaluations;
    double& worst = found->worst[m.what->kind == CaseKind::kFresh];
    worst = std::max(worst, std::isnan(m.error) ? kFailed : m.error);
  }
  return groups;
}

std::string error_text(double error) {
  if (error < 0.0) return "";
  return std::isinf(error) ? "a run fails" : digits(100.0 * error, 2);
}

const char* name_of(Coupler coupler) { return coupler == Coupler::kRigid ? "rigid" : "flexible"; }

charts::Chart draw_chart(const std::vector<Measurement>& measurements, Coupler coupler) {
  const std::array colours{charts::kOrange, charts::kBlue, charts::kGreen, charts::kPurple};
  charts::Chart chart{.title = std::string(name_of(coupler)) + " coupler",
                      .x_label = "CPU ms per simulated second",
                      .y_label = "worst relative error of the peak",
                      .x_scale = charts::Scale::kLog,
                      .y_scale = charts::Scale::kLog};
  for (const Group& g : group(measurements, coupler)) {
    if (chart.series.empty() || chart.series.back().label != g.setting->integrator)
      chart.series.push_back(charts::Series{.label = g.setting->integrator,
                                            .colour = colours.at(chart.series.size() % colours.size()),
                                            .markers = true});
    chart.series.back().x.push_back(g.ms_per_second());
    chart.series.back().y.push_back(g.worst_of_all());
  }
  return chart;
}

bool has(const std::vector<Measurement>& measurements, Coupler coupler) {
  return std::any_of(measurements.begin(), measurements.end(),
                     [=](const Measurement& m) { return m.what->parameters.coupler == coupler; });
}

}  // namespace

std::string write_csv(const std::vector<Measurement>& measurements) {
  std::ostringstream csv;
  csv.precision(10);
  csv << "case,kind,integrator,tolerance_or_step_s,cpu_s,rhs_evaluations,peak_m_s2,relative_error\n";
  for (const Measurement& m : measurements)
    csv << m.what->name << ',' << (m.what->kind == CaseKind::kFresh ? "fresh" : "known") << ','
        << m.setting->integrator << ',' << m.setting->value << ',' << m.cpu_seconds << ',' << m.evaluations
        << ',' << m.peak << ',' << m.error << '\n';
  return csv.str();
}

void print_summary(std::ostream& out, const std::vector<Measurement>& measurements) {
  Table table({"coupler", "integrator", "tolerance or step [s]", "CPU [ms/s]", "evaluations per ms",
               "worst error, known [%]", "fresh [%]"});
  for (const Coupler coupler : {Coupler::kRigid, Coupler::kFlexible})
    for (const Group& g : group(measurements, coupler))
      table.add({name_of(coupler), g.setting->integrator, digits(g.setting->value, 3),
                 digits(g.ms_per_second(), 3), digits(1e-3 * g.evaluations / g.simulated, 3),
                 error_text(g.worst[0]), error_text(g.worst[1])});
  table.print(out);
}

std::string draw_figure(const std::vector<Measurement>& measurements) {
  std::vector<charts::Chart> charts;
  for (const Coupler coupler : {Coupler::kRigid, Coupler::kFlexible})
    if (has(measurements, coupler)) charts.push_back(draw_chart(measurements, coupler));
  return charts::draw(charts, 2);
}

}  // namespace bench
