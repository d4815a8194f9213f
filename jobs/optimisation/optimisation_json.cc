// SPDX-License-Identifier: Apache-2.0
#include "jobs/optimisation/optimisation_json.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "jobs/base/optional_json.h"
#include "jobs/results/resource_json.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr const char* kOptimisationRoute = "/v1/optimisations/";
/// Relative difference of two best values that count as the same.
constexpr double kSameValue = 0.01;

json values_json(const OptimisationRequest& request, const OptimisationCandidate& candidate) {
  json values = json::object();
  for (std::size_t k = 0; k < request.variables.size(); ++k)
    values[request.variables[k].path] = candidate.values[k];
  return values;
}

/// Objectives and bounds of a candidate that has all its values.
json metrics_json(const OptimisationRequest& request, const OptimisationCandidate& candidate) {
  json metrics = json::object();
  for (std::size_t k = 0; k < request.objectives.size(); ++k)
    metrics[request.objectives[k].metric] = objective_of(request, candidate, k);
  for (std::size_t k = 0; k < request.bounds.size(); ++k)
    metrics[column_of(request.bounds[k])] = bound_value_of(request, candidate, k);
  return metrics;
}

json candidate_json(const Optimiser& optimiser, const ListedCandidate& listed) {
  const OptimisationRequest& request = optimiser.request();
  const OptimisationCandidate& candidate = optimiser.candidates()[listed.index];
  return {{"values", values_json(request, candidate)},
          {"metrics", metrics_json(request, candidate)},
          {"start", value_or_null(listed.start)},
          {"job_ids", candidate.job_ids}};
}

bool is_better(const OptimisationRequest& request, double a, double b) {
  return request.objectives.front().goal == Goal::kMinimise ? a < b : a > b;
}

/// Best value of the first objective of a start; empty if it has no feasible candidate.
std::optional<double> best_of_start(const Optimiser& optimiser, std::size_t start) {
  const OptimisationRequest& request = optimiser.request();
  std::optional<double> best;
  for (const OptimisationCandidate& candidate : optimiser.candidates()) {
    if (!optimiser.starts()[start].seen.contains(candidate.values)) continue;
    if (state_of(request, candidate) != CandidateState::kFeasible) continue;
    const double value = objective_of(request, candidate, 0);
    if (!best || is_better(request, value, *best)) best = value;
  }
  return best;
}

std::size_t count_candidates(const Optimiser& optimiser, const StartSearch& start) {
  return static_cast<std::size_t>(
      std::ranges::count_if(optimiser.list_candidates(), [&](const ListedCandidate& one) {
        return start.seen.contains(optimiser.candidates()[one.index].values);
      }));
}

/// @param state  of the study
json starts_json(const Optimiser& optimiser, const std::string& state) {
  const bool single = optimiser.request().objectives.size() == 1;
  json made = json::array();
  for (std::size_t k = 0; k < optimiser.starts().size(); ++k) {
    const StartSearch& start = optimiser.starts()[k];
    const bool stopped = state != "running" && start.end == StartEnd::kRunning;
    made.push_back({{"candidates", count_candidates(optimiser, start)},
                    {"generations", start.search->generations()},
                    {"end", stopped ? "stopped" : end_name(start.end)},
                    {"best", single ? value_or_null(best_of_start(optimiser, k)) : json()}});
  }
  return made;
}

/// Number of starts whose best value is that of the best one; null where there are several objectives.
json repeats_json(const Optimiser& optimiser, const std::vector<ListedCandidate>& front) {
  const OptimisationRequest& request = optimiser.request();
  if (request.objectives.size() > 1 || front.empty()) return nullptr;
  const double best = objective_of(request, optimiser.candidates()[front.front().index], 0);
  std::size_t repeats = 0;
  for (std::size_t k = 0; k < optimiser.starts().size(); ++k) {
    const auto one = best_of_start(optimiser, k);
    if (one && std::abs(*one - best) <= kSameValue * std::abs(best)) ++repeats;
  }
  return repeats;
}

json lost_json(const Optimiser& optimiser) {
  std::map<std::string, std::size_t> counts;
  for (const OptimisationCandidate& one : optimiser.candidates())
    if (one.pending == 0 && one.lost_reason) ++counts[*one.lost_reason];
  return counts;
}

json count_states(const Optimiser& optimiser) {
  const std::vector<ListedCandidate> listed = optimiser.list_candidates();
  json counts = json::object();
  for (const CandidateState state : {CandidateState::kPending, CandidateState::kFeasible,
                                     CandidateState::kInfeasible, CandidateState::kLost}) {
    counts[std::string(state_name(state))] = std::ranges::count_if(listed, [&](const ListedCandidate& one) {
      return state_of(optimiser.request(), optimiser.candidates()[one.index]) == state;
    });
  }
  return counts;
}

}  // namespace

std::string column_of(const MetricBound& bound) {
  return bound.metric + (std::isfinite(bound.maximum) ? "_at_most" : "_at_least");
}

json optimisation_summary_json(const StudyRow& row) {
  const auto request = nlohmann::ordered_json::parse(row.request);
  json variables = json::array();
  for (const auto& [path, span] : request.at("over").items()) variables.push_back(path);
  json made = study_json(row, kOptimisationRoute);
  made.update({{"variables", std::move(variables)}, {"objectives", json(request.at("objectives"))}});
  return made;
}

const std::vector<std::string>& optimisation_listing_keys() {
  static const std::vector<std::string> keys = [] {
    StudyRow row;
    row.request = R"({"over": {}, "objectives": []})";
    return keys_of(optimisation_summary_json(row));
  }();
  return keys;
}

json optimisation_json(const StudyRow& row, const Optimiser& optimiser, const SweepResults& results,
                       int threads) {
  const OptimisationRequest& request = optimiser.request();
  const std::vector<ListedCandidate> front = optimiser.find_front();
  json made = optimisation_summary_json(row);
  made["method"] = method_name(request);
  made["budget"] = request.budget;
  made["population"] = request.local_method ? json() : json(request.population);
  made["counts"] = progress_json(results.sweep, threads).at("counts");
  made["progress"] = row.state == "running" ? optimiser.progress() : 1.0;
  made["candidates"] = count_states(optimiser);
  made["lost_reasons"] = lost_json(optimiser);
  made["starts"] = starts_json(optimiser, row.state);
  made["best_repeats"] = repeats_json(optimiser, front);
  made["front"] = json::array();
  for (const ListedCandidate& listed : front) made["front"].push_back(candidate_json(optimiser, listed));
  made["best"] = request.objectives.size() == 1 && !front.empty() ? made["front"].front() : json();
  made["request"] = json::parse(row.request);
  return made;
}

const std::vector<std::string>& candidate_columns() {
  static const std::vector<std::string> columns{"candidate",   "start",    "state",
                                                "lost_reason", "on_front", "job_id"};
  return columns;
}

namespace {

std::vector<std::string> table_columns(const OptimisationRequest& request) {
  std::vector<std::string> columns = candidate_columns();
  for (const Variable& variable : request.variables) columns.push_back(variable.path);
  for (const Objective& objective : request.objectives) columns.push_back(objective.metric);
  for (const MetricBound& bound : request.bounds) columns.push_back(column_of(bound));
  return columns;
}

/// Objectives and bounds of a candidate; null unless it has all its values.
void add_metric_cells(const OptimisationRequest& request, const OptimisationCandidate& candidate,
                      CandidateState state, std::vector<json>& cells) {
  const bool has_values = state == CandidateState::kFeasible || state == CandidateState::kInfeasible;
  for (std::size_t i = 0; i < request.objectives.size(); ++i)
    cells.push_back(has_values ? json(objective_of(request, candidate, i)) : json());
  for (std::size_t i = 0; i < request.bounds.size(); ++i)
    cells.push_back(has_values ? json(bound_value_of(request, candidate, i)) : json());
}

/// @param number  of the row
std::vector<json> candidate_cells(const Optimiser& optimiser, const ListedCandidate& listed,
                                  std::size_t number, bool is_on_front) {
  const OptimisationCandidate& candidate = optimiser.candidates()[listed.index];
  const CandidateState state = state_of(optimiser.request(), candidate);
  std::vector<json> cells{number,
                          value_or_null(listed.start),
                          state_name(state),
                          state == CandidateState::kLost ? value_or_null(candidate.lost_reason) : json(),
                          is_on_front,
                          candidate.job_ids.empty() ? json() : json(candidate.job_ids.front())};
  cells.insert(cells.end(), candidate.values.begin(), candidate.values.end());
  add_metric_cells(optimiser.request(), candidate, state, cells);
  return cells;
}

}  // namespace

ResultTable candidate_table(const StudyRow& row, const Optimiser& optimiser) {
  ResultTable table{
      .columns = table_columns(optimiser.request()), .rows = {}, .ended = row.state != "running"};
  std::set<std::size_t> front;
  for (const ListedCandidate& listed : optimiser.find_front()) front.insert(listed.index);
  for (const ListedCandidate& listed : optimiser.list_candidates())
    table.rows.push_back(
        candidate_cells(optimiser, listed, table.rows.size(), front.contains(listed.index)));
  return table;
}

}  // namespace jobs
