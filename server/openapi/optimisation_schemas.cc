// SPDX-License-Identifier: Apache-2.0
#include "server/openapi/optimisation_schemas.h"

#include "jobs/base/states.h"
#include "jobs/optimisation/optimisation_request.h"
#include "jobs/optimisation/optimiser.h"
#include "jobs/requests/axis.h"
#include "jobs/requests/parameter_path.h"

namespace server::openapi {

namespace {

const Json kMethods{"cma_es", "nsga2", "nelder_mead", "bobyqa"};

Json make_quantile_of_jobs(std::string_view description) {
  return described({{"type", "number"}, {"minimum", 0}, {"maximum", 1}}, description);
}

Json make_variable() {
  return object_of({{"from", kNumber},
                    {"to", described(kNumber, "above from")},
                    {"scale", {{"type", "string"}, {"enum", {"linear", "log"}}, {"default", "linear"}}},
                    {"start", described(kNumber, "value of one of the first candidates")}},
                   {"scale", "start"});
}

Json make_over() {
  Json variables = Json::object();
  for (const std::string& path : jobs::known_paths()) {
    if (jobs::is_numeric(path)) variables[path] = ref("Variable");
  }
  Json over = options_of(std::move(variables));
  over["patternProperties"] = {{"^(linkage|crank_drive|rod_drive)\\.", ref("Variable")}};
  over["minProperties"] = 1;
  over["maxProperties"] = jobs::kMostVariables;
  return over;
}

Json make_objective() {
  Json goal{{"type", "string"}, {"enum", {"minimise", "maximise"}}, {"default", "minimise"}};
  return object_of(
      {{"metric", kText},
       {"goal", std::move(goal)},
       {"quantile", make_quantile_of_jobs("fraction of the candidate's jobs that must reach the value which "
                                          "counts; 1, the default, counts the worst job")}},
      {"goal", "quantile"});
}

Json make_bound() {
  return object_of(
      {{"metric", kText},
       {"minimum", described(kNumber, "either minimum or maximum")},
       {"maximum", kNumber},
       {"quantile", make_quantile_of_jobs("fraction of the candidate's jobs that must keep the bound; all if "
                                          "left out")}},
      {"minimum", "maximum", "quantile"});
}

Json make_optimisation_request() {
  Json objectives = list_of(ref("Objective"));
  objectives["minItems"] = 1;
  objectives["maxItems"] = jobs::kMostObjectives;
  Json request =
      object_of({{"name", as_in_sweep("name")},
                 {"parameters", ref("Parameters")},
                 {"over", make_over()},
                 {"objectives", std::move(objectives)},
                 {"bounds", described(list_of(ref("MetricBound")), "on metrics of a feasible candidate")},
                 {"sweep", ref("Axes")},
                 {"replicates", as_in_sweep("replicates")},
                 {"priority", as_in_sweep("priority")},
                 {"executor", as_in_sweep("executor")},
                 {"reuse", as_in_sweep("reuse")},
                 {"method", described({{"type", "string"}, {"enum", kMethods}},
                                      "nsga2 with several objectives; with one cma_es, the default, or a "
                                      "local search, for an objective that is smooth")},
                 {"budget", integer_between(jobs::kBudgetRange, "most candidates, of all starts together")},
                 {"population", integer_between(jobs::kPopulationRange, "candidates of a generation")},
                 {"starts", integer_between(jobs::kStartsRange, "searches from different first candidates")},
                 {"seed", integer_between(jobs::kOptimiserSeedRange, "of the random numbers")}},
                {"name", "parameters", "bounds", "sweep", "replicates", "priority", "executor", "reuse",
                 "method", "budget", "population", "starts", "seed"});
  request["description"] =
      "Values of parameters for which metrics are least or largest. A candidate has a job for each "
      "combination "
      "of the axes and each replicate";
  request["examples"] = Json::array({{{"parameters", {{"duration_s", 0.6}, {"run_up_s", 0.3}}},
                                      {"over", {{"clearance_mm", {{"from", 0.1}, {"to", 0.5}}}}},
                                      {"objectives", {{{"metric", "peak_slider_acceleration_m_s2"}}}},
                                      {"budget", 24},
                                      {"starts", 1}}});
  return request;
}

Json make_candidate() {
  return object_of({{"values", described({{"type", "object"}}, "of the variables")},
                    {"metrics", described({{"type", "object"}},
                                          "objectives, and bounds with _at_most or "
                                          "_at_least behind the metric")},
                    {"start", or_null(kCount)},
                    {"job_ids", list_of(ref("Id"))}});
}

Json make_start() {
  return object_of({{"candidates", kCount},
                    {"generations", described(kCount, "that are complete")},
                    {"end", {{"type", "string"}, {"enum", {"running", "converged", "budget", "stopped"}}}},
                    {"best", or_null(kNumber)}});
}

Json make_optimisation_summary() {
  return {{"id", ref("Id")},
          {"name", kText},
          {"state", ref("SearchState")},
          {"error", described(or_null(kText), "why it could not go on")},
          {"sweep_id", ref("Id")},
          {"variables", list_of(kText)},
          {"objectives", list_of(ref("Objective"))},
          {"created_at", kText},
          {"ended_at", or_null(kText)},
          {"links", texts_of({"self", "results", "cancel", "retry", "events", "sweep"})}};
}

Json make_optimisation() {
  Json properties = make_optimisation_summary();
  Json counts =
      object_of({{"pending", kCount}, {"feasible", kCount}, {"infeasible", kCount}, {"lost", kCount}});
  properties.update(
      {{"method", {{"type", "string"}, {"enum", kMethods}}},
       {"budget", kCount},
       {"population", or_null(kCount)},
       {"counts", Json{{"$ref", "#/components/schemas/Sweep/properties/counts"}}},
       {"progress", {{"type", "number"}, {"minimum", 0}, {"maximum", 1}}},
       {"candidates", described(std::move(counts), "by state; lost: a job without a value")},
       {"lost_reasons", described({{"type", "object"}, {"additionalProperties", kCount}},
                                  "lost candidates by the error_reason of a job, cancelled, no_value, or "
                                  "invalid_parameters: parameters that do not fit together")},
       {"starts", list_of(ref("OptimisationStart"))},
       {"best_repeats", described(or_null(kCount),
                                  "starts whose best value is within 1 % of the best; null "
                                  "where there are several objectives")},
       {"best", described(or_null(ref("Candidate")),
                          "null where there are several objectives, or nothing "
                          "feasible")},
       {"front", described(list_of(ref("Candidate")), "feasible candidates that no other one dominates")},
       {"request", ref("OptimisationRequest")}});
  return object_of(std::move(properties));
}

Json make_candidate_row() {
  Json row =
      options_of({{"candidate", kCount},
                  {"start", or_null(kCount)},
                  {"state", {{"type", "string"}, {"enum", {"pending", "feasible", "infeasible", "lost"}}}},
                  {"lost_reason", or_null(kText)},
                  {"on_front", {{"type", "boolean"}}},
                  {"job_id", or_null(ref("Id"))}});
  row["additionalProperties"] = or_null(kNumber);
  return described(std::move(row),
                   "Beside these, the variables, the objectives, and the bounds by their "
                   "metric with _at_most or _at_least behind it");
}

}  // namespace

Json make_optimisation_schemas() {
  return {{"OptimisationRequest", make_optimisation_request()},
          {"Variable", make_variable()},
          {"Objective", make_objective()},
          {"MetricBound", make_bound()},
          {"Candidate", make_candidate()},
          {"OptimisationStart", make_start()},
          {"Optimisation", make_optimisation()},
          {"OptimisationSummary", options_of(make_optimisation_summary())},
          {"OptimisationPage",
           object_of({{"items", list_of(ref("OptimisationSummary"))}, {"next_cursor", kText}})},
          {"CandidateRows", list_of(make_candidate_row())}};
}

}  // namespace server::openapi
