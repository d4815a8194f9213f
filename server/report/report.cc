// SPDX-License-Identifier: Apache-2.0
#include "server/report/report.h"

#include <algorithm>
#include <array>
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
#include "server/report/html.h"

namespace server::report {

namespace {

using jobs::value_or_null;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t kMostSets = 300;  ///< rows of a table that people read

std::string heading(const std::string& text) { return "<h2>" + escape(text) + "</h2>\n"; }

std::string make_summary(const json& sweep) {
  std::vector<std::vector<json>> rows;
  for (const char* const key : {"id", "state", "created_at", "started_at", "ended_at"})
    rows.push_back({key, sweep.at(key)});
  for (const auto& [state, count] : sweep.at("counts").items()) {
    if (count != 0) rows.push_back({"jobs, " + state, count});
  }
  return make_table({"", ""}, rows);
}

jobs::ReplicateStatistics statistics_of(const jobs::ResultTable& results, const jobs::RowGroup& group,
                                        const std::string& column) {
  const std::size_t c = jobs::find_column(results, column, "");
  std::vector<double> values;
  for (const std::size_t r : group.rows) {
    if (const auto value = jobs::number_in(results.rows[r][c])) values.push_back(*value);
  }
  return jobs::calc_replicate_statistics(values);
}

/// A row for each set of parameters: the peak over its replicates, and means of other metrics. Of a described
/// linkage: its first metrics.
std::string make_sets(const json& sweep, const jobs::ResultTable& results) {
  constexpr std::array<std::string_view, 5> kMeans{
      "amplification", "peak_contact_force_n", "max_penetration_um", "impact_count", "peak_crank_torque_n_m"};
  std::vector<std::string> headings = sweep.at("axes").get<std::vector<std::string>>();
  std::vector<std::size_t> swept;
  for (const std::string& path : headings) swept.push_back(jobs::find_column(results, path, ""));
  const std::string metric = jobs::choose_metric(results, "");
  std::vector<std::string> means = jobs::choose_metrics(results, kMeans);
  std::erase(means, metric);
  headings.insert(headings.end(), {"runs", metric + ", mean", "spread", "least", "largest"});
  for (const std::string& mean : means) headings.push_back(mean + ", mean");
  const auto groups = jobs::group_rows(results, swept);
  std::vector<std::vector<json>> rows;
  for (std::size_t g = 0; g < std::min(groups.size(), kMostSets); ++g) {
    std::vector<json> cells = groups[g].values;
    const auto peak = statistics_of(results, groups[g], metric);
    cells.insert(cells.end(), {peak.count, value_or_null(peak.mean), value_or_null(peak.spread),
                               value_or_null(peak.min), value_or_null(peak.max)});
    for (const std::string& mean : means)
      cells.push_back(value_or_null(statistics_of(results, groups[g], mean).mean));
    rows.push_back(std::move(cells));
  }
  const std::string more = groups.size() > kMostSets
                               ? "<p class=\"quiet\">The first " + std::to_string(kMostSets) + " of " +
                                     std::to_string(groups.size()) + " sets; all are in the CSV.</p>\n"
                               : "";
  return make_table(headings, rows) + more;
}

std::string make_analyses(const json& sweep, const jobs::ResultTable& results) {
  const std::string metric = jobs::choose_metric(results, "");
  std::string html;
  const auto add = [&](const std::string& title, const auto& calc) {
    try {
      const jobs::ResultTable table = calc(sweep, results, metric);
      html += heading(title) + make_table(table.columns, table.rows);
    } catch (const jobs::WrongState&) {  // the analysis does not apply to this sweep
    }
  };
  add("Effect of flexibility", jobs::compare_couplers);
  add("Sensitivity", jobs::calc_sensitivity);
  return html;
}

std::string make_provenance(const Provenance& provenance, std::size_t jobs) {
  std::vector<std::vector<json>> rows;
  for (const json& setup : provenance.setups) {
    rows.push_back({setup.at("jobs"), setup.at("version"), setup.at("commit"), setup.at("engine"),
                    setup.at("compiler"), setup.at("host"), setup.at("cpu")});
  }
  const std::string some = provenance.jobs_examined < jobs
                               ? "<p class=\"quiet\">Of the first " +
                                     std::to_string(provenance.jobs_examined) + " of " +
                                     std::to_string(jobs) + " jobs.</p>\n"
                               : "";
  return make_table({"jobs", "version", "commit", "engine", "compiler", "host", "processor"}, rows) + some;
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

std::string make_report(const json& sweep, const jobs::ResultTable& results, const Provenance& provenance) {
  const auto name = sweep.at("name").get<std::string>();
  const std::string title = name.empty() ? sweep.at("id").get<std::string>() : name;
  const ordered_json request = request_in_order(sweep);
  const std::string figures = make_figures(sweep, results);
  std::string body = "<h1>" + escape(title) + "</h1>\n" + make_summary(sweep);
  if (!figures.empty()) body += heading("Figures") + figures;
  body += heading("Results") + make_sets(sweep, results) + make_analyses(sweep, results);
  body += heading("Request") + "<pre>" + escape(to_text(request, 1)) + "</pre>\n";
  body += heading("Provenance") + make_provenance(provenance, results.rows.size());
  body += heading("Reproduction") +
          "<p>The command submits the sweep to the service at RPSUP_URL, by default on this machine; the "
          "same engine gives the same bytes.</p>\n<pre id=\"command\">" +
          escape(make_command(request)) + "</pre>\n";
  return make_page(title, body);
}

}  // namespace server::report
