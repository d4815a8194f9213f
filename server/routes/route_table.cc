// SPDX-License-Identifier: Apache-2.0
#include "server/routes/route_table.h"

#include "server/routes/analysis_routes.h"
#include "server/routes/document_routes.h"
#include "server/routes/job_routes.h"
#include "server/routes/measurement_routes.h"
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
constexpr std::string_view kHdf5 = "application/x-hdf5";
constexpr std::string_view kMat = "application/x-matlab-data";
constexpr std::string_view kHtml = "text/html";

std::vector<Route> make_sweep_routes() {
  return {
      {.method = "POST", .pattern = "/v1/sweeps", .handler = post_sweep, .operation_id = "submitSweep",
       .tag = "sweeps", .summary = "Store a sweep and queue its jobs, or refuse all of it with every fault",
       .query = {"dry_run"}, .headers = {"idempotency_key", "prefer"}, .body = "SweepRequest",
       .success = 201, .answers = {{kJson, "Sweep"}}, .other_answers = {{200, {kJson, "SweepEstimate"}}},
       .problems = {409, 422, 429}},
      {.method = "GET", .pattern = "/v1/sweeps", .handler = get_sweeps, .operation_id = "listSweeps",
       .tag = "sweeps", .summary = "Sweeps, the newest first",
       .query = {"state", "limit", "cursor", "fields"}, .answers = {{kJson, "SweepPage"}}, .problems = {422}},
      {.method = "GET", .pattern = "/v1/sweeps/{id}", .handler = get_sweep, .operation_id = "getSweep",
       .tag = "sweeps", .summary = "State, progress, time left and request of a sweep",
       .headers = {"prefer", "if_none_match"}, .answers = {{kJson, "Sweep"}}, .bodiless = {304},
       .problems = {404, 422}},
      {.method = "PATCH", .pattern = "/v1/sweeps/{id}", .handler = describe_sweep,
       .operation_id = "describeSweep", .tag = "sweeps", .summary = "Change name, notes or tags of a sweep",
       .body = "SweepDescription", .answers = {{kJson, "Sweep"}}, .problems = {404, 422}},
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
       .problems = {404, 422},
       .work = Work::kLarge},
      {.method = "GET", .pattern = "/v1/sweeps/{id}/trajectories", .handler = get_trajectories,
       .operation_id = "getTrajectories", .tag = "sweeps",
       .summary = "File of the results and of all trajectories of a sweep: HDF5, MAT or NPZ",
       .query = {"channels", "from", "to", "export_format"},
       .headers = {"if_none_match", "range", "if_range"},
       .answers = {{kHdf5, "Binary"}, {kMat, "Binary"}, {kNpz, "Binary"}}, .bodiless = {304},
       .partial = true, .problems = {404, 409, 416, 422, 507}, .work = Work::kLarge},
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

/// Words by which the document tells one kind of study from another.
struct StudyWords {
  std::string path, tag, schema, rows;
  std::string noun, nouns;                      ///< in an operation's id: "Search", "Searches"
  std::string rows_id;                          ///< operation's id of its table
  std::string submit, list, get, erase, table;  ///< summaries
  std::string name;                             ///< with its article: "a search"
};

template <typename Routes>
std::vector<Route> make_study_routes(const StudyWords& words) {
  const std::string one = words.path + "/{id}";
  return {
      {.method = "POST", .pattern = words.path, .handler = Routes::post,
       .operation_id = "submit" + words.noun, .tag = words.tag, .summary = words.submit,
       .headers = {"idempotency_key", "prefer"}, .body = words.schema + "Request", .success = 201,
       .answers = {{kJson, words.schema}}, .problems = {409, 422, 429}},
      {.method = "GET", .pattern = words.path, .handler = Routes::list, .operation_id = "list" + words.nouns,
       .tag = words.tag, .summary = words.list, .query = {"search_state", "limit", "cursor", "fields"},
       .answers = {{kJson, words.schema + "Page"}}, .problems = {422}},
      {.method = "GET", .pattern = one, .handler = Routes::get, .operation_id = "get" + words.noun,
       .tag = words.tag, .summary = words.get, .headers = {"prefer", "if_none_match"},
       .answers = {{kJson, words.schema}}, .bodiless = {304}, .problems = {404, 422}, .work = Work::kLarge},
      {.method = "DELETE", .pattern = one, .handler = Routes::erase, .operation_id = "delete" + words.noun,
       .tag = words.tag, .summary = words.erase, .success = 204, .problems = {404, 409, 422}},
      {.method = "GET", .pattern = one + "/results", .handler = Routes::get_results,
       .operation_id = words.rows_id, .tag = words.tag, .summary = words.table,
       .query = {"row_format", "fields", "order_by", "row_limit", "columns"}, .headers = {"if_none_match"},
       .answers = {{kJson, words.rows}, {kCsv, "Text"}, {kNdjson, "Text"}}, .bodiless = {304},
       .problems = {404, 422}, .work = Work::kLarge},
      {.method = "GET", .pattern = one + "/events", .handler = Routes::get_events,
       .operation_id = "follow" + words.noun, .tag = words.tag,
       .summary = "Server-sent events: job, progress and, at the end, done. 204: all events have been sent, "
                  "do not reconnect",
       .headers = {"last_event_id"}, .answers = {{"text/event-stream", "Text"}}, .bodiless = {204},
       .problems = {404, 422}},
      {.method = "POST", .pattern = one + "/cancel", .handler = Routes::cancel,
       .operation_id = "cancel" + words.noun, .tag = words.tag,
       .summary = "Cancel " + words.name + "; its computed jobs stay", .answers = {{kJson, words.schema}},
       .problems = {404, 409, 422}},
      {.method = "POST", .pattern = one + "/retry", .handler = Routes::retry,
       .operation_id = "retry" + words.noun, .tag = words.tag,
       .summary = "Queue the failed and cancelled jobs of " + words.name + " again, and continue",
       .answers = {{kJson, words.schema}}, .problems = {404, 409, 422, 429}},
  };
}

std::vector<Route> make_search_routes() {
  return make_study_routes<SearchRoutes>(
      {.path = "/v1/searches", .tag = "searches", .schema = "Search", .rows = "LimitRows", .noun = "Search",
       .nouns = "Searches", .rows_id = "getLimits",
       .submit = "Search the limit of a parameter, the last value before a metric first exceeds its bound, "
                 "for every combination of the axes",
       .list = "Searches, the newest first", .get = "State, progress, limits and evaluations of a search",
       .erase = "Delete a search that has ended, with the sweep of its evaluations",
       .table = "Table of limits: a row for each combination of the axes, with the limit and its band",
       .name = "a search"});
}

std::vector<Route> make_wear_routes() {
  return make_study_routes<WearRoutes>(
      {.path = "/v1/wear-studies", .tag = "wear-studies", .schema = "WearStudy", .rows = "WearCycleRows",
       .noun = "WearStudy", .nouns = "WearStudies", .rows_id = "getWearCycles",
       .submit = "Submit a wear study: cycles of simulation and wear, each with the bore that the cycle "
                 "before has left",
       .list = "Wear studies, the newest first",
       .get = "State and progress of a wear study, and the bore after each step",
       .erase = "Delete a wear study that has ended, with the sweep of its jobs",
       .table = "Table of cycles: a row for each, with time, maximum depth, rate, and every metric of its "
                "job",
       .name = "a wear study"});
}

std::vector<Route> make_optimisation_routes() {
  return make_study_routes<OptimisationRoutes>(
      {.path = "/v1/optimisations", .tag = "optimisations", .schema = "Optimisation", .rows = "CandidateRows",
       .noun = "Optimisation", .nouns = "Optimisations", .rows_id = "getCandidates",
       .submit = "Look for the values of parameters for which metrics are least or largest, within bounds on "
                 "other metrics",
       .list = "Optimisations, the newest first",
       .get = "State and progress of an optimisation, and its best candidates",
       .erase = "Delete an optimisation that has ended, with the sweep of its candidates",
       .table = "Table of candidates: a row for each, with its values, objectives and bounds",
       .name = "an optimisation"});
}

std::vector<Route> make_fit_routes() {
  std::vector<Route> routes = make_study_routes<FitRoutes>(
      {.path = "/v1/fits", .tag = "fits", .schema = "Fit", .rows = "FitPointRows", .noun = "Fit",
       .nouns = "Fits", .rows_id = "getFitPoints",
       .submit = "Look for the values of parameters with which jobs give measured signals",
       .list = "Fits, the newest first",
       .get = "State and progress of a fit, the values that it found, and how sure they are",
       .erase = "Delete a fit that has ended, with the sweep of its jobs",
       .table = "Table of points: a row for each, with its values and the sum of the squares of its "
                "residuals",
       .name = "a fit"});
  routes.push_back({.method = "GET", .pattern = "/v1/fits/{id}/signals", .handler = FitRoutes::get_signals,
                    .operation_id = "getFitSignals", .tag = "fits",
                    .summary = "Table of measured and predicted samples with the best values",
                    .query = {"row_format", "fields", "order_by", "row_limit", "columns"},
                    .headers = {"if_none_match"},
                    .answers = {{kJson, "FitSignalRows"}, {kCsv, "Text"}, {kNdjson, "Text"}},
                    .bodiless = {304}, .problems = {404, 422}, .work = Work::kLarge});
  return routes;
}

/// An analysis whose answer is a table, by rows.
Route with_rows(Route route, const char* schema) {
  route.query.emplace_back("row_format");
  route.headers = {"if_none_match"};
  route.answers = {{kJson, schema}, {kCsv, "Text"}, {kNdjson, "Text"}};
  route.bodiless = {304};
  route.problems = {404, 409, 422};
  route.work = Work::kLarge;
  return route;
}

/// The same by columns.
Route with_columns(Route route, const char* schema) {
  route.query.emplace_back("column_format");
  route.headers = {"if_none_match"};
  route.answers = {{kJson, schema}, {kCsv, "Text"}, {kNpz, "Binary"}};
  route.bodiless = {304};
  route.problems = {404, 409, 422};
  route.work = Work::kLarge;
  return route;
}

std::vector<Route> make_analysis_routes() {
  return {
      with_rows({.method = "GET",
                 .pattern = "/v1/sweeps/{id}/sensitivity",
                 .handler = get_sensitivity,
                 .operation_id = "getSensitivity",
                 .tag = "sweeps",
                 .summary = "Sensitivity of a metric to each parameter of a morris or saltelli design",
                 .query = {"metric"}},
                "SensitivityRows"),
      {.method = "GET",
       .pattern = "/v1/sweeps/{id}/surrogate",
       .handler = get_surrogate,
       .operation_id = "getSurrogate",
       .tag = "sweeps",
       .summary = "Polynomial chaos surrogate of a metric, with its cross-validation error and the points "
                  "that it is fitted to",
       .query = {"metric", "surrogate_x", "surrogate_y"},
       .headers = {"if_none_match"},
       .answers = {{kJson, "Surrogate"}},
       .bodiless = {304},
       .problems = {404, 409, 422},
       .work = Work::kLarge},
      with_rows({.method = "GET",
                 .pattern = "/v1/sweeps/{id}/flexibility",
                 .handler = get_flexibility,
                 .operation_id = "getFlexibility",
                 .tag = "sweeps",
                 .summary = "Rigid and flexible jobs compared pair by pair",
                 .query = {"metric"}},
                "FlexibilityRows"),
      with_rows({.method = "GET",
                 .pattern = "/v1/sweeps/{id}/paper",
                 .handler = get_paper,
                 .operation_id = "getPaper",
                 .tag = "sweeps",
                 .summary = "The paper's seven statements compared with a sweep over clearance_mm, "
                            "crank_velocity_rad_s and coupler"},
                "PaperRows"),
      with_rows({.method = "GET",
                 .pattern = "/v1/sweeps/{id}/bifurcation",
                 .handler = get_bifurcation,
                 .operation_id = "getBifurcation",
                 .tag = "sweeps",
                 .summary = "Bifurcation diagram: a channel of every job once per revolution",
                 .query = {"channel", "angle", "phase_rad", "section_from"}},
                "BifurcationRows"),
      with_rows({.method = "GET",
                 .pattern = "/v1/sweeps/{id}/lyapunov",
                 .handler = get_lyapunov,
                 .operation_id = "getLyapunov",
                 .tag = "sweeps",
                 .summary = "The largest Lyapunov exponent of each set of replicates"},
                "LyapunovRows"),
      {.method = "GET",
       .pattern = "/v1/sweeps/{id}/report",
       .handler = get_report,
       .operation_id = "getReport",
       .tag = "sweeps",
       .summary = "Report of the sweep, one self-contained page: largest values, figures, tables, "
                  "provenance, and the command that repeats it",
       .query = {"metric", "report_x", "report_rows"},
       .headers = {"if_none_match"},
       .answers = {{kHtml, "Text"}},
       .bodiless = {304},
       .problems = {404, 422},
       .work = Work::kLarge},
      with_columns({.method = "GET",
                    .pattern = "/v1/jobs/{id}/spectrum",
                    .handler = get_spectrum,
                    .operation_id = "getSpectrum",
                    .tag = "jobs",
                    .summary = "Spectrum of a channel: amplitude and power density over frequency",
                    .query = {"channel", "window", "from", "to"}},
                   "Columns"),
      with_columns({.method = "GET",
                    .pattern = "/v1/jobs/{id}/poincare",
                    .handler = get_poincare,
                    .operation_id = "getPoincare",
                    .tag = "jobs",
                    .summary = "Poincare section of a job: channels once per revolution",
                    .query = {"channels", "angle", "phase_rad", "from", "to"}},
                   "Columns"),
      with_rows(
          {.method = "GET",
           .pattern = "/v1/jobs/{id}/wear",
           .handler = get_wear,
           .operation_id = "getWear",
           .tag = "jobs",
           .summary = "Wear map by Archard's law: worn depth around the bearing and along its length",
           .query = {"wear_joint", "wear_coefficient_m2_n", "sectors", "worn_clearance_mm", "from", "to"}},
          "WearRows"),
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
       .problems = {404, 422}, .work = Work::kLarge},
  };
}

std::vector<Route> make_measurement_routes() {
  return {
      {.method = "POST", .pattern = "/v1/measurements", .handler = post_measurement,
       .operation_id = "submitMeasurement", .tag = "measurements",
       .summary = "Store measured signals, or refuse them with the place of each fault",
       .query = {"measurement_name", "measurement_time", "measurement_channels",
                 "measurement_sensors", "measurement_parameters"},
       .headers = {"idempotency_key"}, .body = "MeasurementRequest",
       .other_bodies = {{kCsv, "Text"}, {kNpz, "Binary"}, {"application/octet-stream", "Binary"}},
       .success = 201, .answers = {{kJson, "Measurement"}}, .problems = {409, 422}},
      {.method = "GET", .pattern = "/v1/measurements", .handler = get_measurements,
       .operation_id = "listMeasurements", .tag = "measurements", .summary = "Measurements, the newest first",
       .query = {"limit", "cursor", "fields"}, .answers = {{kJson, "MeasurementPage"}}, .problems = {422}},
      {.method = "GET", .pattern = "/v1/measurements/{id}", .handler = get_measurement,
       .operation_id = "getMeasurement", .tag = "measurements",
       .summary = "Channels, runs, sampling and statistics of a measurement", .headers = {"if_none_match"},
       .answers = {{kJson, "Measurement"}}, .bodiless = {304}, .problems = {404, 422}},
      {.method = "GET", .pattern = "/v1/measurements/{id}/data", .handler = get_measurement_data,
       .operation_id = "getMeasurementData", .tag = "measurements",
       .summary = "Samples of a run of a measurement, as they were sent",
       .query = {"run", "channels", "from", "to", "points", "column_format"}, .headers = {"if_none_match"},
       .answers = {{kJson, "Columns"}, {kCsv, "Text"}, {kNpz, "Binary"}}, .bodiless = {304},
       .problems = {404, 422}, .work = Work::kLarge},
      {.method = "DELETE", .pattern = "/v1/measurements/{id}", .handler = delete_measurement,
       .operation_id = "deleteMeasurement", .tag = "measurements", .summary = "Delete a measurement",
       .success = 204, .problems = {404, 409, 422}},
  };
}

std::vector<Route> make_other_routes() {
  return {
      {.method = "POST", .pattern = "/v1/linkages/assembly", .handler = post_assembly,
       .operation_id = "assembleLinkage", .tag = "interface",
       .summary = "Poses of the links of a job at t = 0; nothing is stored", .body = "AssemblyRequest",
       .answers = {{kJson, "Assembly"}}, .problems = {422}},
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
                           make_optimisation_routes(), make_fit_routes(), make_analysis_routes(),
                           make_job_routes(),
                           make_measurement_routes(), make_other_routes()}) {
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
