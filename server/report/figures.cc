// SPDX-License-Identifier: Apache-2.0
#include "server/report/figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "charts/chart.h"
#include "jobs/requests/axis.h"
#include "jobs/results/table_groups.h"
#include "jobs/statistics/replicate_statistics.h"
#include "server/report/html.h"

namespace server::report {

namespace {

constexpr std::array<std::string_view, 4> kMetrics{"peak_slider_acceleration_m_s2", "peak_contact_force_n",
                                                   "impact_count", "peak_crank_torque_n_m"};
constexpr std::array<const char*, 8> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                              "#e69f00", "#56b4e9", "#8c6d1f", "#444444"};
constexpr std::size_t kMostPointsWithLines = 200;

/// The first axis with different numbers.
std::optional<std::string> find_number(const nlohmann::json& axes, const jobs::ResultTable& results) {
  for (const auto& axis : axes) {
    const auto path = axis.get<std::string>();
    if (jobs::is_numeric(path) &&
        jobs::group_rows(results, {jobs::find_column(results, path, "")}).size() > 1)
      return path;
  }
  return std::nullopt;
}

/// Values of a metric by the value on the x axis.
using Line = std::map<double, std::vector<double>>;

void add_line(const std::string& label, const Line& line, const char* colour, charts::Chart& chart) {
  charts::Series means{.label = label, .colour = colour, .markers = true};
  if (line.size() > kMostPointsWithLines) means.width = 0.0;
  for (const auto& [x, values] : line) {
    const auto statistics = jobs::calc_replicate_statistics(values);
    means.x.push_back(x);
    means.y.push_back(*statistics.mean);
    if (values.size() > 1)
      chart.series.push_back(
          {.x = {x, x}, .y = {*statistics.min, *statistics.max}, .colour = colour, .width = 2.0});
  }
  chart.series.push_back(std::move(means));
}

/// Leaves room for the legend above what is drawn.
void make_room_above(std::size_t labels, charts::Chart& chart) {
  if (labels < 2) return;
  chart.y_min = std::numeric_limits<double>::infinity();
  chart.y_max = -chart.y_min;
  for (const charts::Series& series : chart.series) {
    for (const double y : series.y) {
      chart.y_min = std::min(chart.y_min, y);
      chart.y_max = std::max(chart.y_max, y);
    }
  }
  const double size = std::max(chart.y_max - chart.y_min, 1e-3 * std::abs(chart.y_max));
  chart.y_min -= 0.04 * size;
  chart.y_max += 0.08 * static_cast<double>(labels) * size;
}

}  // namespace

std::string make_figures(const nlohmann::json& sweep, const jobs::ResultTable& results) {
  const auto along = find_number(sweep.at("axes"), results);
  if (!along) return "";
  const std::size_t x = jobs::find_column(results, *along, "");
  std::vector<std::size_t> others;
  const bool designed = sweep.at("request").contains(
      "design");  // its points lie beside each other: the other numbers make no lines
  for (const auto& axis : sweep.at("axes")) {
    const auto path = axis.get<std::string>();
    if (path != *along && !(designed && jobs::is_numeric(path)))
      others.push_back(jobs::find_column(results, path, ""));
  }
  const auto groups = jobs::group_rows(results, others);
  std::vector<charts::Chart> charts;
  for (const std::string& metric : jobs::choose_metrics(results, kMetrics)) {
    const std::size_t column = jobs::find_column(results, metric, "");
    charts::Chart chart{.title = metric, .x_label = *along, .y_label = ""};
    for (std::size_t g = 0; g < groups.size() && g < kColours.size(); ++g) {
      Line line;
      for (const std::size_t r : groups[g].rows) {
        const auto at = jobs::number_in(results.rows[r][x]);  // jobs of another linkage may have none
        if (const auto value = jobs::number_in(results.rows[r][column]); value && at)
          line[*at].push_back(*value);
      }
      std::string label;
      for (std::size_t i = 0; i < others.size(); ++i) {
        label += (label.empty() ? "" : ", ") + cell_text(groups[g].values[i]) +
            (groups[g].values[i].is_number() ? " (" + results.columns[others[i]] + ")" : "");
      }
      if (!line.empty()) add_line(label, line, kColours[g], chart);
    }
    if (chart.series.empty()) continue;
    make_room_above(std::min(groups.size(), kColours.size()), chart);
    charts.push_back(std::move(chart));
  }
  if (charts.empty()) return "";
  const std::string more = groups.size() > kColours.size()
                               ? " The first " + std::to_string(kColours.size()) + " of " +
                                     std::to_string(groups.size()) + " combinations are drawn."
                               : "";
  return "<figure>" + charts::draw(charts, 2) + "<figcaption>Means over " + escape(*along) +
      "; bars reach from the least to the largest value of what lies together." +
         more + "</figcaption></figure>\n";
}

}  // namespace server::report
