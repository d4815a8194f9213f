// SPDX-License-Identifier: Apache-2.0
#include "jobs/search/search_json.h"

#include <algorithm>
#include <map>

#include <boost/math/distributions/binomial.hpp>

#include "jobs/base/optional_json.h"
#include "jobs/requests/axis.h"
#include "jobs/results/resource_json.h"
#include "jobs/search/search_results.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr double kPartConfidence = 0.9;  ///< of the interval of part_within

/// Clopper-Pearson interval of the probability that a replicate stays within the bound.
json part_within_json(std::size_t within, std::size_t count) {
  using Binomial = boost::math::binomial_distribution<double>;
  const double n = static_cast<double>(count);
  const double k = static_cast<double>(within);
  const double side = 0.5 * (1.0 - kPartConfidence);
  return {{"within", within}, {"part_within_low", Binomial::find_lower_bound_on_p(n, k, side)},
      {"part_within_high", Binomial::find_upper_bound_on_p(n, k, side)}};
}

json evaluation_json(const Evaluation& evaluation, const std::vector<std::string>& job_ids,
                     const LimitRule& rule) {
  json made{{"value", evaluation.x}, {"count", evaluation.values.size()}, {"pending", evaluation.pending},
            {"lost", evaluation.lost}, {"lost_reason", value_or_null(evaluation.lost_reason)},
            {"job_ids", job_ids}, {"quantile", nullptr}, {"min", nullptr}, {"max", nullptr},
            {"within", nullptr}, {"part_within_low", nullptr}, {"part_within_high", nullptr}};
  if (evaluation.values.empty()) return made;
  const auto [least, most] = std::ranges::minmax(evaluation.values);
  const auto within =
      std::ranges::count_if(evaluation.values, [&](double value) { return value <= rule.bound; });
  made.update({{"quantile", calc_quantile(evaluation.values, rule.quantile)}, {"min", least}, {"max", most}});
  made.update(part_within_json(static_cast<std::size_t>(within), evaluation.values.size()));
  return made;
}

json fall_json(const Fall& fall) {
  return {{"from", fall.from}, {"to", fall.to}, {"within_again", fall.within_again}};
}

/// Fields that the table and the resource have in common.
json limit_json(const CombinationResults& combination, const SearchRequest& search) {
  const Limit& limit = combination.limit;
  json made = json::object();
  for (std::size_t i = 0; i < combination.values.size(); ++i) {
    made[search.common.axes[i].path] = combination.values[i];
  }
  made.update({{"verdict", verdict_name(limit.verdict)}, {"lost_reason", value_or_null(limit.lost_reason)},
               {"limit", value_or_null(limit.within)}, {"limit_beyond", value_or_null(limit.beyond)},
               {"band_from", value_or_null(limit.band_from)}, {"band_to", value_or_null(limit.band_to)},
               {"evaluations", combination.evaluations.size()}, {"monotonic", limit.falls.empty()}});
  return made;
}

json full_limit_json(const CombinationResults& combination, const SearchRequest& search) {
  json made = limit_json(combination, search);
  made["falls"] = json::array();
  for (const Fall& fall : combination.limit.falls) made["falls"].push_back(fall_json(fall));
  std::map<double, json> points;  // in the order of their values
  for (std::size_t i = 0; i < combination.evaluations.size(); ++i) {
    points[combination.evaluations[i].x] =
        evaluation_json(combination.evaluations[i], combination.job_ids[i], search.rule);
  }
  made["points"] = json::array();
  for (auto& [x, point] : points) made["points"].push_back(std::move(point));
  return made;
}

std::vector<std::string> paths_of_axes(const SearchRequest& search) {
  std::vector<std::string> paths;
  for (const Axis& axis : search.common.axes) paths.push_back(axis.path);
  return paths;
}

/// Results of all jobs, with the limits that follow from them. @param search  must outlive them
SearchResults collect_results(const StudyRow& row, const SearchRequest& search, const SweepResults& jobs) {
  SearchResults results(search, jobs.sweep);
  for (const ResultRow& job : jobs.rows) results.add(job);
  const auto common_sweep = common_sweep_of_search(nlohmann::ordered_json::parse(row.request));
  for (std::size_t k = 0; k < results.combinations.size(); ++k)
    results.judge(k, common_sweep);
  return results;
}

}  // namespace

json search_summary_json(const StudyRow& row) {
  const auto request = nlohmann::ordered_json::parse(row.request);
  const auto sweep = request.value("sweep", nlohmann::ordered_json::object());
  json axes = json::array();
  for (const auto& [path, values] : sweep.items()) axes.push_back(path);
  json made = study_json(row, "/v1/searches/");
  made.update({{"parameter", request.at("over").begin().key()}, {"metric", json(request.at("metric"))},
               {"bound", json(request.at("bound"))}, {"axes", std::move(axes)},
               {"quantile", request.value("quantile", LimitRule{}.quantile)}});
  return made;
}

const std::vector<std::string>& search_listing_keys() {
  static const std::vector<std::string> keys = [] {
    StudyRow row;
    row.request = R"({"over": {"clearance_mm": {}}, "metric": "", "bound": 0})";
    return keys_of(search_summary_json(row));
  }();
  return keys;
}

json search_json(const StudyRow& row, const SearchRequest& search, const SweepResults& jobs, int threads) {
  const SearchResults results = collect_results(row, search, jobs);
  json made = search_summary_json(row);
  made["axes"] = paths_of_axes(search);
  made["counts"] = progress_json(jobs.sweep, threads).at("counts");
  made["progress"] = row.state == "running" ? results.calc_progress() : 1.0;
  made["most_evaluations"] = most_evaluations(search.interval) * results.combinations.size();
  made["limits"] = json::array();
  for (const CombinationResults& combination : results.combinations) {
    made["limits"].push_back(full_limit_json(combination, search));
  }
  made["request"] = json::parse(row.request);
  return made;
}

ResultTable limit_table(const StudyRow& row, const SearchRequest& search, const SweepResults& jobs) {
  ResultTable table{.columns = paths_of_axes(search), .rows = {}, .ended = row.state != "running"};
  for (const char* const column :
       {"parameter", "metric", "bound", "quantile", "verdict", "limit", "limit_beyond", "band_from",
        "band_to", "evaluations", "monotonic", "lost_reason"}) {
    table.columns.emplace_back(column);
  }
  const json common{{"parameter", search.parameter}, {"metric", search.metric}, {"bound", search.rule.bound},
                    {"quantile", search.rule.quantile}};
  for (const CombinationResults& combination : collect_results(row, search, jobs).combinations) {
    json flat = limit_json(combination, search);
    flat.update(common);
    std::vector<json> cells;
    for (const std::string& column : table.columns) cells.push_back(flat.at(column));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace jobs
