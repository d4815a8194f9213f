// SPDX-License-Identifier: Apache-2.0
#include "jobs/search/search_tally.h"

#include <algorithm>

#include "jobs/requests/axis.h"
#include "jobs/results/resource_json.h"

namespace jobs {
namespace {

using nlohmann::json;

std::size_t index_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
}

/// The evaluation of a combination at a value of the parameter; it is made if there is none yet.
std::size_t place_of(double x, CombinationPicture& combination) {
  auto& known = combination.evaluations;
  const auto found = std::ranges::find(known, x, &Evaluation::x);
  if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
  known.push_back({.x = x, .values = {}});
  combination.job_ids.emplace_back();
  return known.size() - 1;
}

bool is_pending(const ResultRow& job) { return job.state == "queued" || job.state == "running"; }

/// What a job that has no value failed by, or that it was cancelled, or that it succeeded and the metric does not apply to it.
std::string loss_of(const ResultRow& job) {
  return job.state == "succeeded" ? std::string(kNoValue) : job.error_reason.value_or(job.state);
}

json metric_of(const ResultRow& job, const std::string& metric) {
  return job.metrics ? stored_json(*job.metrics).value(metric, json()) : json();
}

}  // namespace

std::string SearchPicture::end_state() const {
  if (std::ranges::any_of(combinations, &CombinationPicture::cancelled)) return "cancelled";
  const bool lost = std::ranges::any_of(combinations, [](const CombinationPicture& one) { return one.limit.verdict == Verdict::kLost; });
  return lost ? "failed" : "succeeded";
}

double calc_progress(const SearchPicture& picture, const SearchRequest& search) {
  double sum = 0.0;
  const auto most = static_cast<double>(most_evaluations(search.path));
  for (const CombinationPicture& combination : picture.combinations) {
    const auto done = std::ranges::count(combination.evaluations, std::size_t{0}, &Evaluation::pending);
    sum += combination.limit.verdict == Verdict::kOpen ? std::min(1.0, static_cast<double>(done) / most) : 1.0;
  }
  return sum / static_cast<double>(picture.combinations.size());
}

SearchTally::SearchTally(const SearchRequest& search, const SweepRow& sweep) : search_(search) {
  const std::vector<std::string> swept = swept_of(sweep);
  parameter_ = index_of(swept, search.parameter);
  for (const Axis& axis : search.common.axes) axes_.push_back(index_of(swept, axis.path));
  for (auto& values : combinations_of(search)) {
    std::string name;
    for (std::size_t i = 0; i < values.size(); ++i) name += value_identity(search.common.axes[i].path, values[i]) + ' ';
    combinations_.emplace(name, picture.combinations.size());
    picture.combinations.push_back({.values = std::move(values), .evaluations = {}, .job_ids = {}, .limit = {}});
  }
}

std::optional<std::size_t> SearchTally::add(const ResultRow& job) {
  const auto place = find_place(job);
  if (!place) return std::nullopt;
  CombinationPicture& combination = picture.combinations[place->combination];
  combination.job_ids[place->evaluation].push_back(job.job_id);
  if (is_pending(job)) {
    ++combination.pending;
    ++combination.evaluations[place->evaluation].pending;
  } else {
    take_result(job, *place);
  }
  return place->combination;
}

std::optional<std::size_t> SearchTally::end(const ResultRow& job) {
  const auto place = find_place(job);
  if (!place) return std::nullopt;
  CombinationPicture& combination = picture.combinations[place->combination];
  --combination.pending;
  --combination.evaluations[place->evaluation].pending;
  take_result(job, *place);
  return place->combination;
}

void SearchTally::expect(std::size_t index, double x) {
  CombinationPicture& combination = picture.combinations[index];
  combination.evaluations[place_of(x, combination)].pending += search_.common.replicates.count;
  combination.pending += search_.common.replicates.count;
}

std::optional<SearchTally::Place> SearchTally::find_place(const ResultRow& job) {
  const json swept = stored_json(job.swept);
  std::string name;
  for (std::size_t i = 0; i < axes_.size(); ++i) name += value_identity(search_.common.axes[i].path, swept.at(axes_[i])) + ' ';
  const auto found = combinations_.find(name);
  if (found == combinations_.end()) return std::nullopt;
  return Place{.combination = found->second, .evaluation = place_of(swept.at(parameter_).get<double>(), picture.combinations[found->second])};
}

void SearchTally::take_result(const ResultRow& job, const Place& place) {
  CombinationPicture& combination = picture.combinations[place.combination];
  Evaluation& evaluation = combination.evaluations[place.evaluation];
  combination.cancelled |= job.state == "cancelled";
  const json value = metric_of(job, search_.metric);
  if (value.is_number()) evaluation.values.push_back(value.get<double>());
  else if (++evaluation.lost == 1) evaluation.lost_reason = loss_of(job);
}

}  // namespace jobs
