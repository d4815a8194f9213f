// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/resource_json.h"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <set>
#include <string_view>

#include "jobs/base/errors.h"
#include "jobs/base/flat_json.h"
#include "jobs/base/ids.h"
#include "jobs/base/optional_json.h"
#include "jobs/base/provenance.h"
#include "jobs/base/study_kind.h"
#include "jobs/base/time_text.h"
#include "jobs/requests/metric_keys.h"
#include "jobs/requests/parameter_path.h"
#include "jobs/results/result_query.h"
#include "jobs/results/table_groups.h"
#include "jobs/results/time_left.h"

namespace jobs {
namespace {

using nlohmann::json;

json time_or_null(const std::optional<std::int64_t>& unix_ms) {
  return unix_ms ? json(time_text(*unix_ms)) : json();
}

json text_or_null(const std::string& text) { return text.empty() ? json() : json(text); }

json error_json(const std::string& reason, const std::string& detail, const std::optional<double>& t_s) {
  return {{"reason", reason}, {"detail", detail}, {"t_s", value_or_null(t_s)}};
}

json run_json(const RunRow& run, std::int64_t attempts, bool reused) {
  return {{"wall_time_s", run.wall_time_s}, {"cpu_time_s", run.cpu_time_s}, {"attempts", attempts},
          {"host", run.host}, {"cpu", run.cpu},
          {"libm", text_or_null(run.libm)}, {"numerics", text_or_null(run.numerics)},
          {"program", {{"version", run.version}, {"commit", run.commit}, {"compiler", run.compiler},
                       {"engine", run.engine}}},
          {"reused", reused}};
}

/// A run of this process.
RunRow own_run(const RunRecord& record) {
  const Provenance& own = own_provenance();
  return {.wall_time_s = record.wall_time_s,
          .cpu_time_s = record.cpu_time_s,
          .host = own.host,
          .cpu = own.cpu,
          .version = own.version,
          .commit = own.commit,
          .compiler = own.compiler,
          .engine = own.engine,
          .libm = own.libm,
          .numerics = own.numerics};
}

json job_links(const JobRow& row) {
  const std::string self = "/v1/jobs/" + row.id;
  return {{"self", self}, {"trajectory", self + "/trajectory"},
          {"sweep", row.sweep_id ? json("/v1/sweeps/" + *row.sweep_id) : json()}};
}

json study_path(const std::optional<std::string>& id) {
  if (!id) return nullptr;
  const auto kind = std::ranges::find_if(
      kStudyKinds, [&](const StudyKindInfo& one) { return id->starts_with(one.id_prefix); });
  return std::string(kind->path) + "/" + *id;
}

json sweep_links(const SweepRow& row) {
  const std::string self = "/v1/sweeps/" + row.id;
  return {{"self", self},
          {"results", self + "/results"},
          {"events", self + "/events"},
          {"cancel", self + "/cancel"},
          {"retry", self + "/retry"},
          {"extend", self + "/extend"},
          {"move", self + "/move"},
          {"study", study_path(row.study_id)}};
}

json counts_json(const StateCounts& counts) {
  json object = json::object();
  for (std::size_t i = 0; i < counts.size(); ++i) object[kJobStates[i]] = counts[i];
  object["total"] = std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
  return object;
}

double progress(const StateCounts& counts) {
  const auto total = std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
  const auto left = counts[static_cast<std::size_t>(JobState::kQueued)] +
                    counts[static_cast<std::size_t>(JobState::kRunning)];
  return static_cast<double>(total - left) / static_cast<double>(total);
}

json time_left_json(const SweepRow& row, int threads, std::string_view default_executor) {
  const auto left = estimate_time_left(row, threads, default_executor);
  if (!left) return {{"eta_s", nullptr}, {"eta_low_s", nullptr}, {"eta_high_s", nullptr}};
  return {{"eta_s", left->expected_s}, {"eta_low_s", left->low_s}, {"eta_high_s", left->high_s}};
}

/// Columns of the metrics in a table, by their keys.
using MetricColumns = std::map<std::string, std::size_t, std::less<>>;

MetricColumns metric_columns(const std::vector<std::string>& keys, std::size_t first) {
  MetricColumns columns;
  for (const std::string& key : keys) columns.emplace(key, first++);
  return columns;
}

/// Puts the metrics of a result into the cells of its row. False if the text is not as simple as it should
/// be.
bool put_flat_metrics(std::string_view text, const MetricColumns& columns, std::vector<json>& cells) {
  FlatJson flat(text);
  if (!flat.open('{')) return false;
  auto expected = columns.begin();  // the text has them in the same order, unless another program wrote it
  for (std::string_view key; flat.next_key(key);) {
    auto value = flat.value();
    if (!value) return false;
    if (expected == columns.end() || expected->first != key) expected = columns.find(key);
    if (expected == columns.end()) continue;
    cells[expected->second] = std::move(*value);
    ++expected;
  }
  return flat.close('}');
}

void put_metrics(const std::string& text, const MetricColumns& columns, std::vector<json>& cells) {
  if (put_flat_metrics(text, columns, cells)) return;
  const json metrics = stored_json(text);
  for (const auto& [key, column] : columns) cells[column] = metrics.value(key, json());
}

/// Appends the values of what is swept.
void append_swept(const std::string& text, std::vector<json>& cells) {
  FlatJson flat(text);
  const std::size_t before = cells.size();
  if (flat.open('[')) {
    for (json value; flat.next_value(value);) cells.push_back(std::move(value));
    if (flat.close(']')) return;
  }
  cells.resize(before);
  for (json& value : stored_json(text)) cells.push_back(std::move(value));
}

/// Appends what a query names beside what all tables have.
void append_others(const ResultRow& row, const std::vector<std::string>& others, std::vector<json>& cells) {
  const json completed = row.parameters.empty() ? json() : stored_json(row.parameters);
  for (const std::string& column : others) {
    if (is_error_column(column))
      cells.push_back(value_or_null(column == kErrorColumns.front() ? row.error_reason : row.error_detail));
    else cells.push_back(value_at_path(completed, column));
  }
}

/// Cells of a row up to its metrics, which are left empty. @param count  with the metrics
std::vector<json> make_own_cells(const ResultRow& row, bool replicated, std::size_t count) {
  std::vector<json> cells;
  cells.reserve(count);
  cells.emplace_back(row.job_id);
  cells.emplace_back(row.state);
  if (replicated) cells.push_back(value_or_null(row.replicate));
  append_swept(row.swept, cells);
  cells.resize(count);
  return cells;
}

/// Statistics of the replicates by their values in a column. Only jobs that succeeded have metrics, and a
/// peak may be null: the run ended before its window.
std::vector<ReplicateStatistics> compare_replicates(const std::vector<ResultRow>& rows,
                                                    const ResultTable& table, std::size_t column) {
  std::vector<ReplicateValue> values;
  values.reserve(rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r)
    values.push_back({.replicate = static_cast<std::size_t>(rows[r].replicate.value_or(0)),
                      .value = number_in(table.rows[r][column])});
  return calc_statistics_by_row(values);
}

/// Metrics of a sweep; those that its jobs have where a former version took what this one refuses.
std::vector<std::string> find_metric_keys(const json& request, const std::vector<ResultRow>& rows) {
  try {
    return metric_keys_of(request);
  } catch (const InvalidRequest&) {
    std::set<std::string> keys;
    for (const ResultRow& row : rows)
      if (row.metrics)
        for (const auto& [key, value] : stored_json(*row.metrics).items()) keys.insert(key);
    return {keys.begin(), keys.end()};
  }
}

}  // namespace

std::string text_of(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

json stored_json(const std::string& text) {
  json value = json::parse(text, nullptr, false);
  if (value.is_discarded()) throw StorageError("the store holds a text that is no JSON; it is damaged");
  return value;
}

json job_json(const JobRow& row, Detail detail, const std::vector<std::string>& wanted) {
  json job = json::object();
  const auto put = [&](const char* key, const auto& make) {
    if (wanted.empty() || std::ranges::find(wanted, key) != wanted.end()) job[key] = make();
  };
  put("id", [&] { return json(row.id); });
  put("sweep_id", [&] { return value_or_null(row.sweep_id); });
  put("state", [&] { return json(row.state); });
  put("error", [&] {
    return row.error_reason ? error_json(*row.error_reason, row.error_detail, row.error_t_s) : json();
  });
  put("attempts", [&] { return json(row.attempts); });
  put("created_at", [&] { return json(time_text(row.created_ms)); });
  put("started_at", [&] { return time_or_null(row.started_ms); });
  put("ended_at", [&] { return time_or_null(row.ended_ms); });
  put("run", [&] { return row.run ? run_json(*row.run, row.attempts, row.reused) : json(); });
  put("links", [&] { return job_links(row); });
  if (row.replicate) job["replicate"] = *row.replicate;
  if (detail == Detail::kFull) {
    job["parameters"] = stored_json(row.parameters);
    job["metrics"] = row.metrics ? stored_json(*row.metrics) : json();
  }
  return job;
}

json sweep_json(const SweepRow& row, int threads, Detail detail, std::string_view default_executor) {
  json sweep{{"id", row.id}, {"name", row.name}, {"notes", row.notes}, {"tags", stored_json(row.tags)},
             {"state", sweep_state(row.counts)},
             {"counts", counts_json(row.counts)},
             {"progress", progress(row.counts)}, {"priority", row.priority}, {"executor", row.executor},
             {"created_at", time_text(row.created_ms)}, {"started_at", time_or_null(row.started_ms)},
             {"ended_at", time_or_null(row.ended_ms)},
             {"axes", stored_json(row.swept)},
             {"study_id", value_or_null(row.study_id)},
             {"links", sweep_links(row)}};
  sweep.update(time_left_json(row, threads, default_executor));
  if (detail == Detail::kFull) sweep["request"] = stored_json(row.request);
  return sweep;
}

json unstored_job_json(const json& parameters, const RunRecord& record, std::int64_t started_ms,
                       std::int64_t ended_ms) {
  JobState state = JobState::kSucceeded;
  json error;
  if (record.end == RunRecord::End::kStopped) state = JobState::kCancelled;
  if (record.end == RunRecord::End::kFailed) {
    state = JobState::kFailed;
    error = error_json(record.error_reason, record.error_detail, record.error_t_s);
  }
  return {{"state", state_name(state)}, {"parameters", parameters}, {"metrics", record.metrics},
          {"error", error},
          {"created_at", time_text(started_ms)}, {"started_at", time_text(started_ms)},
          {"ended_at", time_text(ended_ms)},
          {"run", run_json(own_run(record), 1, false)}};
}

json progress_json(const SweepRow& row, int threads, std::string_view default_executor) {
  json progress_now{{"sweep_id", row.id}, {"state", sweep_state(row.counts)},
                    {"counts", counts_json(row.counts)}, {"progress", progress(row.counts)}};
  progress_now.update(time_left_json(row, threads, default_executor));
  return progress_now;
}

json study_json(const StudyRow& row, const std::string& route) {
  const std::string self = route + row.id;
  return {{"id", row.id}, {"name", row.name}, {"state", row.state}, {"error", value_or_null(row.error)},
          {"sweep_id", row.sweep_id}, {"created_at", time_text(row.created_ms)},
          {"ended_at", time_or_null(row.ended_ms)},
          {"links", {{"self", self}, {"results", self + "/results"}, {"cancel", self + "/cancel"},
                     {"retry", self + "/retry"}, {"events", self + "/events"},
                     {"sweep", "/v1/sweeps/" + row.sweep_id}}}};
}

std::vector<std::string> swept_of(const SweepRow& sweep) {
  return stored_json(sweep.swept).get<std::vector<std::string>>();
}

std::vector<std::string> keys_of(const json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

const std::vector<std::string>& sweep_listing_keys() {
  static const std::vector<std::string> keys = [] {
    SweepRow row;
    row.swept = "[]";
    return keys_of(sweep_json(row, 1, Detail::kListing));
  }();
  return keys;
}

const std::vector<std::string>& job_listing_keys() {
  static const std::vector<std::string> keys = [] {
    JobRow row;
    row.replicate = 0;
    return keys_of(job_json(row, Detail::kListing));
  }();
  return keys;
}

ResultTable result_table(const SweepResults& results, const std::vector<std::string>& others,
                         const std::string& replicate_metric) {
  const SweepRow& sweep = results.sweep;
  const json request = stored_json(sweep.request);
  const auto swept = swept_of(sweep);
  ResultTable table{.columns = {"job_id", "state"}, .rows = {}, .ended = has_ended(sweep.counts)};
  if (sweep.replicated) table.columns.emplace_back("replicate");
  table.columns.insert(table.columns.end(), swept.begin(), swept.end());
  const std::vector<std::string> keys = find_metric_keys(request, results.rows);
  const MetricColumns metrics = metric_columns(keys, table.columns.size());
  table.columns.insert(table.columns.end(), keys.begin(), keys.end());
  static_cast<void>(choose_metric(table, replicate_metric));
  const std::size_t own = table.columns.size();
  table.columns.insert(table.columns.end(), others.begin(), others.end());
  table.rows.reserve(results.rows.size());
  for (const ResultRow& row : results.rows) {
    std::vector<json> cells = make_own_cells(row, sweep.replicated, own);
    append_others(row, others, cells);
    if (row.metrics) put_metrics(*row.metrics, metrics, cells);
    table.rows.push_back(std::move(cells));
  }
  const bool repeated =
      std::ranges::any_of(results.rows, [](const ResultRow& row) { return row.replicate.value_or(0) > 0; });
  if (!repeated) return table;
  const std::string compared = choose_free_metric({{"request", request}}, table, replicate_metric);
  table.replicates = compare_replicates(results.rows, table, metrics.at(compared));
  return table;
}

}  // namespace jobs
