// SPDX-License-Identifier: Apache-2.0
// SQL: the table searches holds the studies of all kinds. A change of jobs below 0 is that of a former end,
// of a job that was queued again.
#include "jobs/store/sweep_reader.h"

#include <algorithm>
#include <memory>
#include <span>
#include <system_error>

#include <sqlite3.h>

#include "jobs/store/active_sweeps.h"
#include "jobs/store/read_rows.h"
#include "jobs/store/store_insert.h"

namespace jobs {
namespace {

std::optional<std::string> optional_text(const SQLite::Column& column) {
  return column.isNull() ? std::nullopt : std::optional(column.getString());
}

std::size_t state_index(const std::string& state) {
  for (std::size_t i = 0; i < kJobStates.size(); ++i) {
    if (state == kJobStates[i]) return i;
  }
  throw StorageError("the store holds an unknown state: " + state);
}

void read_counts(const SQLite::Database& database, std::int64_t sweep, SweepRow& row) {
  SQLite::Statement count(
      database,
      "SELECT state, count(*), min(started_ms), max(ended_ms) FROM jobs WHERE sweep = ? GROUP BY state");
  count.bind(1, sweep);
  while (count.executeStep()) {
    row.counts[state_index(count.getColumn(0).getString())] = count.getColumn(1).getInt64();
    const auto started = optional_int(count.getColumn(2));
    const auto ended = optional_int(count.getColumn(3));
    if (started) row.started_ms = std::min(*started, row.started_ms.value_or(*started));
    if (ended) row.ended_ms = std::max(*ended, row.ended_ms.value_or(*ended));
  }
  if (!has_ended(row.counts)) row.ended_ms.reset();
}

/// @param request  SQL of what stands in its column
std::string sweep_columns(const std::string& request) {
  return "SELECT seq, id, name, " + request +
         ", swept, replicated, priority, created_ms, coalesce(executor, ''), "
         "(SELECT c.id FROM searches c WHERE c.sweep = sweeps.seq), notes, tags FROM sweeps";
}

SweepRow sweep_row(const SQLite::Database& database, SQLite::Statement& found, ActiveSweeps& active) {
  SweepRow row;
  const std::int64_t seq = found.getColumn(0).getInt64();
  row.id = found.getColumn(1).getString();
  row.name = found.getColumn(2).getString();
  row.request = found.getColumn(3).getString();
  row.swept = found.getColumn(4).getString();
  row.replicated = found.getColumn(5).getInt() != 0;
  row.priority = found.getColumn(6).getInt64();
  row.created_ms = found.getColumn(7).getInt64();
  row.executor = found.getColumn(8).getString();
  row.study_id = optional_text(found.getColumn(9));
  row.notes = found.getColumn(10).getString();
  row.tags = found.getColumn(11).getString();
  read_counts(database, seq, row);
  if (!has_ended(row.counts)) active.read_what_is_left(seq, row);
  return row;
}

std::optional<SweepRow> read_sweep_with(const SQLite::Database& database, const std::string& id,
                                        const std::string& request, ActiveSweepCache& cache) {
  SQLite::Statement find(database, sweep_columns(request) + " WHERE id = ?");
  find.bind(1, id);
  ActiveSweeps active(database, cache);
  return find.executeStep() ? std::optional(sweep_row(database, find, active)) : std::nullopt;
}

/// @param parameters, metrics  SQL of what stands in their columns
std::string job_columns(const std::string& parameters, const std::string& metrics) {
  return "SELECT j.id, s.id, j.replicate, j.state, j.created_ms, j.started_ms, j.ended_ms, j.attempt, "
         "j.reused, r.error_reason, r.error_detail, "
         "r.error_t_s, r.seq, r.wall_time_s, r.cpu_time_s, r.host, r.cpu, r.version, r.\"commit\", "
         "r.compiler, c.engine_version, r.libm, r.numerics, " +
         parameters + ", " + metrics +
         " FROM jobs j LEFT JOIN sweeps s ON s.seq = j.sweep LEFT JOIN results r ON r.seq = j.result JOIN "
         "contents c ON c.seq = j.content";
}

RunRow read_run(SQLite::Statement& found) {
  return {.wall_time_s = found.getColumn(13).getDouble(), .cpu_time_s = found.getColumn(14).getDouble(),
          .host = found.getColumn(15).getString(), .cpu = found.getColumn(16).getString(),
          .version = found.getColumn(17).getString(),
          .commit = found.getColumn(18).getString(), .compiler = found.getColumn(19).getString(),
          .engine = found.getColumn(20).getString(), .libm = found.getColumn(21).getString(),
          .numerics = found.getColumn(22).getString()};
}

JobRow job_row(SQLite::Statement& found) {
  JobRow row;
  row.id = found.getColumn(0).getString();
  row.sweep_id = optional_text(found.getColumn(1));
  row.replicate = optional_int(found.getColumn(2));
  row.state = found.getColumn(3).getString();
  row.created_ms = found.getColumn(4).getInt64();
  row.started_ms = optional_int(found.getColumn(5));
  row.ended_ms = optional_int(found.getColumn(6));
  row.attempts = found.getColumn(7).getInt64();
  row.reused = found.getColumn(8).getInt() != 0;
  row.error_reason = optional_text(found.getColumn(9));
  row.error_detail = found.getColumn(10).getString();
  row.error_t_s = optional_double(found.getColumn(11));
  if (!found.getColumn(12).isNull()) row.run = read_run(found);
  row.parameters = found.getColumn(23).getString();
  row.metrics = optional_text(found.getColumn(24));
  return row;
}

/// @param parameters  SQL of what stands in their column
std::string result_columns(const std::string& parameters) {
  return "SELECT j.id, j.state, j.swept, j.replicate, r.metrics, " + parameters +
         ", max(coalesce(j.change, 0), 0), r.error_reason, r.error_detail FROM jobs j LEFT JOIN results r ON "
         "r.seq = j.result";
}

constexpr const char* kOfSweep = " WHERE j.sweep = (SELECT seq FROM sweeps WHERE id = ?)";

ResultRow result_row(SQLite::Statement& found) {
  return {.job_id = found.getColumn(0).getString(),
          .state = found.getColumn(1).getString(),
          .swept = found.getColumn(2).getString(),
          .replicate = optional_int(found.getColumn(3)),
          .metrics = optional_text(found.getColumn(4)),
          .parameters = found.getColumn(5).getString(),
          .change = found.getColumn(6).getInt64(),
          .error_reason = optional_text(found.getColumn(7)),
          .error_detail = optional_text(found.getColumn(8))};
}

EndedJob ended_job(SQLite::Statement& found) {
  return {.change = found.getColumn(0).getInt64(),
          .id = found.getColumn(1).getString(),
          .state = found.getColumn(2).getString(),
          .error_reason = optional_text(found.getColumn(3)),
          .ended_ms = found.getColumn(4).getInt64(),
          .reused = found.getColumn(5).getInt() != 0};
}

/// By its name alone: to open and close a file takes away SQLite's locks on it.
std::int64_t size_or_zero(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  return error ? 0 : static_cast<std::int64_t>(size);
}

/// SQL of the condition that a sweep is in a state, as sweep_state() has it: a look into an index for each
/// state of jobs, however many jobs there are. Empty: every sweep.
std::string state_condition(const std::string& state) {
  const auto has = [](const char* job_state) {
    return "EXISTS (SELECT 1 FROM jobs j WHERE j.sweep = sweeps.seq AND j.state = '" +
           std::string(job_state) + "')";
  };
  const std::string open = "(" + has("queued") + " OR " + has("running") + ")";
  const std::string ended_some =
      "(" + has("succeeded") + " OR " + has("failed") + " OR " + has("cancelled") + ")";
  if (state.empty()) return "1";
  if (state == "queued") return has("queued") + " AND NOT " + has("running") + " AND NOT " + ended_some;
  if (state == "running") return has("running") + " OR " + has("queued") + " AND " + ended_some;
  if (state == "cancelled") return has("cancelled") + " AND NOT " + open;
  if (state == "failed") return has("failed") + " AND NOT " + has("cancelled") + " AND NOT " + open;
  return "NOT " + open + " AND NOT " + has("failed") + " AND NOT " + has("cancelled");
}

/// SQL of the condition on the jobs of a listing. Nearly all jobs have succeeded, so those of another state
/// are found by an index that holds few others: a walk back through all ids could pass by a million.
/// ?1 is an id that theirs are below, ?2 how many are listed.
std::string job_condition(const std::string& state) {
  if (state.empty()) return "j.id < ?1";
  const std::string newest = " WHERE +id < ?1 ORDER BY +id DESC LIMIT ?2)";  // not by the index of all ids
  if (state == "queued")
    return "j.seq IN (SELECT seq FROM (SELECT seq, id FROM jobs WHERE state = 'queued' AND batch IS NULL "
           "UNION ALL SELECT seq, id FROM jobs WHERE state = 'queued' AND batch IS NOT NULL)" +
           newest;
  if (state == "running")
    return "j.seq IN (SELECT seq FROM (SELECT seq, id FROM jobs WHERE state = 'running')" + newest;
  return "j.id < ?1 AND j.state = '" + std::string(kJobStates[state_index(state)]) + "'";
}

/// The ends of a sweep's jobs after a change.
std::vector<EndedJob> read_ended(const SQLite::Database& database, const std::string& sweep_id,
                                 std::int64_t after) {
  SQLite::Statement list(database,
                         "SELECT j.change, j.id, j.state, r.error_reason, j.ended_ms, j.reused FROM jobs j "
                         "LEFT JOIN results r ON r.seq = j.result "
                         "WHERE j.sweep = (SELECT seq FROM sweeps WHERE id = ?) AND j.change > ? ORDER BY "
                         "j.change, j.seq");
  list.bind(1, sweep_id);
  list.bind(2, after);
  std::vector<EndedJob> ended;
  while (list.executeStep()) ended.push_back(ended_job(list));
  return ended;
}

using BlobPointer = std::unique_ptr<sqlite3_blob, int (*)(sqlite3_blob*)>;

BlobPointer open_trajectory(const SQLite::Database& database, std::int64_t result) {
  sqlite3_blob* opened = nullptr;
  const int code =
      sqlite3_blob_open(database.getHandle(), "main", "trajectories", "data", result, 0, &opened);
  BlobPointer blob(opened, &sqlite3_blob_close);
  if (code != SQLITE_OK) throw SQLite::Exception(database.getHandle(), code);
  return blob;
}

/// @param blob  outlives what is returned
StoredBytes bytes_of_blob(const SQLite::Database& database, sqlite3_blob* blob) {
  return {.size = static_cast<std::size_t>(sqlite3_blob_bytes(blob)),
          .read_to = [&database, blob](std::size_t offset, std::span<char> to) {
            const int error = sqlite3_blob_read(blob, to.data(), static_cast<int>(to.size()),
                                                static_cast<int>(offset));
            if (error != SQLITE_OK) throw SQLite::Exception(database.getHandle(), error);
          }};
}

}  // namespace

std::optional<SweepRow> read_sweep(const SQLite::Database& database, const std::string& id,
                                   ActiveSweepCache& cache) {
  return read_sweep_with(database, id, "request", cache);
}

std::optional<JobRow> read_job(const SQLite::Database& database, const std::string& id) {
  SQLite::Statement find(database, job_columns("c.parameters", "r.metrics") + " WHERE j.id = ?");
  find.bind(1, id);
  return find.executeStep() ? std::optional(job_row(find)) : std::nullopt;
}

std::optional<SweepRow> SweepReader::find_sweep(const std::string& id) const {
  return core_.readers.read(
      [&](const SQLite::Database& database) { return read_sweep(database, id, core_.active); });
}

PlanCosts SweepReader::find_costs(const SweepPlan& plan) const {
  return core_.readers.read(
      [&](const SQLite::Database& database) { return read_plan_costs(database, plan); });
}

std::optional<bool> SweepReader::has_sweep_ended(const std::string& id) const {
  return core_.readers.read_often([&](Statements& statements) -> std::optional<bool> {
    const auto find = statements.use(
        "SELECT EXISTS (SELECT 1 FROM jobs WHERE sweep = s.seq AND state = 'queued') "
        "OR EXISTS (SELECT 1 FROM jobs WHERE sweep = s.seq AND state = 'running') FROM sweeps s WHERE s.id = "
        "?");
    find->bindNoCopy(1, id);
    return find->executeStep() ? std::optional(find->getColumn(0).getInt() == 0) : std::nullopt;
  });
}

std::vector<SweepRow> SweepReader::list_sweeps(const std::string& state, const std::string& before,
                                               std::size_t limit) const {
  return core_.readers.read([&](const SQLite::Database& database) {
    SQLite::Statement list(database, sweep_columns("''") + " WHERE (?1 = '' OR id < ?1) AND (" +
                                         state_condition(state) + ") ORDER BY id DESC");
    list.bind(1, before);
    std::vector<SweepRow> rows;
    ActiveSweeps active(database, core_.active);
    while (rows.size() < limit && list.executeStep()) rows.push_back(sweep_row(database, list, active));
    return rows;
  });
}

std::optional<JobRow> SweepReader::find_job(const std::string& id) const {
  return core_.readers.read([&](const SQLite::Database& database) { return read_job(database, id); });
}

std::optional<bool> SweepReader::has_job_ended(const std::string& id) const {
  return core_.readers.read_often([&](Statements& statements) -> std::optional<bool> {
    const auto find = statements.use("SELECT state NOT IN ('queued', 'running') FROM jobs WHERE id = ?");
    find->bindNoCopy(1, id);
    return find->executeStep() ? std::optional(find->getColumn(0).getInt() != 0) : std::nullopt;
  });
}

std::vector<JobRow> SweepReader::list_jobs(const std::string& state, const std::string& before,
                                           std::size_t limit) const {
  return core_.readers.read([&](const SQLite::Database& database) {
    constexpr const char* kAboveAllIds = "~";
    SQLite::Statement list(database, job_columns("''", "NULL") + " WHERE " + job_condition(state) +
                                         " ORDER BY j.id DESC LIMIT ?2");
    list.bind(1, before.empty() ? kAboveAllIds : before);
    list.bind(2, static_cast<std::int64_t>(limit));
    std::vector<JobRow> rows;
    while (list.executeStep()) rows.push_back(job_row(list));
    return rows;
  });
}

std::optional<SweepResults> read_results(const SQLite::Database& database, const std::string& sweep_id,
                                         RowParameters parameters, ActiveSweepCache& cache) {
  auto sweep = read_sweep(database, sweep_id, cache);
  if (!sweep) return std::nullopt;
  SweepResults results{.sweep = std::move(*sweep), .rows = {}};
  const bool all = parameters == RowParameters::kAll;
  const std::string contents = all ? " JOIN contents c ON c.seq = j.content" : "";
  SQLite::Statement list(
      database, result_columns(all ? "c.parameters" : "''") + contents + kOfSweep + " ORDER BY j.seq");
  list.bind(1, sweep_id);
  while (list.executeStep()) results.rows.push_back(result_row(list));
  return results;
}

std::optional<SweepResults> SweepReader::find_results(const std::string& sweep_id,
                                                      RowParameters parameters) const {
  return core_.readers.read([&](const SQLite::Database& database) {
    return read_results(database, sweep_id, parameters, core_.active);
  });
}

std::vector<ResultRow> SweepReader::find_ended(const std::string& sweep_id, std::int64_t after) const {
  return core_.readers.read([&](const SQLite::Database& database) {
    SQLite::Statement list(database,
                           result_columns("''") + kOfSweep + " AND j.change > ? ORDER BY j.change, j.seq");
    list.bind(1, sweep_id);
    list.bind(2, after);
    std::vector<ResultRow> rows;
    while (list.executeStep()) rows.push_back(result_row(list));
    return rows;
  });
}

std::optional<SweepChanges> SweepReader::find_changes(const std::string& sweep_id, std::int64_t after) const {
  return core_.readers.read([&](const SQLite::Database& database) -> std::optional<SweepChanges> {
    auto sweep = read_sweep_with(database, sweep_id, "''", core_.active);
    if (!sweep) return std::nullopt;
    return SweepChanges{.sweep = std::move(*sweep), .ended = read_ended(database, sweep_id, after)};
  });
}

std::optional<std::string> SweepReader::find_trajectory(const std::string& job_id) const {
  return core_.readers.read([&](const SQLite::Database& database) -> std::optional<std::string> {
    SQLite::Statement find(
        database, "SELECT t.data FROM jobs j JOIN trajectories t ON t.result = j.result WHERE j.id = ?");
    find.bind(1, job_id);
    if (!find.executeStep()) return std::nullopt;
    const SQLite::Column data = find.getColumn(0);
    return std::string(static_cast<const char*>(data.getBlob()), static_cast<std::size_t>(data.getBytes()));
  });
}

bool SweepReader::read_trajectory(const std::string& job_id,
                                  const std::function<void(const StoredBytes&)>& use) const {
  return core_.readers.read([&](const SQLite::Database& database) {
    SQLite::Statement find(
        database, "SELECT t.result FROM jobs j JOIN trajectories t ON t.result = j.result WHERE j.id = ?");
    find.bind(1, job_id);
    if (!find.executeStep()) return false;
    const BlobPointer blob = open_trajectory(database, find.getColumn(0).getInt64());
    use(bytes_of_blob(database, blob.get()));
    return true;
  });
}

void SweepReader::check() const {
  core_.writer.check_file();
  core_.readers.read_often([](Statements& statements) {
    statements.use("SELECT 1 FROM sweeps LIMIT 1")->executeStep();
  });
}

QueueStats SweepReader::read_queue_stats() const {
  return core_.readers.read([&](const SQLite::Database& database) {
    SQLite::Statement count(database, std::string("SELECT (") + kQueuedCount +
                                          "), (SELECT count(*) FROM jobs WHERE state = 'running')");
    count.executeStep();
    const std::filesystem::path file = database.getFilename();
    return QueueStats{.queued = count.getColumn(0).getInt64(), .running = count.getColumn(1).getInt64(),
                .store_bytes = size_or_zero(file) + size_or_zero(file.string() + "-wal")};
  });
}

}  // namespace jobs
