// SPDX-License-Identifier: Apache-2.0
#include "server/report/heat_maps.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "charts/heat_map.h"
#include "jobs/results/table_groups.h"
#include "server/report/html.h"
#include "server/report/quantity_text.h"

namespace server::report {
namespace {

using nlohmann::json;

constexpr std::size_t kMostColumns = 60, kMostRows = 60, kMostMaps = 12;

/// Different values of an axis: numbers in their order, anything else in that of the sweep.
std::vector<json> values_of(const ReportView& view, const std::string& path) {
  std::vector<json> values;
  for (const jobs::RowGroup& group : jobs::group_rows(view.results, {view.column(path)}))
    values.push_back(group.values.front());
  if (std::ranges::all_of(values, [](const json& value) { return value.is_number(); }))
    std::ranges::sort(values, {}, [](const json& value) { return value.get<double>(); });
  return values;
}

std::vector<std::string> names_of(const std::vector<json>& values) {
  std::vector<std::string> names;
  for (const json& value : values) names.push_back(cell_text(value));
  return names;
}

std::size_t index_of(const std::vector<json>& values, const json& value) {
  return static_cast<std::size_t>(std::ranges::find(values, value) - values.begin());
}

/// Axes of all maps, with the values that they have.
struct Plane {
  std::string x, y;
  std::vector<json> xs, ys;
  std::vector<std::string> others{};  ///< axes of which each map has one value
};

std::string make_map_title(const Plane& plane, const jobs::RowGroup& panel) {
  std::string title;
  for (std::size_t k = 0; k < plane.others.size(); ++k) {
    const std::string& path = plane.others[k];
    title += (k > 0 ? ", " : "") + name_of(path) + " " + value_text(panel.values[k], path);
  }
  return title;
}

charts::HeatMap make_map(const ReportView& view, const jobs::RowGroup& panel, const Plane& plane) {
  const auto& [x, y, xs, ys, others] = plane;
  charts::HeatMap map{
      .title = make_map_title(plane, panel), .columns = names_of(xs), .rows = names_of(ys), .values = {}};
  map.values.assign(ys.size(), std::vector<double>(xs.size(), std::numeric_limits<double>::quiet_NaN()));
  std::vector<std::vector<std::vector<std::size_t>>> rows(ys.size(),
                                                          std::vector<std::vector<std::size_t>>(xs.size()));
  for (const std::size_t r : panel.rows) {
    const auto& row = view.results.rows[r];
    rows[index_of(ys, row[view.column(y)])][index_of(xs, row[view.column(x)])].push_back(r);
  }
  for (std::size_t i = 0; i < ys.size(); ++i)
    for (std::size_t k = 0; k < xs.size(); ++k)
      map.values[i][k] = mean_of(view.results, rows[i][k], view.metric_column).value_or(map.values[i][k]);
  return map;
}

/// The two axes with most values, that along the charts first.
Plane choose_plane(const ReportView& view) {
  std::vector<std::string> axes = view.axes;
  std::ranges::stable_sort(axes, std::ranges::greater(), [&](const std::string& path) {
    return path == view.along ? std::numeric_limits<std::size_t>::max() : values_of(view, path).size();
  });
  return {.x = axes[0],
          .y = axes[1],
          .xs = values_of(view, axes[0]),
          .ys = values_of(view, axes[1]),
          .others = {axes.begin() + 2, axes.end()}};
}

}  // namespace

std::string make_heat_maps(const ReportView& view) {
  if (view.designed || view.axes.size() < 2) return "";
  const Plane plane = choose_plane(view);
  std::vector<std::size_t> columns;
  for (const std::string& path : plane.others) columns.push_back(view.column(path));
  const auto panels = jobs::group_rows(view.results, columns);
  if (plane.xs.size() < 2 || plane.ys.size() < 2 || plane.xs.size() > kMostColumns ||
      plane.ys.size() > kMostRows || panels.size() > kMostMaps)
    return "";
  std::vector<charts::HeatMap> maps;
  for (const jobs::RowGroup& panel : panels) maps.push_back(make_map(view, panel, plane));
  const auto svg = charts::draw_heat_maps(maps, title_of(plane.x), title_of(plane.y), title_of(view.metric));
  return svg.empty() ? ""
                     : "<figure>" + svg + "<figcaption>" + escape(title_of(view.metric)) +
                           " of all combinations; means of what lies together.</figcaption></figure>\n";
}

}  // namespace server::report
