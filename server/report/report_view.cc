// SPDX-License-Identifier: Apache-2.0
#include "server/report/report_view.h"

#include <algorithm>

#include "jobs/base/errors.h"
#include "jobs/requests/axis.h"
#include "jobs/results/table_groups.h"
#include "server/report/quantity_text.h"

namespace server::report {
namespace {

bool varies_numbers(const jobs::ResultTable& results, const std::string& path) {
  return jobs::is_numeric(path) &&
         jobs::group_rows(results, {jobs::find_column(results, path, "")}).size() > 1;
}

std::optional<std::string> choose_along(const jobs::ResultTable& results,
                                        const std::vector<std::string>& axes, const std::string& wanted) {
  if (!wanted.empty()) {
    if (std::ranges::find(axes, wanted) != axes.end() && varies_numbers(results, wanted)) return wanted;
    throw jobs::InvalidRequest(std::vector<jobs::Fault>{{"/x", "must be a number that the sweep varies"}});
  }
  for (const std::string& path : axes)
    if (varies_numbers(results, path)) return path;
  return std::nullopt;
}

}  // namespace

ReportView::ReportView(const nlohmann::json& of_sweep, const jobs::ResultTable& of_results,
                       const ReportQuery& query)
    : sweep(of_sweep),
      results(of_results),
      metric(jobs::choose_free_metric(of_sweep, of_results, query.metric)),
      metric_column(jobs::find_metric(of_results, metric)),
      axes(of_sweep.at("axes").get<std::vector<std::string>>()),
      along(choose_along(of_results, axes, query.x)),
      designed(of_sweep.at("request").contains("design")) {}

std::size_t ReportView::column(const std::string& name) const { return jobs::find_column(results, name, ""); }

std::string ReportView::setting_of(const std::vector<nlohmann::json>& row) const {
  std::string text;
  for (const std::string& path : axes) {
    const nlohmann::json& value = row[column(path)];
    if (!value.is_null()) text += (text.empty() ? "" : ", ") + name_of(path) + " " + value_text(value, path);
  }
  return text;
}

std::optional<double> mean_of(const jobs::ResultTable& results, const std::vector<std::size_t>& rows,
                              std::size_t column) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const std::size_t r : rows) {
    if (const auto value = jobs::number_in(results.rows[r][column])) {
      sum += *value;
      ++count;
    }
  }
  return count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt;
}

}  // namespace server::report
