// SPDX-License-Identifier: Apache-2.0
#include "server/report/figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "charts/chart.h"
#include "charts/colour_scale.h"
#include "jobs/requests/axis.h"
#include "jobs/results/table_groups.h"
#include "jobs/statistics/replicate_statistics.h"
#include "server/report/html.h"
#include "server/report/quantity_text.h"

namespace server::report {
namespace {

constexpr std::array<std::string_view, 4> kMetrics{"peak_slider_acceleration_m_s2", "peak_contact_force_n",
                                                   "impact_count", "peak_crank_torque_n_m"};
constexpr std::size_t kMostCurves = 12;
constexpr std::size_t kMostPointsWithLines = 200;
constexpr double kBrightest = 0.9;  ///< of the colour scale: yellow is not seen on white
constexpr std::array<const char*, 4> kDashes{"", "6 3", "2 3", "9 3 2 3"};

/// Values of a metric by the value on the x axis.
using Line = std::map<double, std::vector<double>>;

void add_line(const charts::Series& look, const Line& line, charts::Chart& chart) {
  charts::Series means = look;
  means.markers = line.size() < 40;
  if (line.size() > kMostPointsWithLines) means.width = 0.0;
  for (const auto& [x, values] : line) {
    const auto statistics = jobs::calc_replicate_statistics(values);
    means.x.push_back(x);
    means.y.push_back(*statistics.mean);
    if (values.size() > 1)
      chart.series.push_back(
          {.x = {x, x}, .y = {*statistics.min, *statistics.max}, .colour = look.colour, .width = 2.0});
  }
  chart.series.push_back(std::move(means));
}

/// Axes beside the one along the charts.
std::vector<std::string> other_axes(const ReportView& view) {
  std::vector<std::string> others;
  for (const std::string& path : view.axes)
    if (path != *view.along && !(view.designed && jobs::is_numeric(path))) others.push_back(path);
  return others;
}

double largest_of(const ReportView& view, const jobs::RowGroup& group) {
  double largest = -std::numeric_limits<double>::infinity();
  for (const std::size_t r : group.rows)
    largest = std::max(largest, jobs::number_in(view.results.rows[r][view.metric_column]).value_or(largest));
  return largest;
}

/// Colour by the first number among the others, dashes by the rest.
class CurveLooks {
 public:
  CurveLooks(const std::vector<std::string>& others, const std::vector<jobs::RowGroup>& groups)
      : others_(others) {
    for (std::size_t k = 0; k < others.size(); ++k)
      if (!number_ && jobs::is_numeric(others[k])) number_ = k;
    for (const jobs::RowGroup& group : groups) {
      if (number_) numbers_.insert(jobs::number_in(group.values[*number_]).value_or(0.0));
      rest_.insert({rest_of(group), rest_.size()});
    }
  }

  /// Number of a group's combination among those of the rest.
  [[nodiscard]] std::size_t kind_of(const jobs::RowGroup& group) const { return rest_.at(rest_of(group)); }

  [[nodiscard]] charts::Series look_of(const jobs::RowGroup& group) const {
    const std::size_t kind = kind_of(group);
    charts::Series look{.label = label_of(group), .colour = charts::colour_at(part_of(group, kind))};
    look.dashes = kDashes[kind % kDashes.size()];
    return look;
  }

 private:
  [[nodiscard]] nlohmann::json rest_of(const jobs::RowGroup& group) const {
    nlohmann::json rest = group.values;
    if (number_) rest.erase(*number_);
    return rest;
  }

  [[nodiscard]] double part_of(const jobs::RowGroup& group, std::size_t kind) const {
    if (!number_ || numbers_.size() < 2)
      return rest_.size() > 1 ? kBrightest * static_cast<double>(kind) / static_cast<double>(rest_.size() - 1)
                              : 0.3;
    const double value = jobs::number_in(group.values[*number_]).value_or(0.0);
    return kBrightest * (value - *numbers_.begin()) / (*numbers_.rbegin() - *numbers_.begin());
  }

  [[nodiscard]] std::string label_of(const jobs::RowGroup& group) const {
    std::string label;
    for (std::size_t k = 0; k < others_.size(); ++k)
      label += (label.empty() ? "" : ", ") + value_text(group.values[k], others_[k]);
    return label;
  }

  const std::vector<std::string>& others_;
  std::optional<std::size_t> number_;
  std::set<double> numbers_;
  std::map<nlohmann::json, std::size_t> rest_;
};

/// Items evenly spread, both ends among them.
std::vector<std::size_t> spread_evenly(const std::vector<std::size_t>& items, std::size_t most) {
  if (items.size() <= most) return items;
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < most; ++k)
    chosen.push_back(items[most > 1 ? k * (items.size() - 1) / (most - 1) : items.size() / 2]);
  return chosen;
}

/// As many groups of each kind, evenly spread over its members and over the kinds.
std::set<std::size_t> choose_of_each_kind(const std::map<std::size_t, std::vector<std::size_t>>& by_kind) {
  std::vector<std::size_t> kinds;
  for (const auto& [kind, members] : by_kind) kinds.push_back(kind);
  kinds = spread_evenly(kinds, kMostCurves);
  std::set<std::size_t> chosen;
  for (const std::size_t kind : kinds)
    for (const std::size_t g : spread_evenly(by_kind.at(kind), kMostCurves / kinds.size())) chosen.insert(g);
  return chosen;
}

/// Indices of the groups that are drawn: as many of each kind, evenly spread, and that of the largest value.
std::vector<std::size_t> choose_groups(const ReportView& view, const std::vector<jobs::RowGroup>& groups,
                                       const CurveLooks& looks) {
  std::map<std::size_t, std::vector<std::size_t>> by_kind;
  std::size_t largest = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    by_kind[looks.kind_of(groups[g])].push_back(g);
    if (largest_of(view, groups[g]) > largest_of(view, groups[largest])) largest = g;
  }
  std::set<std::size_t> chosen = choose_of_each_kind(by_kind);
  if (!chosen.contains(largest)) {
    const auto after = chosen.upper_bound(largest);
    if (chosen.size() >= kMostCurves) chosen.erase(after == chosen.end() ? std::prev(after) : after);
    chosen.insert(largest);
  }
  return {chosen.begin(), chosen.end()};
}

Line line_of(const ReportView& view, const jobs::RowGroup& group, std::size_t x, std::size_t metric) {
  Line line;
  for (const std::size_t r : group.rows) {
    const auto at = jobs::number_in(view.results.rows[r][x]);  // jobs of another linkage may have none
    if (const auto value = jobs::number_in(view.results.rows[r][metric]); value && at)
      line[*at].push_back(*value);
  }
  return line;
}

/// The chosen metric, then those that the linkages have of the usual ones.
std::vector<std::string> charted_metrics(const ReportView& view) {
  std::vector<std::string> metrics = jobs::choose_metrics(view.results, kMetrics);
  std::erase(metrics, view.metric);
  metrics.insert(metrics.begin(), view.metric);
  metrics.resize(std::min(metrics.size(), kMetrics.size()));
  return metrics;
}

}  // namespace

std::string make_figures(const ReportView& view) {
  if (!view.along) return "";
  const std::vector<std::string> others = other_axes(view);
  std::vector<std::size_t> columns;
  for (const std::string& path : others) columns.push_back(view.column(path));
  const auto groups = jobs::group_rows(view.results, columns);
  const CurveLooks looks(others, groups);
  const auto chosen = choose_groups(view, groups, looks);
  std::vector<charts::Chart> charts;
  for (const std::string& metric : charted_metrics(view)) {
    charts::Chart chart{.title = title_of(metric), .x_label = title_of(*view.along), .legend_outside = true};
    for (const std::size_t g : chosen) {
      const Line line = line_of(view, groups[g], view.column(*view.along), view.column(metric));
      if (!line.empty()) add_line(looks.look_of(groups[g]), line, chart);
    }
    if (!chart.series.empty()) charts.push_back(std::move(chart));
  }
  if (charts.empty()) return "";
  const std::string some = chosen.size() < groups.size()
                               ? " " + std::to_string(chosen.size()) + " of " +
                                     std::to_string(groups.size()) +
                                     " combinations are drawn, that with the largest value among them."
                               : "";
  return "<figure>" + charts::draw(charts, 1, 1040, 300) + "<figcaption>Means over " +
         escape(name_of(*view.along)) +
         "; bars reach from the least to the largest value of what lies together." + some +
         "</figcaption></figure>\n";
}

}  // namespace server::report
