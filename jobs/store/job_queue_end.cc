// SPDX-License-Identifier: Apache-2.0
// Jobs and sweeps that are cancelled, retried, moved or deleted.
// SQL: the table searches holds the studies of all kinds, the column place of jobs is their batch_index, and
// a change below 0 is that of a former end, of a job that was queued again.

#include <algorithm>

#include "jobs/base/time_text.h"
#include "jobs/store/job_queue.h"
#include "jobs/store/read_rows.h"
#include "jobs/store/store_insert.h"

namespace jobs {
namespace {

std::vector<RunningJob> find_running(SQLite::Database& database, const char* column, const std::string& id) {
  SQLite::Statement find(
      database,
      std::string(
          "SELECT j.id, j.attempt FROM jobs j LEFT JOIN sweeps s ON s.seq = j.sweep "
          "WHERE j.state = 'running' AND ") +
          column + " = ?");
  find.bind(1, id);
  std::vector<RunningJob> running;
  while (find.executeStep())
    running.push_back({.id = find.getColumn(0).getString(), .attempt = find.getColumn(1).getInt64()});
  return running;
}

/// @param whose  SQL condition on the jobs, with one parameter
int cancel_where(SQLite::Database& database, const std::string& whose, const std::string& id,
                 std::int64_t change) {
  SQLite::Statement cancel(
      database,
      "UPDATE jobs SET state = 'cancelled', ended_ms = max(?, coalesce(started_ms, created_ms)), change = ?, "
      "batch = NULL, place = NULL "
      "WHERE state IN ('queued', 'running') AND " +
          whose);
  cancel.bind(1, now_unix_ms());
  cancel.bind(2, change);
  cancel.bind(3, id);
  return cancel.exec();
}

bool any_in_state(SQLite::Database& database, const std::string& condition, const std::string& id) {
  SQLite::Statement find(database, "SELECT 1 FROM jobs WHERE " + condition + " LIMIT 1");
  find.bind(1, id);
  return find.executeStep();
}

/// @param sweep  id of the sweep whose jobs are cancelled
Cancellation cancel_jobs_of(SQLite::Database& database, const std::string& sweep, std::int64_t change) {
  if (!find_sweep_seq(database, sweep)) return {};
  std::vector<RunningJob> running = find_running(database, "s.id", sweep);
  const std::string of_sweep = "sweep = (SELECT seq FROM sweeps WHERE id = ?)";
  const bool done = cancel_where(database, of_sweep, sweep, change) > 0 ||
                    any_in_state(database, "state = 'cancelled' AND " + of_sweep, sweep);
  return {.outcome = done ? CancelOutcome::kDone : CancelOutcome::kEnded, .running = std::move(running)};
}

std::vector<std::int64_t> find_numbers(SQLite::Database& database, const char* query, std::int64_t sweep) {
  SQLite::Statement find(database, query);
  find.bind(1, sweep);
  std::vector<std::int64_t> numbers;
  while (find.executeStep()) numbers.push_back(find.getColumn(0).getInt64());
  return numbers;
}

void run_for_each(SQLite::Database& database, const char* query, const std::vector<std::int64_t>& numbers) {
  SQLite::Statement statement(database, query);
  for (const std::int64_t number : numbers) {
    statement.reset();
    statement.bind(1, number);
    statement.exec();
  }
}

/// Deletes what a deletion of jobs leaves without any.
/// @param contents, results  those that the jobs had
void delete_unused(SQLite::Database& database, const std::vector<std::int64_t>& contents,
                   const std::vector<std::int64_t>& results) {
  run_for_each(database,
               "DELETE FROM results WHERE seq = ?1 AND NOT EXISTS (SELECT 1 FROM jobs WHERE result = ?1)",
               results);
  run_for_each(database,
               "DELETE FROM contents WHERE seq = ?1 AND NOT EXISTS (SELECT 1 FROM jobs WHERE content = ?1) "
               "AND NOT EXISTS (SELECT 1 FROM results WHERE content = ?1)",
               contents);
}

/// Deletes a job of no sweep. @param content  number of its content
void delete_single_job(SQLite::Database& database, std::int64_t job, std::int64_t content) {
  const auto results = find_numbers(database, "SELECT seq FROM results WHERE content = ?", content);
  run_for_each(database, "DELETE FROM jobs WHERE seq = ?", {job});
  delete_unused(database, {content}, results);
}

/// @param jobs  SQL of the numbers of the jobs, with one parameter, their sweep
void delete_jobs(SQLite::Database& database, const std::string& jobs, std::int64_t sweep) {
  const auto numbers = find_numbers(database, jobs.c_str(), sweep);
  const std::string of_jobs = " FROM jobs WHERE seq IN (" + jobs + ")";
  const auto contents = find_numbers(database, ("SELECT DISTINCT content" + of_jobs).c_str(), sweep);
  const auto results = find_numbers(
      database, ("SELECT seq FROM results WHERE content IN (SELECT content" + of_jobs + ")").c_str(), sweep);
  run_for_each(database, "DELETE FROM jobs WHERE seq = ?", numbers);
  delete_unused(database, contents, results);
}

/// @returns kDone if a sweep can be deleted, or the obstacle. @param sweep  its number
DeleteOutcome find_delete_outcome(SQLite::Database& database, std::int64_t sweep, const std::string& id,
                                  const std::string& study) {
  SQLite::Statement of_study(database, "SELECT 1 FROM searches WHERE sweep = ? AND id <> ?");
  of_study.bind(1, sweep);
  of_study.bind(2, study);
  if (of_study.executeStep()) return DeleteOutcome::kOfStudy;
  if (any_in_state(database,
                   "state IN ('queued', 'running') AND sweep = (SELECT seq FROM sweeps WHERE id = ?)", id))
    return DeleteOutcome::kNotEnded;
  return DeleteOutcome::kDone;
}

/// Queues the failed and cancelled jobs of a sweep again. @returns how many
int queue_again(SQLite::Database& database, std::int64_t sweep) {
  // The number of the former end is kept below 0: there it is none of an end, but never given again.
  SQLite::Statement queue(database,
                          "UPDATE jobs SET state = 'queued', result = NULL, reused = 0, change = -change, "
                          "started_ms = NULL, ended_ms = NULL "
                          "WHERE sweep = ? AND state IN ('failed', 'cancelled')");
  queue.bind(1, sweep);
  return queue.exec();
}

/// Ends the queued jobs of a sweep whose result is known.
void settle_known_jobs(SQLite::Database& database, std::int64_t sweep, std::int64_t change) {
  SQLite::Statement settle(database,
                           "UPDATE jobs SET state = 'succeeded', reused = 1, change = ?2, started_ms = "
                           "max(?3, created_ms), ended_ms = max(?3, created_ms), "
                           "result = (SELECT max(seq) FROM results r WHERE r.content = jobs.content AND "
                           "r.error_reason IS NULL) "
                           "WHERE sweep = ?1 AND state = 'queued' AND reuse = 1 "
                           "AND EXISTS (SELECT 1 FROM results r WHERE r.content = jobs.content AND "
                           "r.error_reason IS NULL)");
  settle.bind(1, sweep);
  settle.bind(2, change);
  settle.bind(3, now_unix_ms());
  settle.exec();
}

bool has_open_jobs(SQLite::Database& database, std::int64_t sweep) {
  SQLite::Statement left(database,
                         "SELECT 1 FROM jobs WHERE sweep = ? AND state IN ('queued', 'running') LIMIT 1");
  left.bind(1, sweep);
  return left.executeStep();
}

void change_executor(SQLite::Database& database, std::int64_t sweep, const std::string& executor) {
  SQLite::Statement move(database, "UPDATE sweeps SET executor = ? WHERE seq = ?");
  move.bind(1, executor);
  move.bind(2, sweep);
  move.exec();
}

void release_queued_jobs(SQLite::Database& database, std::int64_t sweep) {
  SQLite::Statement release(
      database,
      "UPDATE jobs SET batch = NULL, place = NULL WHERE sweep = ? AND state = 'queued' AND batch IS NOT "
      "NULL");
  release.bind(1, sweep);
  release.exec();
}

}  // namespace

Cancellation JobQueue::cancel_sweep(const std::string& id) {
  return core_.write_in_held_room(
      [&](SQLite::Database& database) { return cancel_jobs_of(database, id, ++core_.changes); });
}

Cancellation JobQueue::cancel_study(const std::string& id) {
  return core_.write_in_held_room([&](SQLite::Database& database) -> Cancellation {
    const auto study = read_study(database, id);
    if (!study) return {};
    Cancellation cancellation = cancel_jobs_of(database, study->sweep_id, ++core_.changes);
    set_study_state(database, id, "running", "cancelled");
    return cancellation;
  });
}

Cancellation JobQueue::cancel_job(const std::string& id) {
  return core_.write_in_held_room([&](SQLite::Database& database) -> Cancellation {
    if (!any_in_state(database, "id = ?", id)) return {};
    std::vector<RunningJob> running = find_running(database, "j.id", id);
    const bool done = cancel_where(database, "id = ?", id, ++core_.changes) > 0 ||
                      any_in_state(database, "state = 'cancelled' AND id = ?", id);
    return {.outcome = done ? CancelOutcome::kDone : CancelOutcome::kEnded, .running = std::move(running)};
  });
}

bool JobQueue::retry_sweep(const std::string& id, std::size_t max_queued) {
  return core_.writer.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    const auto sweep = find_sweep_seq(database, id);
    if (!sweep) return false;
    restart_study(database, *sweep);
    if (queue_again(database, *sweep) == 0) return true;
    rekey_queued_jobs(database);
    settle_known_jobs(database, *sweep, ++core_.changes);
    check_queue_limit(database, max_queued);
    core_.check_quota(database);
    return true;
  });
}

bool JobQueue::move_sweep(const std::string& id, const std::string& executor) {
  return core_.writer.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    const auto sweep = find_sweep_seq(database, id);
    if (!sweep) return false;
    if (!has_open_jobs(database, *sweep)) throw WrongState("the sweep has ended");
    change_executor(database, *sweep, executor);
    release_queued_jobs(database, *sweep);
    return true;
  });
}

DeleteOutcome JobQueue::delete_job(const std::string& id) {
  return core_.write_in_held_room([&](SQLite::Database& database) {
    SQLite::Statement find(database,
                           "SELECT seq, content, sweep IS NOT NULL, state IN ('queued', 'running') FROM jobs "
                           "WHERE id = ?");
    find.bind(1, id);
    if (!find.executeStep()) return DeleteOutcome::kMissing;
    const std::int64_t job = find.getColumn(0).getInt64();
    const std::int64_t content = find.getColumn(1).getInt64();
    if (find.getColumn(2).getInt() != 0) return DeleteOutcome::kOfSweep;
    if (find.getColumn(3).getInt() != 0) return DeleteOutcome::kNotEnded;
    find.reset();
    delete_single_job(database, job, content);
    return DeleteOutcome::kDone;
  });
}

DeleteOutcome JobQueue::delete_sweep(const std::string& id, const std::string& study) {
  const auto delete_rest = [&](SQLite::Database& database) { return delete_sweep(database, id, study); };
  try {
    return core_.writer.write(Durability::kSurvivesPowerLoss, delete_rest);
  } catch (const StorageError& error) {
    if (!error.full) throw;
  }
  // In the log a deletion takes more room than it frees. The room that is held is enough for some jobs at a
  // time, and the sweep has fewer jobs if the rest fails.
  const StoreLock::LentRoom lent(core_.lock);
  core_.writer.empty_log();
  while (delete_some_jobs(id, study)) core_.writer.empty_log();
  core_.writer.empty_log();
  return core_.writer.write(Durability::kSurvivesPowerLoss, delete_rest);
}

DeleteOutcome JobQueue::delete_sweep(SQLite::Database& database, const std::string& id,
                                     const std::string& study) {
  const auto sweep = find_sweep_seq(database, id);
  if (!sweep) return DeleteOutcome::kMissing;
  const DeleteOutcome outcome = find_delete_outcome(database, *sweep, id, study);
  if (outcome != DeleteOutcome::kDone) return outcome;
  delete_jobs(database, "SELECT seq FROM jobs WHERE sweep = ?1", *sweep);
  run_for_each(database, "DELETE FROM sweeps WHERE seq = ?", {*sweep});
  core_.served.erase(*sweep);
  return DeleteOutcome::kDone;
}

bool JobQueue::delete_some_jobs(const std::string& id, const std::string& study) {
  return core_.writer.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    const auto sweep = find_sweep_seq(database, id);
    if (!sweep || find_delete_outcome(database, *sweep, id, study) != DeleteOutcome::kDone) return false;
    // The first one goes with the sweep, which would not be one without jobs.
    delete_jobs(database,
                "SELECT seq FROM (SELECT seq FROM jobs WHERE sweep = ?1 AND seq > (SELECT min(seq) FROM jobs "
                "WHERE sweep = ?1) ORDER BY seq DESC LIMIT 8)",
                *sweep);
    SQLite::Statement left(database, "SELECT 1 FROM jobs WHERE sweep = ? LIMIT 1 OFFSET 1");
    left.bind(1, *sweep);
    return left.executeStep();
  });
}

}  // namespace jobs
