// SPDX-License-Identifier: Apache-2.0
#include "jobs/store/sweep_reader.h"

#include <algorithm>
#include <memory>
#include <span>
#include <system_error>

#include <nlohmann/json.hpp>
#include <sqlite3.h>

#include "jobs/base/time_text.h"
#include "jobs/store/read_rows.h"
#include "jobs/store/store_insert.h"
#include "jobs/store/sweep_order.h"

namespace jobs {
namespace {

std::optional<std::int64_t> optional_int(const SQLite::Column& column) {
  return column.isNull() ? std::nullopt : std::optional(column.getInt64());
}
std::optional<double> optional_double(const SQLite::Column& column) {
  return column.isNull() ? std::nullopt : std::optional(column.getDouble());
}
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

constexpr const char* kUnit = "1.0";
/// SQL of the time that a job simulates, whatever sweep it is of.
constexpr const char* kOwnTime =
    "(SELECT json_extract(c.parameters, '$.duration_s') FROM contents c WHERE c.seq = j.content)";

/// SQL of the time that a job simulates, if the sweep varies it; else 1.
std::string simulated_time(const std::string& swept) {
  const auto paths = nlohmann::json::parse(swept, nullptr, false);
  if (!paths.is_array()) return kUnit;
  const auto found = std::ranges::find(paths, "duration_s");
  if (found == paths.end()) return kUnit;
  return "coalesce(json_extract(j.swept, '$[" + std::to_string(found - paths.begin()) + "]'), 1.0)";
}

void read_running_costs(const SQLite::Database& database, std::int64_t sweep, const std::string& time,
                        Costs& costs) {
  SQLite::Statement running(database, "SELECT j.kind, " + time +
                                          ", j.started_ms, j.id FROM jobs j WHERE j.sweep IS ? AND j.state = "
                                          "'running'");
  if (sweep != kSingleJobs) running.bind(1, sweep);
  const std::int64_t now_ms = now_unix_ms();
  while (running.executeStep()) {
    const std::int64_t started_ms = optional_int(running.getColumn(2)).value_or(now_ms);
    costs[running.getColumn(0).getString()].running.push_back(
        {.simulated_s = running.getColumn(1).getDouble(),
         .elapsed_s = std::max(0.0, static_cast<double>(now_ms - started_ms) / 1000.0),
         .id = running.getColumn(3).getString()});
  }
}

/// @param sweep  kSingleJobs: those that wait or run; of these, the cost of what has ended is not looked at
Costs read_costs(const SQLite::Database& database, std::int64_t sweep, const std::string& time) {
  Costs costs;
  SQLite::Statement cost(
      database,
      "SELECT kind, sum(state = 'queued'), total(t) FILTER (WHERE state = 'queued'), "
      "total(t * t) FILTER (WHERE state = 'queued'), coalesce(max(t) FILTER (WHERE state = 'queued'), 0.0), "
      "count(cost), total(t) FILTER (WHERE cost IS NOT NULL), total(cost), total(cost / t), "
      "total(cost * cost / (t * t)) FROM (SELECT j.kind AS kind, j.state AS state, " +
          time +
          " AS t, r.wall_time_s AS cost FROM jobs j LEFT JOIN results r ON r.seq = j.result AND j.reused = 0 "
          "WHERE j.sweep IS ?" +
          (sweep == kSingleJobs ? " AND j.state = 'queued'" : "") + ") GROUP BY kind");
  if (sweep != kSingleJobs) cost.bind(1, sweep);
  while (cost.executeStep()) {
    costs[cost.getColumn(0).getString()] = {.queued = cost.getColumn(1).getInt64(),
                                            .queued_s = cost.getColumn(2).getDouble(),
                                            .queued_squares_s2 = cost.getColumn(3).getDouble(),
                                            .longest_queued_s = cost.getColumn(4).getDouble(),
                                            .computed = cost.getColumn(5).getInt64(),
                                            .computed_s = cost.getColumn(6).getDouble(),
                                            .wall_time_s = cost.getColumn(7).getDouble(),
                                            .rates = cost.getColumn(8).getDouble(),
                                            .rate_squares = cost.getColumn(9).getDouble()};
  }
  read_running_costs(database, sweep, time, costs);
  return costs;
}

/// The simulated time of every job of a sweep that does not vary it.
double read_unit(const SQLite::Database& database, std::int64_t sweep, const std::string& time) {
  if (time != kUnit) return 1.0;
  SQLite::Statement first(database,
                          "SELECT json_extract(c.parameters, '$.duration_s') FROM jobs j JOIN contents c ON "
                          "c.seq = j.content WHERE j.sweep = ? LIMIT 1");
  first.bind(1, sweep);
  return first.executeStep() ? optional_double(first.getColumn(0)).value_or(1.0) : 1.0;
}

/// The sweeps that have not ended, with what is left of them, read when it is first asked for.
class ActiveSweeps {
 public:
  explicit ActiveSweeps(const SQLite::Database& database) : database_(database) {}

  /// All but one, which has not ended.
  [[nodiscard]] std::vector<RivalSweep> rivals_of(std::int64_t sweep) {
    if (!is_read_) read();
    std::vector<RivalSweep> rivals;
    for (const auto& [seq, active] : active_)
      if (seq != sweep) rivals.push_back(active);
    return rivals;
  }

 private:
  void read() {
    is_read_ = true;
    SQLite::Statement list(
        database_,
        "SELECT seq, swept, priority, coalesce(executor, '') FROM sweeps s WHERE "
        "EXISTS (SELECT 1 FROM jobs WHERE sweep = s.seq AND state = 'queued') OR "
        "EXISTS (SELECT 1 FROM jobs WHERE sweep = s.seq AND state = 'running') "
        "UNION ALL SELECT 0, '', 0, '' WHERE "
        "EXISTS (SELECT 1 FROM jobs WHERE sweep IS NULL AND state IN ('queued', 'running'))");
    while (list.executeStep()) {
      const std::int64_t seq = list.getColumn(0).getInt64();
      const std::string time = seq == kSingleJobs ? kOwnTime : simulated_time(list.getColumn(1).getString());
      active_.emplace(seq, RivalSweep{.priority = list.getColumn(2).getInt64(),
                                      .executor = list.getColumn(3).getString(),
                                      .unit_s = seq == kSingleJobs ? 1.0 : read_unit(database_, seq, time),
                                      .costs = read_costs(database_, seq, time)});
    }
  }

  const SQLite::Database& database_;
  bool is_read_ = false;
  std::map<std::int64_t, RivalSweep> active_;
};

bool lacks_rate(const Costs& costs) {
  return std::ranges::any_of(costs, [](const auto& of_kind) {
    const CostOfKind& cost = of_kind.second;
    return cost.computed == 0 && (cost.queued > 0 || !cost.running.empty());
  });
}

/// What is left of a sweep, and of those that it shares the threads with.
void read_what_is_left(const SQLite::Database& database, std::int64_t seq, ActiveSweeps& active,
                       SweepRow& row) {
  const std::string time = simulated_time(row.swept);
  row.costs = read_costs(database, seq, time);
  row.unit_s = read_unit(database, seq, time);
  row.rivals = active.rivals_of(seq);
  if (lacks_rate(row.costs) ||
      std::ranges::any_of(row.rivals, [](const RivalSweep& rival) { return lacks_rate(rival.costs); }))
    row.usual_rates = read_cost_rates(database);
}

/// @param request  SQL of what stands in its column
std::string sweep_columns(const std::string& request) {
  return "SELECT seq, id, name, " + request +
         ", swept, replicated, priority, created_ms, coalesce(executor, ''), "
         "(SELECT c.id FROM searches c WHERE c.sweep = sweeps.seq) FROM sweeps";
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
  read_counts(database, seq, row);
  if (!has_ended(row.counts)) read_what_is_left(database, seq, active, row);
  return row;
}

std::optional<SweepRow> read_sweep_with(const SQLite::Database& database, const std::string& id,
                                        const std::string& request) {
  SQLite::Statement find(database, sweep_columns(request) + " WHERE id = ?");
  find.bind(1, id);
  ActiveSweeps active(database);
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

}  // namespace

std::optional<SweepRow> read_sweep(const SQLite::Database& database, const std::string& id) {
  return read_sweep_with(database, id, "request");
}

std::map<std::string, double> read_cost_rates(const SQLite::Database& database) {
  SQLite::Statement list(database,
                         "SELECT j.kind, avg(r.wall_time_s / json_extract(c.parameters, '$.duration_s')) "
                         "FROM (SELECT seq, content, wall_time_s FROM results WHERE error_reason IS NULL "
                         "ORDER BY seq DESC LIMIT 500) r "
                         "JOIN contents c ON c.seq = r.content JOIN jobs j ON j.result = r.seq AND "
                         "j.reused = 0 GROUP BY j.kind");
  std::map<std::string, double> rates;
  while (list.executeStep()) rates.emplace(list.getColumn(0).getString(), list.getColumn(1).getDouble());
  return rates;
}

std::optional<JobRow> read_job(const SQLite::Database& database, const std::string& id) {
  SQLite::Statement find(database, job_columns("c.parameters", "r.metrics") + " WHERE j.id = ?");
  find.bind(1, id);
  return find.executeStep() ? std::optional(job_row(find)) : std::nullopt;
}

std::optional<SweepRow> SweepReader::find_sweep(const std::string& id) const {
  return core_.readers.read([&](const SQLite::Database& database) { return read_sweep(database, id); });
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
    ActiveSweeps active(database);
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
    SQLite::Statement list(
        database,
        job_columns("''", "NULL") +
            " WHERE (?1 = '' OR j.id < ?1) AND (?2 = '' OR j.state = ?2) ORDER BY j.id DESC LIMIT ?3");
    list.bind(1, before);
    list.bind(2, state);
    list.bind(3, static_cast<std::int64_t>(limit));
    std::vector<JobRow> rows;
    while (list.executeStep()) rows.push_back(job_row(list));
    return rows;
  });
}

std::optional<SweepResults> read_results(const SQLite::Database& database, const std::string& sweep_id,
                                         RowParameters parameters) {
  auto sweep = read_sweep(database, sweep_id);
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
  return core_.readers.read(
      [&](const SQLite::Database& database) { return read_results(database, sweep_id, parameters); });
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
    auto sweep = read_sweep_with(database, sweep_id, "''");
    if (!sweep) return std::nullopt;
    SweepChanges changes{.sweep = std::move(*sweep), .ended = {}};
    SQLite::Statement list(database,
                           "SELECT j.change, j.id, j.state, r.error_reason, j.ended_ms, j.reused FROM jobs j "
                           "LEFT JOIN results r ON r.seq = j.result "
                           "WHERE j.sweep = (SELECT seq FROM sweeps WHERE id = ?) AND j.change > ? ORDER BY "
                           "j.change, j.seq");
    list.bind(1, sweep_id);
    list.bind(2, after);
    while (list.executeStep()) {
      changes.ended.push_back({.change = list.getColumn(0).getInt64(),
                               .id = list.getColumn(1).getString(),
                               .state = list.getColumn(2).getString(),
                               .error_reason = optional_text(list.getColumn(3)),
                               .ended_ms = list.getColumn(4).getInt64(),
                               .reused = list.getColumn(5).getInt() != 0});
    }
    return changes;
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
    sqlite3_blob* opened = nullptr;
    const int code = sqlite3_blob_open(database.getHandle(), "main", "trajectories", "data",
                                       find.getColumn(0).getInt64(), 0, &opened);
    const std::unique_ptr<sqlite3_blob, int (*)(sqlite3_blob*)> blob(opened, &sqlite3_blob_close);
    if (code != SQLITE_OK) throw SQLite::Exception(database.getHandle(), code);
    use({.size = static_cast<std::size_t>(sqlite3_blob_bytes(blob.get())),
         .read_to = [&](std::size_t offset, std::span<char> to) {
           const int error = sqlite3_blob_read(blob.get(), to.data(), static_cast<int>(to.size()),
                                               static_cast<int>(offset));
           if (error != SQLITE_OK) throw SQLite::Exception(database.getHandle(), error);
         }});
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
