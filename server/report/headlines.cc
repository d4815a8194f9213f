// SPDX-License-Identifier: Apache-2.0
#include "server/report/headlines.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "jobs/results/table_groups.h"
#include "jobs/statistics/replicate_statistics.h"
#include "server/report/html.h"
#include "server/report/quantity_text.h"

namespace server::report {
namespace {

using nlohmann::json;

constexpr std::size_t kMostListed = 5;

struct RankedRow {
  double value = 0.0;
  std::size_t row = 0;
};

/// Rows with a value, the largest first; equal ones in the order of the sweep.
std::vector<RankedRow> rank_rows(const ReportView& view) {
  std::vector<RankedRow> ranked;
  for (std::size_t r = 0; r < view.results.rows.size(); ++r)
    if (const auto value = jobs::number_in(view.results.rows[r][view.metric_column]))
      ranked.push_back({*value, r});
  std::ranges::stable_sort(ranked, [](const RankedRow& a, const RankedRow& b) { return a.value > b.value; });
  return ranked;
}

/// Row with the largest value of each setting: replicates of one would fill the list.
std::vector<RankedRow> rank_settings(const ReportView& view) {
  std::set<std::string> seen;
  std::vector<RankedRow> ranked = rank_rows(view);
  std::erase_if(ranked, [&](const RankedRow& at) {
    return !seen.insert(view.setting_of(view.results.rows[at.row])).second;
  });
  return ranked;
}

std::optional<std::size_t> find_time_column(const ReportView& view) {
  const auto found = std::ranges::find(view.results.columns, time_key_of(view.metric));
  if (found == view.results.columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - view.results.columns.begin());
}

std::string item(const std::string& text) { return "<li>" + text + "</li>\n"; }

std::string extreme_sentence(const ReportView& view, const std::string& which, const RankedRow& at) {
  const auto& row = view.results.rows[at.row];
  std::string text = which + ": <strong>" + escape(value_text(at.value, view.metric)) + "</strong>";
  if (const auto time = find_time_column(view); time && row[*time].is_number())
    text += " at " + escape(value_text(row[*time], "_s")) + " of the run";
  if (const std::string setting = view.setting_of(row); !setting.empty()) text += ", " + escape(setting);
  return item(text + ".");
}

std::string percent(double part) {
  const std::string text = cell_text(std::round(1e4 * part) / 100.0);
  return text + " %";
}

/// Differences between replicates of the same setting.
struct ReplicateScatter {
  std::size_t settings = 0;  ///< that were run more than once
  double widest = -1.0;      ///< largest difference of two values of a setting, over their mean
  std::string setting{};     ///< setting of that difference
};

/// Difference of the largest and the least value, over the mean.
double calc_relative_range(const std::vector<double>& values) {
  const auto statistics = jobs::calc_replicate_statistics(values);
  return *statistics.mean != 0.0 ? (*statistics.max - *statistics.min) / std::abs(*statistics.mean) : 0.0;
}

std::vector<double> values_of_group(const ReportView& view, const jobs::RowGroup& group) {
  std::vector<double> values;
  for (const std::size_t r : group.rows)
    if (const auto value = jobs::number_in(view.results.rows[r][view.metric_column]))
      values.push_back(*value);
  return values;
}

ReplicateScatter find_scatter(const ReportView& view) {
  ReplicateScatter scatter;
  if (std::ranges::find(view.results.columns, "replicate") == view.results.columns.end()) return scatter;
  std::vector<std::size_t> columns;
  for (const std::string& path : view.axes) columns.push_back(view.column(path));
  for (const jobs::RowGroup& group : jobs::group_rows(view.results, columns)) {
    const std::vector<double> values = values_of_group(view, group);
    if (values.size() < 2) continue;
    ++scatter.settings;
    const double part = calc_relative_range(values);
    if (part <= scatter.widest) continue;
    scatter.widest = part;
    scatter.setting = view.setting_of(view.results.rows[group.rows.front()]);
  }
  return scatter;
}

std::string scatter_sentence(const ReportView& view) {
  const auto& [settings, widest, setting] = find_scatter(view);
  if (settings == 0) return item("One run each: how much the values scatter is not known.");
  return item("Replicates differ by at most <strong>" + percent(widest) + "</strong> of their mean" +
              (setting.empty() ? "" : " (" + escape(setting) + ")") + "; " + std::to_string(settings) +
              (settings == 1 ? " setting was" : " settings were") + " run more than once.");
}

std::string failure_sentence(const ReportView& view, const FailureCounts& failures) {
  std::size_t failed = 0;
  std::string reasons;
  for (const auto& [reason, count] : failures) {
    failed += count;
    reasons += (reasons.empty() ? "" : ", ") + std::to_string(count) + " by " + escape(reason);
  }
  if (failed == 0) return "";
  return item("<strong>" + std::to_string(failed) + "</strong> of " +
              std::to_string(view.results.rows.size()) + " jobs failed: " + reasons + ".");
}

std::vector<std::string> headings_of_largest(const ReportView& view, bool has_time) {
  std::vector<std::string> headings{title_of(view.metric)};
  if (has_time) headings.emplace_back("Time [s]");
  for (const std::string& path : view.axes) headings.push_back(title_of(path));
  headings.emplace_back("Job");
  return headings;
}

}  // namespace

std::string make_headlines(const ReportView& view, const FailureCounts& failures) {
  const auto ranked = rank_rows(view);
  std::string items;
  if (!ranked.empty()) {
    const std::string far = view.results.ended ? "" : " so far";
    items += extreme_sentence(view, "Largest " + escape(name_of(view.metric)) + far, ranked.front());
    if (ranked.back().value < ranked.front().value)
      items += extreme_sentence(view, "Least" + far, ranked.back());
    if (ranked.size() > 1) items += scatter_sentence(view);
  } else {
    items += item("No job has a value of " + escape(name_of(view.metric)) + ".");
  }
  return "<ul class=\"headlines\">\n" + items + failure_sentence(view, failures) + "</ul>\n";
}

std::string make_largest(const ReportView& view) {
  const auto ranked = rank_settings(view);
  if (ranked.size() < 2) return "";
  const auto time = find_time_column(view);
  std::vector<std::vector<json>> rows;
  for (std::size_t k = 0; k < std::min(ranked.size(), kMostListed); ++k) {
    const auto& row = view.results.rows[ranked[k].row];
    std::vector<json> cells{ranked[k].value};
    if (time) cells.push_back(row[*time]);
    for (const std::string& path : view.axes) cells.push_back(row[view.column(path)]);
    cells.push_back(row.front());
    rows.push_back(std::move(cells));
  }
  return make_table(headings_of_largest(view, time.has_value()), rows);
}

}  // namespace server::report
