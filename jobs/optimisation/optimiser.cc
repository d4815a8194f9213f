// SPDX-License-Identifier: Apache-2.0
#include "jobs/optimisation/optimiser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "jobs/requests/expand.h"
#include "jobs/results/resource_json.h"
#include "jobs/search/limit.h"
#include "jobs/search/search_results.h"
#include "jobs/statistics/unit_points.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

// Candidates that are not feasible have a worse fitness than all that are, those without a value the worst.
constexpr double kInfeasibleFitness = 1e100;  ///< times the violation
constexpr double kLostFitness = 1e200;
constexpr double kLeastViolation = 1e-15;
constexpr double kMostViolation = 1e50;

/// Excess of a candidate over its bounds, relative to them; 0: all bounds are kept.
double calc_violation(const OptimisationRequest& request, const OptimisationCandidate& candidate) {
  double sum = 0.0;
  for (std::size_t k = 0; k < request.bounds.size(); ++k) {
    const MetricBound& bound = request.bounds[k];
    const double value = bound_value_of(request, candidate, k);
    const double excess = std::max({0.0, value - bound.maximum, bound.minimum - value});
    const double limit = std::isfinite(bound.maximum) ? bound.maximum : bound.minimum;
    sum += excess / (limit == 0.0 ? 1.0 : std::abs(limit));
  }
  return sum;
}

/// Objectives as they are minimised.
std::vector<double> minimised_of(const OptimisationRequest& request, const OptimisationCandidate& candidate) {
  std::vector<double> values;
  for (std::size_t k = 0; k < request.objectives.size(); ++k) {
    const double value = objective_of(request, candidate, k);
    values.push_back(request.objectives[k].goal == Goal::kMinimise ? value : -value);
  }
  return values;
}

/// Pareto dominance: nowhere worse, and somewhere better.
bool dominates(const std::vector<double>& a, const std::vector<double>& b) {
  bool better = false;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (a[k] > b[k]) return false;
    better |= a[k] < b[k];
  }
  return better;
}

/// Removes what a candidate dominates from a front. @param values  of the front
void remove_dominated(const std::vector<double>& one, std::vector<ListedCandidate>& front,
                      std::vector<std::vector<double>>& values) {
  for (std::size_t i = front.size(); i-- > 0;) {
    if (!dominates(one, values[i])) continue;
    front.erase(front.begin() + static_cast<std::ptrdiff_t>(i));
    values.erase(values.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

std::unique_ptr<PointSearch> make_population_search(const OptimisationRequest& request, std::size_t start) {
  return std::make_unique<PopulationSearch>(
      PopulationOptions{.method = request.method,
                        .dimensions = request.variables.size(),
                        .objectives = request.objectives.size(),
                        .population = request.population,
                        .seed = static_cast<unsigned>(request.seed + start),
                        .start = start == 0 ? start_of(request) : std::nullopt});
}

/// The first search begins at the variables' starts, in the middle of the spans if there are none; the others
/// fill the space.
std::vector<StartSearch> make_starts(const OptimisationRequest& request) {
  const std::size_t n = request.variables.size();
  UnitPoints points = sobol_points(request.starts, n, request.seed);
  points.front() = start_of(request).value_or(UnitPoint(n, 0.5));
  std::vector<StartSearch> starts;
  for (std::size_t k = 0; k < request.starts; ++k) {
    StartSearch& start = starts.emplace_back();
    if (request.local_method)
      start.search = std::make_unique<LocalSearch>(
          LocalOptions{.method = *request.local_method, .start = points[k], .seed = request.seed + k});
    else start.search = make_population_search(request, k);
  }
  return starts;
}

/// Value that this part of the values reaches: at most, or at least where large values are good.
double calc_level(std::vector<double> values, double part, bool large_is_good) {
  if (!large_is_good) return calc_quantile(std::move(values), part);
  for (double& value : values) value = -value;
  return -calc_quantile(std::move(values), part);
}

}  // namespace

double objective_of(const OptimisationRequest& request, const OptimisationCandidate& candidate,
                    std::size_t objective) {
  const Objective& of = request.objectives[objective];
  return calc_level(candidate.metrics[objective], of.quantile, of.goal == Goal::kMaximise);
}

double bound_value_of(const OptimisationRequest& request, const OptimisationCandidate& candidate,
                      std::size_t bound) {
  const MetricBound& of = request.bounds[bound];
  return calc_level(candidate.metrics[request.objectives.size() + bound], of.quantile,
                    std::isinf(of.maximum));
}

std::string_view state_name(CandidateState state) {
  constexpr std::array<std::string_view, 4> kNames{"pending", "feasible", "infeasible", "lost"};
  return kNames[static_cast<std::size_t>(state)];
}

CandidateState state_of(const OptimisationRequest& request, const OptimisationCandidate& candidate) {
  if (candidate.pending > 0) return CandidateState::kPending;
  if (candidate.lost_reason) return CandidateState::kLost;
  return calc_violation(request, candidate) > 0.0 ? CandidateState::kInfeasible : CandidateState::kFeasible;
}

std::string_view end_name(StartEnd end) {
  constexpr std::array<std::string_view, 3> kNames{"running", "converged", "budget"};
  return kNames[static_cast<std::size_t>(end)];
}

Optimiser::Optimiser(OptimisationRequest request, const ordered_json& common_sweep,
                     const SweepResults* results)
    : request_(std::move(request)), common_sweep_(common_sweep), starts_(make_starts(request_)) {
  if (results == nullptr) return;
  const std::vector<std::string> swept = swept_of(results->sweep);
  for (const Variable& variable : request_.variables) {
    const auto found = std::ranges::find(swept, variable.path);
    positions_.push_back(static_cast<std::size_t>(found - swept.begin()));
  }
  for (const ResultRow& job : results->rows) {
    OptimisationCandidate& candidate = candidate_of(job);
    candidate.job_ids.push_back(job.job_id);
    if (job.state == "queued" || job.state == "running") ++candidate.pending;
    else take_result(job, candidate);
  }
  made_ = candidates_.size();
}

void Optimiser::tell(const ResultRow& ended) {
  OptimisationCandidate& candidate = candidate_of(ended);
  if (std::ranges::find(candidate.job_ids, ended.job_id) == candidate.job_ids.end())
    candidate.job_ids.push_back(ended.job_id);
  if (candidate.pending > 0) --candidate.pending;
  take_result(ended, candidate);
}

NextCases Optimiser::ask() {
  NextCases next;
  for (StartSearch& start : starts_) ask_start(start, next);
  if (cancelled_) next.cases.clear();  // the starts were only followed as far as the results go
  else made_ = candidates_.size();
  const auto is_pending = [](const OptimisationCandidate& one) { return one.pending > 0; };
  const bool waits = std::ranges::any_of(std::span(candidates_).first(made_), is_pending);
  if (next.cases.empty() && !waits) end_study(next);
  return next;
}

double Optimiser::progress() const {
  double sum = 0.0;
  const double share = static_cast<double>(request_.budget) / static_cast<double>(starts_.size());
  for (const StartSearch& start : starts_) {
    const auto ended = std::ranges::count_if(start.in_order, [this](const std::vector<double>& values) {
      const auto known = indices_.find(values);
      return known != indices_.end() && candidates_[known->second].pending == 0;
    });
    sum += start.end == StartEnd::kRunning ? std::min(1.0, static_cast<double>(ended) / share) : 1.0;
  }
  return sum / static_cast<double>(starts_.size());
}

std::vector<ListedCandidate> Optimiser::list_candidates() const {
  std::vector<ListedCandidate> listed;
  std::vector<bool> is_listed(candidates_.size(), false);
  const auto list = [&](std::size_t index, std::optional<std::size_t> start) {
    const bool is_made = candidates_[index].pending == 0 || !candidates_[index].job_ids.empty();
    if (is_made && !is_listed[index]) listed.push_back({.index = index, .start = start});
    is_listed[index] = true;
  };
  for (std::size_t k = 0; k < starts_.size(); ++k) {
    for (const std::vector<double>& values : starts_[k].in_order) {
      if (const auto known = indices_.find(values); known != indices_.end()) list(known->second, k);
    }
  }
  for (std::size_t index = 0; index < candidates_.size(); ++index) list(index, std::nullopt);
  return listed;
}

std::vector<ListedCandidate> Optimiser::find_front() const {
  std::vector<ListedCandidate> front;
  std::vector<std::vector<double>> values;  // of the front
  for (const ListedCandidate& listed : list_candidates()) {
    const OptimisationCandidate& candidate = candidates_[listed.index];
    if (state_of(request_, candidate) != CandidateState::kFeasible) continue;
    const std::vector<double> one = minimised_of(request_, candidate);
    const auto is_as_good = [&](const auto& other) { return other == one || dominates(other, one); };
    if (std::ranges::any_of(values, is_as_good)) continue;
    remove_dominated(one, front, values);
    front.push_back(listed);
    values.push_back(one);
  }
  return front;
}

std::size_t Optimiser::index_of(const std::vector<double>& values) {
  const auto [known, is_new] = indices_.try_emplace(values, candidates_.size());
  if (is_new) {
    candidates_.push_back({.values = values});
    candidates_.back().metrics.resize(request_.objectives.size() + request_.bounds.size());
  }
  return known->second;
}

OptimisationCandidate& Optimiser::candidate_of(const ResultRow& job) {
  const json swept = stored_json(job.swept);
  std::vector<double> values;
  for (const std::size_t position : positions_) values.push_back(swept.at(position).get<double>());
  return candidates_[index_of(values)];
}

void Optimiser::take_result(const ResultRow& job, OptimisationCandidate& candidate) {
  cancelled_ |= job.state == "cancelled";
  if (job.state != "succeeded") {
    candidate.lost_reason = job.error_reason.value_or(job.state);
    return;
  }
  const json metrics = job.metrics ? stored_json(*job.metrics) : json::object();
  const auto take = [&](const std::string& metric, std::vector<double>& values) {
    const json value = metrics.value(metric, json());
    if (value.is_number()) values.push_back(value.get<double>());
    else candidate.lost_reason = std::string(kNoValue);
  };
  std::size_t k = 0;
  for (const Objective& objective : request_.objectives) take(objective.metric, candidate.metrics[k++]);
  for (const MetricBound& bound : request_.bounds) take(bound.metric, candidate.metrics[k++]);
}

std::optional<std::vector<double>> Optimiser::find_fitness(const std::vector<double>& values) const {
  const auto known = indices_.find(values);
  if (known == indices_.end()) return std::nullopt;
  const OptimisationCandidate& candidate = candidates_[known->second];
  const std::size_t n = request_.objectives.size();
  switch (state_of(request_, candidate)) {
    case CandidateState::kPending:
      return std::nullopt;
    case CandidateState::kFeasible:
      return minimised_of(request_, candidate);
    case CandidateState::kInfeasible:
      return std::vector<double>(n, kInfeasibleFitness * std::clamp(calc_violation(request_, candidate),
                                                                    kLeastViolation, kMostViolation));
    case CandidateState::kLost:
      break;
  }
  return std::vector<double>(n, kLostFitness);
}

void Optimiser::ask_start(StartSearch& start, NextCases& next) {
  while (start.end == StartEnd::kRunning) {
    bool waits = false;
    for (const UnitPoint& point : ask_search(start))
      waits |= add_candidate(candidate_at(request_, point), next);
    if (waits) return;
  }
}

std::vector<UnitPoint> Optimiser::ask_search(StartSearch& start) const {
  const std::size_t share = request_.budget / starts_.size();
  auto missing = start.search->ask([&](const UnitPoint& point) {
    const std::vector<double> values = candidate_at(request_, point);
    if (start.seen.insert(values).second) start.in_order.push_back(values);
    return find_fitness(values);
  });
  if (missing.empty()) start.end = StartEnd::kConverged;
  else if (start.seen.size() > share) start.end = StartEnd::kBudget;
  if (start.end != StartEnd::kRunning) missing.clear();
  return missing;
}

bool Optimiser::add_candidate(const std::vector<double>& values, NextCases& next) {
  const bool is_new = !indices_.contains(values);
  OptimisationCandidate& candidate = candidates_[index_of(values)];
  if (is_new) {
    ordered_json one_case = case_of(request_, values);
    candidate.pending = count_jobs(one_case);
    if (candidate.pending > 0) next.cases.push_back(std::move(one_case));
    else candidate.lost_reason = std::string(kInvalidParameters);
  }
  return candidate.pending > 0;
}

std::size_t Optimiser::count_jobs(const ordered_json& one_case) {
  try {
    return plan_cases(common_sweep_, ordered_json::array({one_case})).size();
  } catch (const InvalidRequest& invalid) {
    if (!first_invalid_) first_invalid_ = invalid;
    return 0;
  }
}

void Optimiser::end_study(NextCases& next) const {
  const auto is_lost = [](const OptimisationCandidate& one) { return one.lost_reason.has_value(); };
  if (cancelled_) {
    next.end_state = "cancelled";
  } else if (std::ranges::all_of(candidates_, is_lost)) {
    next.end_state = "failed";
    next.error = "no candidate has all its values; the first has none because of " +
                 candidates_.front().lost_reason.value_or("");
  } else {
    next.end_state = "succeeded";
  }
}

}  // namespace jobs
