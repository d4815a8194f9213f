// SPDX-License-Identifier: Apache-2.0
#include "jobs/search/search_results.h"

#include <algorithm>

#include "jobs/base/errors.h"
#include "jobs/requests/axis.h"
#include "jobs/requests/expand.h"
#include "jobs/results/resource_json.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

std::size_t index_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
}

/// Index of the evaluation at x, which is added if there is none.
std::size_t evaluation_at(double x, CombinationResults& combination) {
  auto& known = combination.evaluations;
  const auto found = std::ranges::find(known, x, &Evaluation::x);
  if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
  known.push_back({.x = x, .values = {}});
  combination.job_ids.emplace_back();
  return known.size() - 1;
}

bool is_pending(const ResultRow& job) { return job.state == "queued" || job.state == "running"; }

/// Reason for a job without value: the metric does not apply, the job's error, or its state "cancelled".
std::string lost_reason_of(const ResultRow& job) {
  return job.state == "succeeded" ? std::string(kNoValue) : job.error_reason.value_or(job.state);
}

json metric_of(const ResultRow& job, const std::string& metric) {
  return job.metrics ? stored_json(*job.metrics).value(metric, json()) : json();
}

}  // namespace

SearchResults::SearchResults(const SearchRequest& search, const SweepRow& sweep) : search_(search) {
  const std::vector<std::string> swept = swept_of(sweep);
  parameter_ = index_of(swept, search.parameter);
  for (const Axis& axis : search.common.axes) axes_.push_back(index_of(swept, axis.path));
  for (auto& values : combinations_of(search)) {
    std::string name;
    for (std::size_t i = 0; i < values.size(); ++i) {
      name += value_identity(search.common.axes[i].path, values[i]) + ' ';
    }
    combination_indices_.emplace(name, combinations.size());
    combinations.push_back({.values = std::move(values), .evaluations = {}, .job_ids = {}, .limit = {}});
  }
}

std::optional<std::size_t> SearchResults::add(const ResultRow& job) {
  const auto position = find_position(job);
  if (!position) return std::nullopt;
  CombinationResults& combination = combinations[position->combination];
  combination.job_ids[position->evaluation].push_back(job.job_id);
  if (is_pending(job)) {
    ++combination.pending;
    ++combination.evaluations[position->evaluation].pending;
  } else {
    add_result(job, *position);
  }
  return position->combination;
}

std::optional<std::size_t> SearchResults::end(const ResultRow& job) {
  const auto position = find_position(job);
  if (!position) return std::nullopt;
  CombinationResults& combination = combinations[position->combination];
  --combination.pending;
  --combination.evaluations[position->evaluation].pending;
  add_result(job, *position);
  return position->combination;
}

std::vector<std::size_t> SearchResults::judge(std::size_t index, const ordered_json& common_sweep) {
  CombinationResults& combination = combinations[index];
  while (true) {
    combination.limit = find_limit(search_.interval, search_.rule, combination.evaluations);
    if (cancelled) return {};
    std::vector<std::size_t> jobs;
    for (const double x : combination.limit.next) {
      jobs.push_back(count_jobs(combination, x, common_sweep));
      if (jobs.back() > 0) continue;
      Evaluation& evaluation = combination.evaluations[evaluation_at(x, combination)];
      evaluation.lost = 1;
      evaluation.lost_reason = std::string(kInvalidParameters);
    }
    if (std::ranges::find(jobs, std::size_t{0}) == jobs.end()) return jobs;
  }
}

std::size_t SearchResults::count_jobs(const CombinationResults& combination, double x,
                                      const ordered_json& common_sweep) const {
  try {
    return plan_cases(common_sweep, ordered_json::array({case_at(search_, combination.values, x)})).size();
  } catch (const InvalidRequest&) {  // two values may be valid and one between them not
    return 0;
  }
}

void SearchResults::expect(std::size_t index, double x, std::size_t jobs) {
  CombinationResults& combination = combinations[index];
  combination.evaluations[evaluation_at(x, combination)].pending += jobs;
  combination.pending += jobs;
}

bool SearchResults::any_pending() const {
  return std::ranges::any_of(combinations, [](const CombinationResults& one) { return one.pending > 0; });
}

std::string SearchResults::end_state() const {
  if (cancelled) return "cancelled";
  const auto is_lost = [](const CombinationResults& one) { return one.limit.verdict == Verdict::kLost; };
  return std::ranges::any_of(combinations, is_lost) ? "failed" : "succeeded";
}

double SearchResults::calc_progress() const {
  double sum = 0.0;
  const auto most = static_cast<double>(most_evaluations(search_.interval));
  for (const CombinationResults& combination : combinations) {
    const auto done = std::ranges::count(combination.evaluations, std::size_t{0}, &Evaluation::pending);
    sum +=
        combination.limit.verdict == Verdict::kOpen ? std::min(1.0, static_cast<double>(done) / most) : 1.0;
  }
  return sum / static_cast<double>(combinations.size());
}

std::optional<SearchResults::Position> SearchResults::find_position(const ResultRow& job) {
  const json swept = stored_json(job.swept);
  std::string name;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    name += value_identity(search_.common.axes[i].path, swept.at(axes_[i])) + ' ';
  }
  const auto found = combination_indices_.find(name);
  if (found == combination_indices_.end()) return std::nullopt;
  return Position{
      .combination = found->second,
      .evaluation = evaluation_at(swept.at(parameter_).get<double>(), combinations[found->second])};
}

void SearchResults::add_result(const ResultRow& job, const Position& position) {
  CombinationResults& combination = combinations[position.combination];
  Evaluation& evaluation = combination.evaluations[position.evaluation];
  cancelled |= job.state == "cancelled";
  const json value = metric_of(job, search_.metric);
  if (value.is_number()) evaluation.values.push_back(value.get<double>());
  else if (++evaluation.lost == 1) evaluation.lost_reason = lost_reason_of(job);
}

}  // namespace jobs
