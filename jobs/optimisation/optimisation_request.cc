// SPDX-License-Identifier: Apache-2.0
#include "jobs/optimisation/optimisation_request.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "jobs/parameters/parameter_value.h"
#include "jobs/parameters/unit_scale.h"
#include "jobs/requests/axis.h"
#include "jobs/requests/metric_keys.h"
#include "jobs/requests/parameter_path.h"
#include "jobs/requests/request_parser.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// Keys that an optimisation has in common with the sweep of its jobs.
constexpr std::array<std::string_view, 7> kCommonKeys{"name",  "parameters", "sweep",   "replicates",
                                                      "reuse", "priority",   "executor"};

/// Reader of one request; a member function a part of it.
class OptimisationParser : private RequestParser {
 public:
  OptimisationParser(const ordered_json& request, std::size_t max_jobs)
      : RequestParser(request), max_jobs_(max_jobs) {}

  OptimisationRequest parse() {
    check_keys();
    read_common();
    read_variables();
    read_objectives();
    read_bounds();
    read_method();
    read_numbers();
    check_size();
    throw_if_faulty();
    return std::move(made_);
  }

 private:
  void check_keys() { check_keys_of(json(request_), "", kOptimisationRequestKeys); }

  void read_common() {
    try {
      made_.common = parse_sweep_request(take_keys(request_, kCommonKeys), max_jobs_);
      metrics_ = metric_keys_of(take_keys(request_, kPartsWithMetrics));
    } catch (const InvalidRequest& invalid) {
      add_faults(invalid);
    }
  }

  void read_variables() {
    if (!request_.contains("over") || !request_.at("over").is_object() || request_.at("over").empty())
      return fault("/over",
                   "must be an object of parameters, {\"rod_length_m\": {\"from\": 0.1, \"to\": 0.3}}, say");
    if (request_.at("over").size() > kMostVariables)
      return fault("/over", "has more than " + std::to_string(kMostVariables) + " parameters");
    for (const auto& [path, span] : request_.at("over").items()) {
      const std::string pointer = "/over" + pointer_token(path);
      if (auto variable = read_variable(path, json(span), pointer, request_, made_.common, faults_))
        made_.variables.push_back(std::move(*variable));
    }
  }

  void read_objectives() {
    const json given = request_.value("objectives", ordered_json());
    if (!given.is_array() || given.empty() || given.size() > kMostObjectives)
      return fault("/objectives", "must be a list of 1 to " + std::to_string(kMostObjectives) +
                                      " objects, {\"metric\": \"peak_slider_acceleration_m_s2\", \"goal\": "
                                      "\"minimise\"}, say");
    for (std::size_t k = 0; k < given.size(); ++k)
      read_objective(given[k], "/objectives/" + std::to_string(k));
    if (made_.objectives.size() > 1) made_.method = PopulationMethod::kNsga2;
  }

  void read_objective(const json& given, const std::string& pointer) {
    const std::size_t before = faults_.size();
    constexpr std::array<std::string_view, 3> kKeys{"metric", "goal", "quantile"};
    Objective objective{.metric = read_metric(given, pointer, kKeys)};
    if (faults_.size() > before) return;
    const auto& others = made_.objectives;
    if (std::ranges::find(others, objective.metric, &Objective::metric) != others.end())
      fault(pointer + "/metric", "is an objective already");
    const json goal = given.value("goal", json("minimise"));
    if (goal != "minimise" && goal != "maximise")
      fault(pointer + "/goal", "must be \"minimise\" or \"maximise\"");
    objective.goal = goal == "maximise" ? Goal::kMaximise : Goal::kMinimise;
    objective.quantile = read_quantile(given, pointer);
    made_.objectives.push_back(std::move(objective));
  }

  void read_method() {
    if (!request_.contains("method")) return;
    const json given = request_.at("method");
    const bool single = made_.objectives.size() <= 1;
    if (single && given == "nelder_mead") made_.local_method = LocalMethod::kNelderMead;
    else if (single && given == "bobyqa") made_.local_method = LocalMethod::kBobyqa;
    else if (given != (single ? "cma_es" : "nsga2"))
      return fault("/method",
                   single ? "must be \"cma_es\", \"nelder_mead\" or \"bobyqa\", as there is one objective"
                          : "must be \"nsga2\", as there are several objectives");
    if (made_.local_method) check_local_method();
  }

  void check_local_method() {
    for (const Variable& variable : made_.variables)
      if (variable.integer)
        fault("/method", "must be \"cma_es\", as " + variable.path + " has whole numbers only");
    if (request_.contains("population"))
      fault("/population", "belongs to cma_es and nsga2: the others try one candidate after the other");
    if (made_.local_method != LocalMethod::kBobyqa) return;
    if (!made_.bounds.empty())
      fault("/method", "must be another one with bounds, across which the objective is not smooth");
    if (made_.variables.size() == 1)
      fault("/method", "must be another one with a single variable, \"nelder_mead\", say");
  }

  template <std::size_t n>
  std::string read_metric(const json& given, const std::string& pointer,
                          const std::array<std::string_view, n>& keys) {
    if (!given.is_object()) {
      fault(pointer, "must be an object with \"metric\"");
      return {};
    }
    check_keys_of(given, pointer, keys);
    const json metric = given.value("metric", json());
    if (!is_right(pointer + "/metric", describe_metric_fault(metric, metrics_))) return {};
    return metric.get<std::string>();
  }

  double read_quantile(const json& given, const std::string& pointer) {
    if (!given.contains("quantile")) return kAll;
    constexpr Range kQuantile{.minimum = 0.0, .maximum = 1.0};
    const bool right =
        is_right(pointer + "/quantile", describe_number_fault(kQuantile, "", given.at("quantile")));
    return right ? given.at("quantile").get<double>() : kAll;
  }

  void read_bounds() {
    if (!request_.contains("bounds")) return;
    const json given = request_.at("bounds");
    if (!given.is_array())
      return fault(
          "/bounds",
          "must be a list of objects, {\"metric\": \"peak_contact_force_n\", \"maximum\": 500}, say");
    for (std::size_t k = 0; k < given.size(); ++k) read_bound(given[k], "/bounds/" + std::to_string(k));
  }

  void read_bound(const json& given, const std::string& pointer) {
    const std::size_t before = faults_.size();
    constexpr std::array<std::string_view, 4> kKeys{"metric", "minimum", "maximum", "quantile"};
    MetricBound bound{.metric = read_metric(given, pointer, kKeys)};
    if (faults_.size() == before) read_limit(given, pointer, bound);
    if (faults_.size() > before) return;
    const auto is_same = [&](const MetricBound& other) {
      return other.metric == bound.metric && std::isfinite(other.maximum) == std::isfinite(bound.maximum);
    };
    if (std::ranges::any_of(made_.bounds, is_same))
      fault(pointer, "bounds the metric on that side, as another one does");
    bound.quantile = read_quantile(given, pointer);
    made_.bounds.push_back(std::move(bound));
  }

  void read_limit(const json& given, const std::string& pointer, MetricBound& bound) {
    if (given.contains("minimum") == given.contains("maximum"))
      return fault(pointer, "must have either minimum or maximum; two bounds are two objects");
    const char* const end = given.contains("maximum") ? "maximum" : "minimum";
    if (is_right(pointer + "/" + end, describe_number_fault({}, "", given.at(end))))
      (given.contains("maximum") ? bound.maximum : bound.minimum) = given.at(end).get<double>();
  }

  void read_numbers() {
    const std::size_t n = std::max<std::size_t>(1, made_.variables.size());
    made_.starts = read_integer("starts", kStartsRange, made_.method == PopulationMethod::kCmaEs ? 2 : 1);
    made_.population = read_integer("population", kPopulationRange, default_population(made_.method, n));
    made_.seed = read_integer("seed", kOptimiserSeedRange, 1);
    made_.budget = read_integer("budget", kBudgetRange, default_budget(n));
    if (made_.method == PopulationMethod::kNsga2 && (made_.population % 4 != 0 || made_.population < 8))
      fault("/population", "must be a multiple of 4, and at least 8, where there are several objectives");
    if (made_.budget < made_.starts * fewest_of_a_start())
      fault("/budget", "must be at least " + std::to_string(made_.starts * fewest_of_a_start()) +
                           (made_.local_method ? ", twice the variables and one for each start"
                                               : ", one generation of each start"));
  }

  [[nodiscard]] std::size_t fewest_of_a_start() const {
    return made_.local_method ? 2 * made_.variables.size() + 1 : made_.population;
  }

  /// Candidates that a search usually needs, as far as a usual number of jobs goes. The same for every
  /// service: a study that goes on reads its request again.
  [[nodiscard]] std::size_t default_budget(std::size_t n) const {
    const std::size_t of_a_start = made_.local_method ? 50 + 50 * n : 50 + 100 * n;
    const std::size_t usual =
        made_.method == PopulationMethod::kCmaEs ? made_.starts * of_a_start : 25 * made_.population;
    constexpr std::size_t kUsualJobs = 10'000;
    const std::size_t allowed = kUsualJobs / std::max<std::size_t>(1, jobs_of_a_candidate(made_));
    return std::max(made_.starts * fewest_of_a_start(), std::min(usual, allowed));
  }

  void check_size() {
    std::uint64_t jobs = 0;
    if (faults_.empty() &&
        (__builtin_mul_overflow(made_.budget, jobs_of_a_candidate(made_), &jobs) || jobs > max_jobs_))
      fault("/budget", "makes " + std::to_string(jobs) + " jobs, " +
                           std::to_string(jobs_of_a_candidate(made_)) + " for each candidate; at most " +
                           std::to_string(max_jobs_) + " are allowed");
  }

  std::size_t max_jobs_;
  OptimisationRequest made_;
  std::vector<std::string> metrics_;  ///< of the linkage; empty if it has faults
};

}  // namespace

OptimisationRequest parse_optimisation_request(const ordered_json& request, std::size_t max_jobs) {
  return OptimisationParser(request, max_jobs).parse();
}

std::string_view method_name(const OptimisationRequest& request) {
  if (request.local_method) return request.local_method == LocalMethod::kBobyqa ? "bobyqa" : "nelder_mead";
  return request.method == PopulationMethod::kCmaEs ? "cma_es" : "nsga2";
}

std::size_t jobs_of_a_candidate(const OptimisationRequest& request) {
  std::size_t jobs = request.common.replicates.count;
  for (const Axis& axis : request.common.axes) jobs *= axis.values.size();
  return jobs;
}

std::vector<double> candidate_at(const OptimisationRequest& request, const UnitPoint& point) {
  std::vector<double> candidate;
  for (std::size_t i = 0; i < point.size(); ++i) {
    const Variable& variable = request.variables[i];
    const double value = decimal_between(variable.span, point[i], kSearchSteps);
    candidate.push_back(variable.integer ? std::round(value) : value);
  }
  return candidate;
}

std::optional<UnitPoint> start_of(const OptimisationRequest& request) {
  UnitPoint point;
  bool given = false;
  for (const Variable& variable : request.variables) {
    given |= variable.start.has_value();
    point.push_back(variable.start ? part_at(variable.span, *variable.start) : 0.5);
  }
  return given ? std::optional(point) : std::nullopt;
}

ordered_json case_of(const OptimisationRequest& request, const std::vector<double>& candidate) {
  ordered_json made = ordered_json::object();
  for (std::size_t i = 0; i < candidate.size(); ++i) {
    const Variable& variable = request.variables[i];
    set_in_case(made, variable.path,
                variable.integer ? json(std::llround(candidate[i])) : json(candidate[i]));
  }
  return made;
}

ordered_json common_sweep_of(const ordered_json& request) {
  return take_keys(request, kCommonKeys);
}

}  // namespace jobs
