// SPDX-License-Identifier: Apache-2.0
#include "jobs/optimisation/optimisation_json.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

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

json candidate_json(const OptimisationRequest& request, const OptimisationCandidate& candidate) {
  return {{"values", values_json(request, candidate)},
          {"metrics", metrics_json(request, candidate)},
          {"start", candidate.start},
          {"job_ids", candidate.job_ids}};
}

bool is_better(const OptimisationRequest& request, double a, double b) {
  return request.objectives.front().goal == Goal::kMinimise ? a < b : a > b;
}

/// Best value of the first objective of each start; empty where it has no feasible candidate.
std::vector<std::optional<double>> best_of_starts(const Optimiser& optimiser) {
  const OptimisationRequest& request = optimiser.request();
  std::vector<std::optional<double>> best(optimiser.starts().size());
  for (const OptimisationCandidate& candidate : optimiser.candidates()) {
    if (state_of(request, candidate) != CandidateState::kFeasible) continue;
    const double value = objective_of(request, candidate, 0);
    std::optional<double>& of_start = best[candidate.start];
    if (!of_start || is_better(request, value, *of_start)) of_start = value;
  }
  return best;
}

json starts_json(const Optimiser& optimiser) {
  const bool single = optimiser.request().objectives.size() == 1;
  const auto best = best_of_starts(optimiser);
  json made = json::array();
  for (std::size_t k = 0; k < best.size(); ++k) {
    const StartSearch& start = optimiser.starts()[k];
    made.push_back({{"candidates", start.seen.size()},
                    {"generations", start.search.generations()},
                    {"end", end_name(start.end)},
                    {"best", single ? value_or_null(best[k]) : json()}});
  }
  return made;
}

/// Number of starts whose best value is that of the best one; null where there are several objectives.
json repeats_json(const Optimiser& optimiser, const std::vector<std::size_t>& front) {
  const OptimisationRequest& request = optimiser.request();
  if (request.objectives.size() > 1 || front.empty()) return nullptr;
  const double best = objective_of(request, optimiser.candidates()[front.front()], 0);
  return std::ranges::count_if(best_of_starts(optimiser), [&](const std::optional<double>& one) {
    return one && std::abs(*one - best) <= kSameValue * std::abs(best);
  });
}

json lost_json(const Optimiser& optimiser) {
  std::map<std::string, std::size_t> counts;
  for (const OptimisationCandidate& one : optimiser.candidates())
    if (one.pending == 0 && one.lost_reason) ++counts[*one.lost_reason];
  return counts;
}

json count_states(const Optimiser& optimiser) {
  json counts = json::object();
  for (const CandidateState state : {CandidateState::kPending, CandidateState::kFeasible,
                                     CandidateState::kInfeasible, CandidateState::kLost}) {
    counts[std::string(state_name(state))] = std::ranges::count_if(
        optimiser.candidates(),
        [&](const OptimisationCandidate& one) { return state_of(optimiser.request(), one) == state; });
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
  const std::vector<std::size_t> front = optimiser.find_front();
  json made = optimisation_summary_json(row);
  made["method"] = request.method == PopulationMethod::kCmaEs ? "cma_es" : "nsga2";
  made["budget"] = request.budget;
  made["population"] = request.population;
  made["counts"] = progress_json(results.sweep, threads).at("counts");
  made["progress"] = row.state == "running" ? optimiser.progress() : 1.0;
  made["candidates"] = count_states(optimiser);
  made["lost_reasons"] = lost_json(optimiser);
  made["starts"] = starts_json(optimiser);
  made["best_repeats"] = repeats_json(optimiser, front);
  made["front"] = json::array();
  for (const std::size_t k : front)
    made["front"].push_back(candidate_json(request, optimiser.candidates()[k]));
  made["best"] = request.objectives.size() == 1 && !front.empty() ? made["front"].front() : json();
  made["request"] = json::parse(row.request);
  return made;
}

const std::vector<std::string>& candidate_columns() {
  static const std::vector<std::string> columns{"candidate",   "start",    "state",
                                                "lost_reason", "on_front", "job_id"};
  return columns;
}

ResultTable candidate_table(const StudyRow& row, const Optimiser& optimiser) {
  const OptimisationRequest& request = optimiser.request();
  ResultTable table{.columns = candidate_columns(), .rows = {}, .ended = row.state != "running"};
  for (const Variable& variable : request.variables) table.columns.push_back(variable.path);
  for (const Objective& objective : request.objectives) table.columns.push_back(objective.metric);
  for (const MetricBound& bound : request.bounds) table.columns.push_back(column_of(bound));
  const std::vector<std::size_t> front = optimiser.find_front();
  for (std::size_t k = 0; k < optimiser.candidates().size(); ++k) {
    const OptimisationCandidate& candidate = optimiser.candidates()[k];
    const CandidateState state = state_of(request, candidate);
    std::vector<json> cells{k,
                            candidate.start,
                            state_name(state),
                            state == CandidateState::kLost ? value_or_null(candidate.lost_reason) : json(),
                            std::ranges::find(front, k) != front.end(),
                            candidate.job_ids.empty() ? json() : json(candidate.job_ids.front())};
    cells.insert(cells.end(), candidate.values.begin(), candidate.values.end());
    const bool has_values = state == CandidateState::kFeasible || state == CandidateState::kInfeasible;
    for (std::size_t i = 0; i < request.objectives.size(); ++i)
      cells.push_back(has_values ? json(objective_of(request, candidate, i)) : json());
    for (std::size_t i = 0; i < request.bounds.size(); ++i)
      cells.push_back(has_values ? json(bound_value_of(request, candidate, i)) : json());
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace jobs
