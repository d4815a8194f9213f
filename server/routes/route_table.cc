// SPDX-License-Identifier: Apache-2.0
#include "server/routes/route_table.h"

#include "server/routes/analysis_routes.h"
#include "server/routes/document_routes.h"
#include "server/routes/job_routes.h"
#include "server/routes/page_routes.h"
#include "server/routes/store_route.h"
#include "server/routes/study_routes.h"
#include "server/routes/sweep_routes.h"

namespace server {

namespace {

constexpr std::string_view kJson = "application/json";
constexpr std::string_view kCsv = "text/csv";
constexpr std::string_view kNdjson = "application/x-ndjson";
constexpr std::string_view kNpz = "application/x-npz";
constexpr std::string_view kHtml = "text/html";

std::vector<Route> make_sweep_routes() {
  return {
      {.method = "POST", .pattern = "/v1/sweeps", .handler = post_sweep, .operation_id = "submitSweep",
       .tag = "sweeps", .summary = "Store a sweep and queue its jobs, or refuse all of it with every fault",
       .headers = {"idempotency_key", "prefer"}, .body = "SweepRequest", .success = 201,
       .answers = {{kJson, "Sweep"}}, .problems = {409, 422, 429}},
      {.method = "GET", .pattern = "/v1/sweeps", .handler = get_sweeps, .operation_id = "listSweeps",
       .tag = "sweeps", .summary = "Sweeps, the newest first",
       .query = {"state", "limit", "cursor", "fields"}, .answers = {{kJson, "SweepPage"}}, .problems = {422}},
      {.method = "GET", .pattern = "/v1/sweeps/{id}", .handler = get_sweep, .operation_id = "getSweep",
       .tag = "sweeps", .summary = "State, progress, time left and request of a sweep",
       .headers = {"prefer", "if_none_match"}, .answers = {{kJson, "Sweep"}}, .bodiless = {304},
       .problems = {404, 422}},
      {.method = "DELETE", .pattern = "/v1/sweeps/{id}", .handler = delete_sweep,
       .operation_id = "deleteSweep", .tag = "sweeps",
       .summary = "Delete a sweep that has ended, and the results that no other shares", .success = 204,
       .problems = {404, 409, 422}},
      {.method = "GET", .pattern = "/v1/sweeps/{id}/results", .handler = get_results,
       .operation_id = "getResults", .tag = "sweeps",
       .summary = "Table of results: a row for each job, with the values of the axes and every metric",
       .query = {"row_format", "fields", "order_by", "row_limit", "metric", "filters"},
       .headers = {"if_none_match"}, .answers = {{kJson, "ResultRows"}, {kCsv, "Text"}, {kNdjson, "Text"}},
       .bodiless = {304},
       .problems = {404, 422}},
      {.method = "GET", .pattern = "/v1/sweeps/{id}/events", .handler = get_events,
       .operation_id = "followSweep", .tag = "sweeps",
       .summary = "Server-sent events: job, progress and, at the end, done. 204: all events have been sent, "
                  "do not reconnect",
       .headers = {"last_event_id"}, .answers = {{"text/event-stream", "Text"}}, .bodiless = {204},
       .problems = {404, 422}},
      {.method = "POST", .pattern = "/v1/sweeps/{id}/cancel", .handler = cancel_sweep,
       .operation_id = "cancelSweep", .tag = "sweeps",
       .summary = "Cancel those jobs of a sweep that have not ended", .answers = {{kJson, "Sweep"}},
       .problems = {404, 409, 422}},
      {.method = "POST", .pattern = "/v1/sweeps/{id}/retry", .handler = retry_sweep,
       .operation_id = "retrySweep", .tag = "sweeps",
       .summary = "Queue the failed and cancelled jobs of a sweep again", .answers = {{kJson, "Sweep"}},
       .problems = {404, 409, 422, 429}},
      {.method = "POST", .pattern = "/v1/sweeps/{id}/extend", .handler = extend_sweep,
       .operation_id = "extendSweep", .tag = "sweeps",
       .summary = "Add values to the axes of a sweep, or cases; only new jobs run", .body = "Extension",
       .answers = {{kJson, "Sweep"}}, .problems = {404, 409, 422, 429}},
      {.method = "POST", .pattern = "/v1/sweeps/{id}/move", .handler = move_sweep,
       .operation_id = "moveSweep", .tag = "sweeps",
       .summary = "Give the queued jobs of a sweep to another executor", .body = "Move",
       .answers = {{kJson, "Sweep"}}, .problems = {404, 409, 422}},
  };
}

std::vector<Route> make_search_routes() {
  return {
      {.method = "POST", .pattern = "/v1/searches", .handler = SearchRoutes::post,
       .operation_id = "submitSearch", .tag = "searches",
       .summary = "Search the largest value of a parameter for which a metric stays within a bound, for "
                  "every combination of the axes",
       .headers = {"idempotency_key", "prefer"}, .body = "SearchRequest", .success = 201,
       .answers = {{kJson, "Search"}}, .problems = {409, 422, 429}},
      {.method = "GET", .pattern = "/v1/searches", .handler = SearchRoutes::list,
       .operation_id = "listSearches", .tag = "searches", .summary = "Searches, the newest first",
       .query = {"search_state", "limit", "cursor", "fields"}, .answers = {{kJson, "SearchPage"}},
       .problems = {422}},
      {.method = "GET", .pattern = "/v1/searches/{id}", .handler = SearchRoutes::get,
       .operation_id = "getSearch", .tag = "searches",
       .summary = "State, progress, limits and evaluations of a search",
       .headers = {"prefer", "if_none_match"}, .answers = {{kJson, "Search"}}, .bodiless = {304},
       .problems = {404, 422}},
      {.method = "DELETE", .pattern = "/v1/searches/{id}", .handler = SearchRoutes::erase,
       .operation_id = "deleteSearch", .tag = "searches",
       .summary = "Delete a search that has ended, with the sweep of its evaluations", .success = 204,
       .problems = {404, 409, 422}},
      {.method = "GET", .pattern = "/v1/searches/{id}/results", .handler = SearchRoutes::get_results,
       .operation_id = "getLimits", .tag = "searches",
       .summary = "Table of limits: a row for each combination of the axes, with the limit and its band",
       .query = {"row_format", "fields", "order_by", "row_limit", "columns"}, .headers = {"if_none_match"},
       .answers = {{kJson, "LimitRows"}, {kCsv, "Text"}, {kNdjson, "Text"}}, .bodiless = {304},
       .problems = {404, 422}},
      {.method = "GET", .pattern = "/v1/searches/{id}/events", .handler = SearchRoutes::get_events,
       .operation_id = "followSearch", .tag = "searches",
       .summary = "Server-sent events: job, progress and, at the end, done. 204: all events have been sent, "
                  "do not reconnect",
       .headers = {"last_event_id"}, .answers = {{"text/event-stream", "Text"}}, .bodiless = {204},
       .problems = {404, 422}},
      {.method = "POST", .pattern = "/v1/searches/{id}/cancel", .handler = SearchRoutes::cancel,
       .operation_id = "cancelSearch", .tag = "searches", .summary = "Cancel a search; its evaluations stay",
       .answers = {{kJson, "Search"}}, .problems = {404, 409, 422}},
      {.method = "POST", .pattern = "/v1/searches/{id}/retry", .handler = SearchRoutes::retry,
       .operation_id = "retrySearch", .tag = "searches",
       .summary = "Queue the failed and cancelled jobs of a search again, and continue",
       .answers = {{kJson, "Search"}}, .problems = {404, 409, 422, 429}},
  };
}

std::vector<Route> make_wear_routes() {
  return {
      {.method = "POST", .pattern = "/v1/wear-studies", .handler = WearRoutes::post,
       .operation_id = "submitWearStudy", .tag = "wear-studies",
       .summary = "Submit a wear study: cycles of simulation and wear, each with the bore that the cycle "
                  "before has left",
       .headers = {"idempotency_key", "prefer"}, .body = "WearStudyRequest", .success = 201,
       .answers = {{kJson, "WearStudy"}}, .problems = {409, 422, 429}},
      {.method = "GET", .pattern = "/v1/wear-studies", .handler = WearRoutes::list,
       .operation_id = "listWearStudies", .tag = "wear-studies", .summary = "Wear studies, the newest first",
       .query = {"search_state", "limit", "cursor", "fields"}, .answers = {{kJson, "WearStudyPage"}},
       .problems = {422}},
      {.method = "GET", .pattern = "/v1/wear-studies/{id}", .handler = WearRoutes::get,
       .operation_id = "getWearStudy", .tag = "wear-studies",
       .summary = "State and progress of a wear study, and the bore after each step",
       .headers = {"prefer", "if_none_match"}, .answers = {{kJson, "WearStudy"}}, .bodiless = {304},
       .problems = {404, 422}},
      {.method = "DELETE", .pattern = "/v1/wear-studies/{id}", .handler = WearRoutes::erase,
       .operation_id = "deleteWearStudy", .tag = "wear-studies",
       .summary = "Delete a wear study that has ended, with the sweep of its jobs", .success = 204,
       .problems = {404, 409, 422}},
      {.method = "GET", .pattern = "/v1/wear-studies/{id}/results",
       .handler = WearRoutes::get_results, .operation_id = "getWearCycles", .tag = "wear-studies",
       .summary = "Table of cycles: a row for each, with time, maximum depth, rate, and every metric of its "
                  "job",
       .query = {"row_format", "fields", "order_by", "row_limit", "columns"}, .headers = {"if_none_match"},
       .answers = {{kJson, "WearCycleRows"}, {kCsv, "Text"}, {kNdjson, "Text"}}, .bodiless = {304},
       .problems = {404, 422}},
      {.method = "GET", .pattern = "/v1/wear-studies/{id}/events", .handler = WearRoutes::get_events,
       .operation_id = "followWearStudy", .tag = "wear-studies",
       .summary = "Server-sent events: job, progress and, at the end, done. 204: all events have been sent, "
                  "do not reconnect",
       .headers = {"last_event_id"}, .answers = {{"text/event-stream", "Text"}}, .bodiless = {204},
       .problems = {404, 422}},
      {.method = "POST", .pattern = "/v1/wear-studies/{id}/cancel", .handler = WearRoutes::cancel,
       .operation_id = "cancelWearStudy", .tag = "wear-studies",
       .summary = "Cancel a wear study; its computed cycles stay", .answers = {{kJson, "WearStudy"}},
       .problems = {404, 409, 422}},
      {.method = "POST", .pattern = "/v1/wear-studies/{id}/retry", .handler = WearRoutes::retry,
       .operation_id = "retryWearStudy", .tag = "wear-studies",
       .summary = "Queue the failed and cancelled jobs of a wear study again, and continue",
       .answers = {{kJson, "WearStudy"}}, .problems = {404, 409, 422, 429}},
  };
}

std::vector<Route> make_analysis_routes() {
  return {
      {.method = "GET", .pattern = "/v1/sweeps/{id}/sensitivity", .handler = get_sensitivity,
       .operation_id = "getSensitivity", .tag = "sweeps",
       .summary = "Sensitivity of a metric to each parameter of a morris or saltelli design",
       .query = {"metric", "row_format"}, .headers = {"if_none_match"},
       .answers = {{kJson, "SensitivityRows"}, {kCsv, "Text"}, {kNdjson, "Text"}}, .bodiless = {304},
       .problems = {404, 409, 422}},
      {.method = "GET", .pattern = "/v1/sweeps/{id}/surrogate", .handler = get_surrogate,
       .operation_id = "getSurrogate", .tag = "sweeps",
       .summary = "Polynomial chaos surrogate of a metric, with its cross-validation error and the points "
                  "that it is fitted to",
       .query = {"metric", "surrogate_x", "surrogate_y"}, .headers = {"if_none_match"},
       .answers = {{kJson, "Surrogate"}}, .bodiless = {304}, .problems = {404, 409, 422}},
      {.method = "GET", .pattern = "/v1/sweeps/{id}/flexibility", .handler = get_flexibility,
       .operation_id = "getFlexibility", .tag = "sweeps",
       .summary = "Rigid and flexible jobs compared pair by pair", .query = {"metric", "row_format"},
       .headers = {"if_none_match"},
       .answers = {{kJson, "FlexibilityRows"}, {kCsv, "Text"}, {kNdjson, "Text"}}, .bodiless = {304},
       .problems = {404, 409, 422}},
      {.method = "GET", .pattern = "/v1/sweeps/{id}/paper", .handler = get_paper, .operation_id = "getPaper",
       .tag = "sweeps",
       .summary = "The paper's seven statements compared with a sweep over clearance_mm, "
                  "crank_velocity_rad_s and coupler",
       .query = {"row_format"}, .headers = {"if_none_match"},
       .answers = {{kJson, "PaperRows"}, {kCsv, "Text"}, {kNdjson, "Text"}}, .bodiless = {304},
       .problems = {404, 409, 422}},
      {.method = "GET", .pattern = "/v1/sweeps/{id}/bifurcation", .handler = get_bifurcation,
       .operation_id = "getBifurcation", .tag = "sweeps",
       .summary = "Bifurcation diagram: a channel of every job once per crank revolution",
       .query = {"channel", "phase_rad", "section_from", "row_format"}, .headers = {"if_none_match"},
       .answers = {{kJson, "BifurcationRows"}, {kCsv, "Text"}, {kNdjson, "Text"}}, .bodiless = {304},
       .problems = {404, 409, 422}},
      {.method = "GET", .pattern = "/v1/sweeps/{id}/lyapunov", .handler = get_lyapunov,
       .operation_id = "getLyapunov", .tag = "sweeps",
       .summary = "The largest Lyapunov exponent of each set of replicates", .query = {"row_format"},
       .headers = {"if_none_match"}, .answers = {{kJson, "LyapunovRows"}, {kCsv, "Text"}, {kNdjson, "Text"}},
       .bodiless = {304}, .problems = {404, 409, 422}},
      {.method = "GET", .pattern = "/v1/sweeps/{id}/report", .handler = get_report,
       .operation_id = "getReport", .tag = "sweeps",
       .summary = "Report of the sweep, one self-contained page: figures, tables, provenance, and the "
                  "command that repeats it",
       .headers = {"if_none_match"}, .answers = {{kHtml, "Text"}}, .bodiless = {304}, .problems = {404, 422}},
      {.method = "GET", .pattern = "/v1/jobs/{id}/spectrum", .handler = get_spectrum,
       .operation_id = "getSpectrum", .tag = "jobs",
       .summary = "Spectrum of a channel: amplitude and power density over frequency",
       .query = {"channel", "window", "from", "to", "column_format"}, .headers = {"if_none_match"},
       .answers = {{kJson, "Columns"}, {kCsv, "Text"}, {kNpz, "Binary"}}, .bodiless = {304},
       .problems = {404, 409, 422}},
      {.method = "GET", .pattern = "/v1/jobs/{id}/poincare", .handler = get_poincare,
       .operation_id = "getPoincare", .tag = "jobs",
       .summary = "Poincare section of a job: channels once per crank revolution",
       .query = {"channels", "phase_rad", "from", "to", "column_format"}, .headers = {"if_none_match"},
       .answers = {{kJson, "Columns"}, {kCsv, "Text"}, {kNpz, "Binary"}}, .bodiless = {304},
       .problems = {404, 409, 422}},
      {.method = "GET", .pattern = "/v1/jobs/{id}/wear", .handler = get_wear, .operation_id = "getWear",
       .tag = "jobs",
       .summary = "Wear map by Archard's law: worn depth around the bearing and along its length",
       .query = {"wear_coefficient_m2_n", "sectors", "worn_clearance_mm", "from", "to", "row_format"},
       .headers = {"if_none_match"}, .answers = {{kJson, "WearRows"}, {kCsv, "Text"}, {kNdjson, "Text"}},
       .bodiless = {304}, .problems = {404, 409, 422}},
  };
}

std::vector<Route> make_job_routes() {
  return {
      {.method = "POST", .pattern = "/v1/jobs", .handler = post_job, .operation_id = "submitJob",
       .tag = "jobs", .summary = "Store one job and queue it, or refuse it with every fault",
       .headers = {"idempotency_key", "prefer"}, .body = "Parameters", .success = 201,
       .answers = {{kJson, "Job"}}, .problems = {409, 422, 429}},
      {.method = "GET", .pattern = "/v1/jobs", .handler = get_jobs, .operation_id = "listJobs", .tag = "jobs",
       .summary = "Jobs, the newest first", .query = {"state", "limit", "cursor", "fields"},
       .answers = {{kJson, "JobPage"}}, .problems = {422}},
      {.method = "GET", .pattern = "/v1/jobs/{id}", .handler = get_job, .operation_id = "getJob",
       .tag = "jobs", .summary = "State, parameters, metrics, error and provenance of a job",
       .headers = {"prefer", "if_none_match"}, .answers = {{kJson, "Job"}}, .bodiless = {304},
       .problems = {404, 422}},
      {.method = "DELETE", .pattern = "/v1/jobs/{id}", .handler = delete_job, .operation_id = "deleteJob",
       .tag = "jobs",
       .summary = "Delete a job of no sweep that has ended, and its result if no other shares it",
       .success = 204, .problems = {404, 409, 422}},
      {.method = "POST", .pattern = "/v1/jobs/{id}/cancel", .handler = cancel_job,
       .operation_id = "cancelJob", .tag = "jobs", .summary = "Cancel a job that has not ended",
       .answers = {{kJson, "Job"}}, .problems = {404, 409, 422}},
      {.method = "GET", .pattern = "/v1/jobs/{id}/trajectory", .handler = get_trajectory,
       .operation_id = "getTrajectory", .tag = "jobs", .summary = "Columns of a job's trajectory",
       .query = {"channels", "from", "to", "points", "column_format"}, .headers = {"if_none_match"},
       .answers = {{kJson, "Trajectory"}, {kCsv, "Text"}, {kNpz, "Binary"}}, .bodiless = {304},
       .problems = {404, 422}},
  };
}

std::vector<Route> make_other_routes() {
  return {
      {.method = "GET", .pattern = "/v1/parameters", .handler = get_parameters,
       .operation_id = "getParameters", .tag = "interface",
       .summary = "JSON Schema of the parameters of a job", .answers = {{kJson, "JsonSchema"}},
       .problems = {422}},
      {.method = "GET", .pattern = "/v1/executors", .handler = get_executors, .operation_id = "listExecutors",
       .tag = "service", .summary = "Executors of jobs, with the states of their Slurm tasks",
       .answers = {{kJson, "Executors"}}, .problems = {422}},
      {.method = "GET", .pattern = "/v1/openapi.json", .handler = get_openapi, .operation_id = "getOpenApi",
       .tag = "interface", .summary = "This document", .answers = {{kJson, "OpenApi"}}, .problems = {422}},
      {.method = "GET", .pattern = "/docs", .handler = get_docs, .operation_id = "getDocs",
       .tag = "interface", .summary = "A page to try the interface with", .headers = {"if_none_match"},
       .answers = {{kHtml, "Text"}}, .bodiless = {304}, .problems = {404}},
      {.method = "GET", .pattern = "/docs/docs.js", .handler = get_docs, .operation_id = "getDocsScript",
       .tag = "interface", .summary = "A part of that page", .headers = {"if_none_match"},
       .answers = {{"text/javascript", "Text"}}, .bodiless = {304}, .problems = {404}},
      {.method = "GET", .pattern = "/docs/swagger-ui-bundle.js", .handler = get_docs,
       .operation_id = "getDocsBundle", .tag = "interface", .summary = "A part of that page",
       .headers = {"if_none_match"}, .answers = {{"text/javascript", "Text"}}, .bodiless = {304},
       .problems = {404}},
      {.method = "GET", .pattern = "/docs/swagger-ui.css", .handler = get_docs,
       .operation_id = "getDocsStyle", .tag = "interface", .summary = "A part of that page",
       .headers = {"if_none_match"}, .answers = {{"text/css", "Text"}}, .bodiless = {304}, .problems = {404}},
      {.method = "GET", .pattern = "/v1/store", .handler = get_store, .operation_id = "getStore",
       .tag = "service", .summary = "A consistent copy of the whole store, an SQLite file",
       .answers = {{"application/vnd.sqlite3", "Binary"}}, .problems = {422, 507}},
      {.method = "GET", .pattern = "/metrics", .handler = get_metrics, .operation_id = "getMetrics",
       .tag = "service", .summary = "Metrics of the service for Prometheus",
       .answers = {{"text/plain", "Text"}}, .problems = {422}},
      {.method = "GET", .pattern = "/healthz", .handler = get_health, .operation_id = "getHealth",
       .tag = "service", .summary = "Whether the program answers at all", .answers = {{kJson, "Status"}}},
      {.method = "GET", .pattern = "/readyz", .handler = get_readiness, .operation_id = "getReadiness",
       .tag = "service", .summary = "Whether the store can be read and the service is not ending",
       .answers = {{kJson, "Status"}}},
      {.method = "GET", .pattern = "/", .handler = get_page_file, .operation_id = "getPage", .tag = "page",
       .summary = "The page of the service", .headers = {"if_none_match"}, .answers = {{kHtml, "Text"}},
       .bodiless = {304}},
  };
}

std::vector<Route> make_route_table() {
  std::vector<Route> table;
  for (const auto& part : {make_sweep_routes(), make_search_routes(), make_wear_routes(),
                           make_analysis_routes(), make_job_routes(), make_other_routes()}) {
    table.insert(table.end(), part.begin(), part.end());
  }
  return table;
}

}  // namespace

std::span<const Route> route_table() {
  static const std::vector<Route> table = make_route_table();
  return table;
}

}  // namespace server
