// SPDX-License-Identifier: Apache-2.0
#include "jobs/store/study_table.h"

#include <utility>

#include <SQLiteCpp/SQLiteCpp.h>

#include "jobs/base/errors.h"
#include "jobs/base/time_text.h"
#include "jobs/store/read_rows.h"
#include "jobs/store/store_insert.h"

namespace jobs {
namespace {

/// Each study belongs to the sweep of its evaluations, and is deleted with it. The table has the name of the
/// searches, which were the first type of study.
constexpr const char* kStudyQuery =
    "SELECT c.id, s.id, s.name, c.request, c.state, c.error, s.created_ms, c.ended_ms FROM searches c JOIN "
    "sweeps s ON s.seq = c.sweep";

StudyRow study_row(SQLite::Statement& found) {
  StudyRow row;
  row.id = found.getColumn(0).getString();
  row.sweep_id = found.getColumn(1).getString();
  row.name = found.getColumn(2).getString();
  row.request = found.getColumn(3).getString();
  row.state = found.getColumn(4).getString();
  if (!found.getColumn(5).isNull()) row.error = found.getColumn(5).getString();
  row.created_ms = found.getColumn(6).getInt64();
  if (!found.getColumn(7).isNull()) row.ended_ms = found.getColumn(7).getInt64();
  return row;
}

/// @returns the id
std::string insert_study(SQLite::Database& database, std::string id, std::int64_t sweep,
                         const std::string& request) {
  SQLite::Statement add(database, "INSERT INTO searches (sweep, id, request) VALUES (?, ?, ?)");
  add.bind(1, sweep);
  add.bind(2, id);
  add.bind(3, request);
  add.exec();
  return id;
}

/// @throws InvalidRequest if there is not each of the measurements
void check_measurements(SQLite::Database& database, const std::vector<std::string>& ids) {
  SQLite::Statement find(database, "SELECT 1 FROM measurements WHERE id = ?");
  for (std::size_t k = 0; k < ids.size(); ++k) {
    find.reset();
    find.bind(1, ids[k]);
    if (!find.executeStep())
      throw InvalidRequest(std::vector<Fault>{
          {"/measurements/" + std::to_string(k) + "/id", "there is no measurement " + ids[k]}});
  }
}

StudySnapshot read_snapshot(const SQLite::Database& database, const std::string& id,
                            ActiveSweepCache& active) {
  StudyRow study = read_study(database, id).value();
  auto results = read_results(database, study.sweep_id, RowParameters::kNone, active);
  return {.study = std::move(study), .results = std::move(results).value()};
}

}  // namespace

std::string StudyTable::add(std::string_view prefix, const SweepPlan& plan, const std::string& sweep_request,
                            const std::string& request, std::size_t max_queued,
                            const IdempotencyRecord<StudySnapshot>& idempotency,
                            const std::vector<std::string>& measurements) {
  return core_.writer.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    check_measurements(database, measurements);
    const std::int64_t now_ms = now_unix_ms();
    const std::string sweep_id = core_.ids.make(kSweepPrefix, now_ms);
    const std::int64_t sweep = insert_sweep(database, core_.ids, sweep_id, plan, sweep_request,
                                            {now_ms, ++core_.changes, max_queued});
    std::string id = insert_study(database, core_.ids.make(prefix, now_ms), sweep, request);
    respond(database, idempotency, [&] { return read_snapshot(database, id, core_.active); });
    core_.check_quota(database);
    return id;
  });
}

std::optional<StudyRow> read_study(const SQLite::Database& database, const std::string& id) {
  SQLite::Statement find(database, std::string(kStudyQuery) + " WHERE c.id = ?");
  find.bind(1, id);
  return find.executeStep() ? std::optional(study_row(find)) : std::nullopt;
}

std::optional<StudyRow> StudyTable::find(const std::string& id) const {
  return core_.readers.read([&](const SQLite::Database& database) { return read_study(database, id); });
}

std::vector<StudyRow> StudyTable::list(std::string_view prefix, const std::string& state,
                                       const std::string& before, std::size_t limit) const {
  return core_.readers.read([&](const SQLite::Database& database) {
    SQLite::Statement list(database,
        std::string(kStudyQuery) +
            " WHERE (?1 = '' OR c.id < ?1) AND (?2 = '' OR c.state = ?2) AND substr(c.id, 1, length(?4)) = "
            "?4 ORDER BY c.id DESC LIMIT ?3");
    list.bind(1, before);
    list.bind(2, state);
    list.bind(3, static_cast<std::int64_t>(limit));
    list.bind(4, std::string(prefix));
    std::vector<StudyRow> rows;
    while (list.executeStep()) rows.push_back(study_row(list));
    return rows;
  });
}

bool set_study_state(SQLite::Database& database, const std::string& id, const std::string& former,
                     const std::string& state, const std::optional<std::string>& error) {
  SQLite::Statement set(
      database,
      "UPDATE searches SET state = ?1, error = ?2, ended_ms = CASE ?1 WHEN 'running' THEN NULL ELSE "
      "max(?3, (SELECT created_ms FROM sweeps WHERE seq = searches.sweep), "
      "(SELECT coalesce(max(ended_ms), 0) FROM jobs WHERE jobs.sweep = searches.sweep)) END "
      "WHERE id = ?4 AND state = ?5");
  set.bind(1, state);
  if (error) set.bind(2, *error);
  set.bind(3, now_unix_ms());
  set.bind(4, id);
  set.bind(5, former);
  return set.exec() > 0;
}

void restart_study(SQLite::Database& database, std::int64_t sweep) {
  SQLite::Statement restart(
      database, "UPDATE searches SET state = 'running', error = NULL, ended_ms = NULL WHERE sweep = ?");
  restart.bind(1, sweep);
  restart.exec();
}

bool StudyTable::set_state(const std::string& id, const std::string& former, const std::string& state,
                           const std::optional<std::string>& error) {
  return core_.writer.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    return set_study_state(database, id, former, state, error);
  });
}

}  // namespace jobs
