// SPDX-License-Identifier: Apache-2.0
#include "server/report/report.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>
#include <utility>

#include "jobs/base/errors.h"
#include "jobs/base/optional_json.h"
#include "jobs/flexibility/flexibility.h"
#include "jobs/results/table_groups.h"
#include "jobs/sensitivity/sensitivity.h"
#include "jobs/statistics/replicate_statistics.h"
#include "server/messages/json_text.h"
#include "server/report/figures.h"
#include "server/report/heat_maps.h"
#include "server/report/html.h"
#include "server/report/quantity_text.h"

namespace server::report {

namespace {

using jobs::value_or_null;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t kMostSets = 40;  ///< rows of a table that people read

/// A word of a table as people write it: "one run each" of "one_run_each".
json readable_cell(const json& cell) {
  if (!cell.is_string()) return cell;
  std::string text = cell.get<std::string>();
  std::ranges::replace(text, '_', ' ');
  return text;
}

/// Indices of the columns of a table without some of them.
std::vector<std::size_t> find_kept_columns(const jobs::ResultTable& table,
                                           const std::vector<std::string>& left_out) {
  std::vector<std::size_t> kept;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (std::ranges::find(left_out, table.columns[c]) == left_out.end()) kept.push_back(c);
  return kept;
}

std::string make_quiet_paragraph(const std::string& text) { return "<p class=\"quiet\">" + text + "</p>\n"; }

/// A table with titles as headings and words of people, without some of its columns, and its first rows.
std::string make_titled_table(const jobs::ResultTable& table, const std::vector<std::string>& left_out) {
  const std::vector<std::size_t> kept = find_kept_columns(table, left_out);
  std::vector<std::string> headings;
  for (const std::size_t c : kept) headings.push_back(title_of(table.columns[c]));
  std::vector<std::vector<json>> rows;
  for (std::size_t r = 0; r < std::min(table.rows.size(), kMostSets); ++r) {
    std::vector<json> cells;
    for (const std::size_t c : kept) cells.push_back(readable_cell(table.rows[r][c]));
    rows.push_back(std::move(cells));
  }
  if (table.rows.size() <= kMostSets) return make_table(headings, rows);
  return make_table(headings, rows) + make_quiet_paragraph("The first " + std::to_string(kMostSets) + " of " +
                                                           std::to_string(table.rows.size()) + " rows.");
}

/// @returns whether a table has more in a column than that value
bool says_more_than(const jobs::ResultTable& table, const std::string& name, const json& value) {
  const std::size_t column = jobs::find_column(table, name, "");
  return std::ranges::any_of(table.rows, [&](const auto& row) { return row[column] != value; });
}

std::string heading(const std::string& text) { return "<h2>" + escape(text) + "</h2>\n"; }

/// A heading and what stands under it; empty if that is.
std::string make_optional_section(const std::string& title, const std::string& content) {
  return content.empty() ? "" : heading(title) + content;
}

/// "5 to 15 rad/s, 25 values"; of a list its values.
std::string axis_text(const json& axis, const std::string& key) {
  if (axis.is_object()) {
    const std::string ends = value_text(axis.at("from"), "") + " to " + value_text(axis.at("to"), key);
    return axis.contains("count") ? ends + ", " + axis.at("count").dump() + " values" : ends;
  }
  constexpr std::size_t kMostShown = 12;
  std::string text;
  for (std::size_t k = 0; k < std::min(axis.size(), kMostShown); ++k)
    text += (k > 0 ? ", " : "") + value_text(axis[k], key);
  return axis.size() > kMostShown ? text + ", … (" + std::to_string(axis.size()) + " values)" : text;
}

/// Rows of axes and given parameters, without descriptions, which stand in the request.
void add_configuration(const json& request, std::vector<std::vector<json>>& rows) {
  const auto add = [&](const std::string& key, const json& value, const auto& text_of) {
    rows.push_back({title_of(key).substr(0, title_of(key).find(" [")), text_of(value, key)});
  };
  const json axes = request.value("sweep", json::object());
  for (const auto& [key, axis] : axes.items()) add(key, axis, axis_text);
  if (request.contains("design"))
    for (const auto& [key, range] : request.at("design").at("over").items()) add(key, range, axis_text);
  const json parameters = request.value("parameters", json::object());
  for (const auto& [key, value] : parameters.items())
    if (value.is_primitive()) add(key, value, value_text);
}

/// "2026-11-27 21:10:40 UTC" of a time as the interface has it.
json readable_time(const json& time) {
  if (!time.is_string()) return nullptr;
  std::string text = time.get<std::string>().substr(0, 19);
  std::ranges::replace(text, 'T', ' ');
  return text + " UTC";
}

std::string tags_text(const json& tags) {
  std::string text;
  for (const json& tag : tags) text += (text.empty() ? "" : ", ") + tag.get<std::string>();
  return text;
}

/// "12, 10 succeeded, 2 failed"
std::string counts_text(const json& counts) {
  std::string text = counts.at("total").dump();
  for (const auto& [state, count] : counts.items())
    if (state != "total" && count != 0) text += ", " + count.dump() + " " + state;
  return text;
}

std::string make_summary(const json& sweep) {
  std::vector<std::vector<json>> rows;
  const auto add = [&](const char* name, const json& value) {
    if (!value.is_null() && value != "") rows.push_back({name, value});
  };
  add_configuration(sweep.at("request"), rows);
  add("Tags", tags_text(sweep.at("tags")));
  add("Jobs", counts_text(sweep.at("counts")));
  add("Submitted", readable_time(sweep.at("created_at")));
  add("First job started", readable_time(sweep.at("started_at")));
  add("Last job ended", readable_time(sweep.at("ended_at")));
  add("Sweep", sweep.at("id"));
  const std::string notes = sweep.at("notes");
  return make_table({}, rows) + (notes.empty() ? "" : "<p class=\"notes\">" + escape(notes) + "</p>\n");
}

jobs::ReplicateStatistics statistics_of(const jobs::ResultTable& results, const jobs::RowGroup& group,
                                        std::size_t column) {
  std::vector<double> values;
  for (const std::size_t r : group.rows) {
    if (const auto value = jobs::number_in(results.rows[r][column])) values.push_back(*value);
  }
  return jobs::calc_replicate_statistics(values);
}

/// A set of equal parameters, with the metric over its replicates.
struct ResultSet {
  jobs::RowGroup group;
  jobs::ReplicateStatistics metric;
};

/// All sets, those with the largest means first.
std::vector<ResultSet> rank_sets(const ReportView& view) {
  std::vector<std::size_t> columns;
  for (const std::string& path : view.axes) columns.push_back(view.column(path));
  std::vector<ResultSet> sets;
  for (jobs::RowGroup& group : jobs::group_rows(view.results, columns)) {
    const auto metric = statistics_of(view.results, group, view.metric_column);
    sets.push_back({std::move(group), metric});
  }
  std::ranges::stable_sort(sets, std::ranges::greater(), [](const ResultSet& set) {
    return set.metric.mean.value_or(-std::numeric_limits<double>::infinity());
  });
  return sets;
}

/// Columns of the table of sets, beside those of the axes and the metric.
struct SetColumns {
  bool repeated = false;             ///< whether there are those of replicates
  std::vector<std::string> means{};  ///< metrics of which the means are shown
};

SetColumns choose_set_columns(const ReportView& view, const std::vector<ResultSet>& sets) {
  constexpr std::array<std::string_view, 5> kMeans{
      "amplification", "peak_contact_force_n", "max_penetration_um", "impact_count", "peak_crank_torque_n_m"};
  SetColumns columns;
  columns.repeated = std::ranges::any_of(sets, [](const ResultSet& set) { return set.metric.count > 1; });
  columns.means = jobs::choose_metrics(view.results, kMeans);
  std::erase(columns.means, view.metric);
  return columns;
}

std::vector<std::string> headings_of_sets(const ReportView& view, const SetColumns& columns) {
  std::vector<std::string> headings;
  for (const std::string& path : view.axes) headings.push_back(title_of(path));
  headings.push_back(title_of(view.metric));
  if (columns.repeated) headings.insert(headings.end(), {"Runs", "Spread", "Least", "Largest"});
  for (const std::string& mean : columns.means) headings.push_back(title_of(mean));
  return headings;
}

std::vector<json> cells_of_set(const ReportView& view, const SetColumns& columns, const ResultSet& set) {
  const auto& [group, metric] = set;
  std::vector<json> cells = group.values;
  cells.push_back(value_or_null(metric.mean));
  if (columns.repeated)
    cells.insert(cells.end(), {metric.count, value_or_null(metric.spread), value_or_null(metric.min),
                               value_or_null(metric.max)});
  for (const std::string& mean : columns.means)
    cells.push_back(value_or_null(mean_of(view.results, group.rows, view.column(mean))));
  return cells;
}

/// A row for each of the sets with the largest means: the metric over its replicates, and means of others.
std::string make_sets(const ReportView& view) {
  const std::vector<ResultSet> sets = rank_sets(view);
  const SetColumns columns = choose_set_columns(view, sets);
  std::vector<std::vector<json>> rows;
  for (std::size_t k = 0; k < std::min(sets.size(), kMostSets); ++k)
    rows.push_back(cells_of_set(view, columns, sets[k]));
  const std::string table = make_table(headings_of_sets(view, columns), rows);
  if (sets.size() <= kMostSets) return table;
  return table + make_quiet_paragraph("The " + std::to_string(kMostSets) + " of " +
                                      std::to_string(sets.size()) +
                                      " settings with the largest means; the appendix (?rows=true) and the "
                                      "CSV have all.");
}

std::vector<std::string> choose_appendix_columns(const ReportView& view) {
  std::vector<std::string> columns{"job_id", "state"};
  if (std::ranges::find(view.results.columns, "replicate") != view.results.columns.end())
    columns.emplace_back("replicate");
  columns.insert(columns.end(), view.axes.begin(), view.axes.end());
  columns.push_back(view.metric);
  return columns;
}

/// All jobs, with the metric and the usual others.
std::string make_appendix(const ReportView& view) {
  std::vector<std::string> headings;
  std::vector<std::size_t> places;
  for (const std::string& column : choose_appendix_columns(view)) {
    headings.push_back(column == "job_id" ? "Job" : title_of(column));
    places.push_back(view.column(column));
  }
  std::vector<std::vector<json>> rows;
  for (const auto& row : view.results.rows) {
    std::vector<json> cells;
    for (const std::size_t place : places) cells.push_back(row[place]);
    rows.push_back(std::move(cells));
  }
  return make_table(headings, rows);
}

std::string make_flexibility(const ReportView& view) {
  const jobs::ResultTable table = jobs::compare_links(view.sweep, view.results, view.metric);
  if (!says_more_than(table, "verdict", "one_run_each"))
    return "<p>One run each: whether the flexible link helps is not known without replicates.</p>\n";
  return make_titled_table(
      table, {"metric", "along", "rigid_spread", "rigid_min", "rigid_max", "flexible_spread", "flexible_min",
              "flexible_max", "rigid_count", "flexible_count"});
}

std::string make_sensitivity(const ReportView& view) {
  return make_titled_table(jobs::calc_sensitivity(view.sweep, view.results, view.metric), {"metric"});
}

std::string make_analyses(const ReportView& view) {
  std::string html;
  const auto add = [&](const std::string& title, const auto& make) {
    try {
      html += heading(title) + make(view);
    } catch (const jobs::WrongState&) {  // the analysis does not apply to this sweep
    }
  };
  add("Effect of flexibility", make_flexibility);
  add("Sensitivity", make_sensitivity);
  return html;
}

std::string make_provenance(const Provenance& provenance, std::size_t jobs) {
  std::vector<std::vector<json>> rows;
  for (const json& setup : provenance.setups) {
    rows.push_back({setup.at("jobs"), setup.at("version"), setup.at("commit"), setup.at("engine"),
                    setup.at("compiler"), setup.at("host"), setup.at("cpu")});
  }
  const std::string some =
      provenance.jobs_examined < jobs
          ? make_quiet_paragraph("Of the first " + std::to_string(provenance.jobs_examined) + " of " +
                                 std::to_string(jobs) + " jobs.")
          : "";
  return make_table({"Jobs", "Version", "Commit", "Engine", "Compiler", "Host", "Processor"}, rows) + some;
}

}  // namespace

ordered_json request_in_order(const json& sweep) {
  ordered_json request = ordered_json(sweep.at("request"));
  const auto order = [&](ordered_json& object) {
    ordered_json ordered = ordered_json::object();
    for (const json& axis : sweep.at("axes")) {
      const auto path = axis.get<std::string>();
      if (object.contains(path)) ordered[path] = object.at(path);
    }
    object = std::move(ordered);
  };
  if (request.contains("sweep")) order(request["sweep"]);
  if (request.contains("design")) order(request["design"]["over"]);
  return request;
}

std::string make_command(const ordered_json& request) {
  std::string quoted;
  for (const char c : to_text(request)) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return "curl -s -d '" + quoted + "' \"${RPSUP_URL:-http://127.0.0.1:8080}/v1/sweeps\"";
}

static std::string title_of_sweep(const json& sweep) {
  const auto name = sweep.at("name").get<std::string>();
  return name.empty() ? sweep.at("id").get<std::string>() : name;
}

static std::string make_reproduction(const ordered_json& request) {
  return "<p>The command submits the sweep to the service at RPSUP_URL, by default on this machine; the "
         "same engine gives the same bytes.</p>\n<pre id=\"command\">" +
         escape(make_command(request)) + "</pre>\n";
}

std::string make_report(const json& sweep, const jobs::ResultTable& results, const ReportQuery& query,
                        const FailureCounts& failures, const Provenance& provenance) {
  const ReportView view(sweep, results, query);
  const std::string title = title_of_sweep(sweep);
  const ordered_json request = request_in_order(sweep);
  std::string body = "<h1>" + escape(title) + "</h1>\n" + make_headlines(view, failures);
  body += make_optional_section("Largest values", make_largest(view));
  body += heading("Sweep") + make_summary(sweep);
  body += make_optional_section("Figures", make_heat_maps(view) + make_figures(view));
  body += heading("Results") + make_sets(view) + make_analyses(view);
  body += heading("Request") + "<pre>" + escape(to_text(request, 1)) + "</pre>\n";
  body += heading("Provenance") + make_provenance(provenance, results.rows.size());
  body += heading("Reproduction") + make_reproduction(request);
  if (query.appendix == Appendix::kRows) body += heading("Appendix: all jobs") + make_appendix(view);
  return make_page(title, body);
}

}  // namespace server::report
