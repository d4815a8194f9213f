// SPDX-License-Identifier: Apache-2.0
#include "server/openapi/resource_schemas.h"

#include "engine/analysis/quantities.h"
#include "jobs/base/executor_names.h"
#include "jobs/base/states.h"
#include "jobs/requests/parameter_path.h"
#include "jobs/results/result_query.h"
#include "jobs/statistics/replicate_statistics.h"
#include "server/openapi/analysis_schemas.h"
#include "server/openapi/fit_schemas.h"
#include "server/openapi/measurement_schemas.h"
#include "server/openapi/optimisation_schemas.h"
#include "server/openapi/quantity_schemas.h"
#include "server/openapi/search_schemas.h"
#include "server/openapi/wear_schemas.h"

namespace server::openapi {

namespace {

enum class Detail { kFull, kListing };

const Json kTime{{"type", "string"},
                 {"format", "date-time"},
                 {"pattern", "^[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}\\.[0-9]{3}Z$"}};

Json make_problem_schema() {
  return object_of(
      {{"type", kText},
       {"title", kText},
       {"status", {{"type", "integer"}, {"minimum", 400}, {"maximum", 599}}},
       {"detail", kText},
       {"errors", list_of(object_of({{"pointer", described(kText, "where, a JSON pointer into the request")},
                                     {"detail", described(kText, "what is wrong, and what is allowed")}}))}},
      {"errors"});
}

Json metric_value(const engine::QuantityInfo& metric) {
  return {{"type", {metric.integer ? "integer" : "number", "null"}}};
}

Json column_of_numbers(const engine::QuantityInfo& = {}) { return list_of({{"type", {"number", "null"}}}); }

/// Metrics of the RPSUP linkage, or of a described one.
Json make_metrics() {
  const Json described_linkage{{"type", "object"},
                               {"description", "of a described linkage, by the names of its joints"},
                               {"patternProperties", linkage_metric_patterns(metric_value)},
                               {"additionalProperties", or_null(kNumber)}};
  return {{"anyOf", Json::array({object_of(metric_properties(metric_value)), described_linkage})}};
}

Json make_error() {
  return object_of({{"reason", described(kText,
                                         "assembly, lock_up, singular, contact_range, non_finite, "
                                         "step_underflow, step_limit, time_limit, memory_limit, internal, "
                                         "task_failed or task_lost")},
                    {"detail", kText},
                    {"t_s", or_null(kNumber)}});
}

Json make_run() {
  return object_of(
      {{"wall_time_s", kNumber},
       {"cpu_time_s", kNumber},
       {"attempts", kCount},
       {"host", kText},
       {"cpu", kText},
       {"libm", or_null(described(kText, "the mathematical library that was used"))},
       {"numerics", or_null({{"type", "string"}, {"enum", {"native", "portable", nullptr}}})},
       {"program",
        object_of({{"version", kText}, {"commit", kText}, {"compiler", kText}, {"engine", kText}})},
       {"reused",
        {{"type", "boolean"}, {"description", "whether the result was computed for another job"}}}});
}

Json make_job(Detail detail) {
  Json properties{{"id", ref("Id")},
                  {"sweep_id", or_null(ref("Id"))},
                  {"state", ref("State")},
                  {"error", or_null(ref("JobError"))},
                  {"attempts", kCount},
                  {"replicate", kCount},
                  {"created_at", kTime},
                  {"started_at", or_null(kTime)},
                  {"ended_at", or_null(kTime)},
                  {"run", or_null(ref("Run"))},
                  {"links", object_of({{"self", kText}, {"trajectory", kText}, {"sweep", or_null(kText)}})}};
  if (detail == Detail::kFull) {
    properties["parameters"] = ref("Parameters");
    properties["metrics"] = or_null(ref("Metrics"));
  }
  return detail == Detail::kFull ? object_of(std::move(properties), {"replicate"})
                                 : options_of(std::move(properties));
}

Json make_counts() {
  Json counts = Json::object();
  for (const std::string_view state : jobs::kJobStates) counts[std::string(state)] = kCount;
  counts["total"] = kCount;
  return object_of(std::move(counts));
}

Json make_sweep(Detail detail) {
  Json properties{
      {"id", ref("Id")},
      {"name", kText},
      {"notes", described(kText, "what people have written on it")},
      {"tags", list_of(kText)},
      {"state", ref("State")},
      {"counts", make_counts()},
      {"progress", {{"type", "number"}, {"minimum", 0}, {"maximum", 1}}},
      {"eta_s", described(or_null(kNumber), "seconds until the last job ends; null while that is not known")},
      {"eta_low_s", described(or_null(kNumber), "eta_s less two standard deviations")},
      {"eta_high_s", described(or_null(kNumber), "eta_s and two standard deviations")},
      {"priority", {{"type", "integer"}}},
      {"executor", {{"type", "string"}, {"enum", jobs::kExecutorNames}}},
      {"created_at", kTime},
      {"started_at", or_null(kTime)},
      {"ended_at", or_null(kTime)},
      {"axes", described(list_of(kText), "the parameters that differ from job to job")},
      {"study_id", described(or_null(ref("Id")),
                             "study whose jobs these are: search, wear study, optimisation or fit; null: "
                             "none")},
      {"links", object_of({{"self", kText},
                           {"results", kText},
                           {"events", kText},
                           {"cancel", kText},
                           {"retry", kText},
                           {"extend", kText},
                           {"move", kText},
                           {"study", or_null(kText)}})}};
  if (detail == Detail::kFull) properties["request"] = ref("SweepRequest");
  return detail == Detail::kFull ? object_of(std::move(properties)) : options_of(std::move(properties));
}

Json make_sweep_estimate() {
  return object_of(
      {{"jobs", kCount},
       {"stored_jobs", described(kCount, "jobs whose results are in the store, or equal to another one's")},
       {"new_jobs", described(kCount, "jobs to compute")},
       {"seconds", described(or_null(kNumber), "wall time on all slots of the executor; null: not known")},
       {"bytes", described(or_null(kNumber), "size in the store; null: not known")},
       {"measured_jobs", described(kCount, "jobs in the store that both are estimated from")},
       {"unmeasured_kinds", described(list_of(kText), "kinds of jobs of which the store has none")},
       {"max_jobs", described(kCount, "most jobs of a sweep")},
       {"free_bytes", described(kCount, "room on the store's disk")}});
}

Json make_assembly() {
  Json pose = list_of(kNumber);
  pose["minItems"] = pose["maxItems"] = 7;
  pose["description"] = "x_m, y_m, z_m, qx, qy, qz, qw";
  return object_of(
      {{"poses", {{"type", "object"}, {"additionalProperties", std::move(pose)}}},
       {"undriven_freedoms",
        described(or_null(kCount), "freedoms that neither drives nor joints take; null: of rpsup")}});
}

Json make_executors() {
  const Json tasks = object_of({{"pending", kCount}, {"running", kCount}});
  const Json waiting = object_of({{"reason", described(kText, "in Slurm's words")}, {"tasks", kCount}});
  const Json executor = object_of(
      {{"name", {{"type", "string"}, {"enum", jobs::kExecutorNames}}},
       {"slots", described(kCount, "jobs that it computes at a time")},
       {"tasks", described(or_null(tasks), "of this service in Slurm's queue; null where there is none")},
       {"nodes", described(list_of(kText), "machines that compute now")},
       {"waiting", described(list_of(waiting), "why tasks wait")},
       {"problems", described(list_of(kText), "what somebody should look at")}});
  return object_of(
      {{"items", described(list_of(executor), "first the one that takes sweeps which name none")}});
}

Json make_page_schema(std::string_view item) {
  return object_of({{"items", list_of(ref(item))},
                    {"next_cursor", described(kText, "for the next page; empty on the last one")}});
}

/// Statistics of the row's set of equal parameters.
void add_replicate_statistics(Json& properties) {
  properties["replicates_count"] = described(
      kCount, "of the row's set, those that have succeeded; the statistics are of the query's metric");
  for (const char* const key : {"replicates_mean", "replicates_spread", "replicates_min", "replicates_max"})
    properties[key] = or_null(kNumber);
}

Json make_result_row() {
  Json properties{{"job_id", ref("Id")}, {"state", ref("State")}, {"replicate", kCount}};
  add_parameters_of_row(properties);
  properties.update(metric_properties(metric_value));
  add_replicate_statistics(properties);
  for (const std::string_view column : jobs::kErrorColumns)
    properties[std::string(column)] = described(or_null(kText), "why a job failed; only if it is named");
  Json row = options_of(std::move(properties));
  row["additionalProperties"] = described(
      or_null(kNumber),
      "numbers swept inside a described linkage, and its metrics, which go by the names of its joints");
  return described(std::move(row),
                   "Every key stands in every row, save those that fields leaves out, those of what the "
                   "sweep does not vary, and of errors");
}

Json make_trajectory() {
  return object_of({{"channels", described(list_of(kText), "the columns in their order")},
                    {"columns",
                     {{"type", "object"},
                      {"required", {"t_s"}},
                      {"properties", channel_properties(column_of_numbers)},
                      {"patternProperties", linkage_channel_patterns(column_of_numbers)},
                      {"additionalProperties", column_of_numbers()}}}});
}

}  // namespace

Json make_resource_schemas() {
  Json schemas{{"Id", {{"type", "string"}, {"pattern", "^[A-Za-z0-9_-]{1,64}$"}}},
               {"State", {{"type", "string"}, {"enum", jobs::kJobStates}}},
               {"Problem", make_problem_schema()},
               {"Metrics", make_metrics()},
               {"JobError", make_error()},
               {"Run", make_run()},
               {"Job", make_job(Detail::kFull)},
               {"JobSummary", make_job(Detail::kListing)},
               {"JobPage", make_page_schema("JobSummary")},
               {"Sweep", make_sweep(Detail::kFull)},
               {"SweepSummary", make_sweep(Detail::kListing)},
               {"SweepPage", make_page_schema("SweepSummary")},
               {"SweepEstimate", make_sweep_estimate()},
               {"Assembly", make_assembly()},
               {"Executors", make_executors()},
               {"ResultRow", make_result_row()},
               {"ResultRows", list_of(ref("ResultRow"))},
               {"Trajectory", make_trajectory()},
               {"JsonSchema", {{"type", "object"}, {"required", {"$schema", "properties"}}}},
               {"OpenApi", {{"type", "object"}, {"required", {"openapi", "info", "paths"}}}},
               {"Status", object_of({{"status", kText},
                                     {"reason", described(kText, "Of the status full")},
                                     {"version", described(kText, "Of the program, where it is healthy")}},
                                    {"reason", "version"})},
               {"Text", kText},
               {"Binary", Json::object()}};
  schemas.update(make_search_schemas());
  schemas.update(make_wear_schemas());
  schemas.update(make_optimisation_schemas());
  schemas.update(make_fit_schemas());
  schemas.update(make_measurement_schemas());
  schemas.update(make_analysis_schemas());
  return schemas;
}

}  // namespace server::openapi
