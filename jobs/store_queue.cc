#include <algorithm>

#include "jobs/machine.h"
#include "jobs/program_info.h"
#include "jobs/store.h"
#include "jobs/time_text.h"
#include "jobs/trajectory_codec.h"

namespace jobs {
namespace {

constexpr std::int64_t kSingleJobs = 0;

/// The sweeps that have queued jobs; kSingleJobs if single jobs wait. Jumps from one sweep to the next in the index of
/// queued jobs, so its cost is that of their number, however many jobs each has.
std::vector<std::int64_t> find_waiting_sweeps(SQLite::Database& database) {
  SQLite::Statement waiting(database,
                            "WITH RECURSIVE next (sweep) AS ("
                            "  SELECT min(sweep) FROM jobs WHERE state = 'queued' AND sweep > 0"
                            "  UNION ALL"
                            "  SELECT (SELECT min(j.sweep) FROM jobs j WHERE j.state = 'queued' AND j.sweep > next.sweep) FROM next WHERE next.sweep IS NOT NULL)"
                            " SELECT sweep FROM next WHERE sweep IS NOT NULL"
                            " UNION ALL SELECT 0 WHERE EXISTS (SELECT 1 FROM jobs WHERE state = 'queued' AND sweep IS NULL)");
  std::vector<std::int64_t> sweeps;
  while (waiting.executeStep()) sweeps.push_back(waiting.getColumn(0).getInt64());
  return sweeps;
}

/// The first queued job of a sweep that need not wait for another one of the same content.
std::optional<ClaimedJob> find_claimable(SQLite::Database& database, std::int64_t sweep) {
  const std::string of_sweep = sweep == kSingleJobs ? "j.sweep IS NULL" : "j.sweep = ?1";
  SQLite::Statement first(database,
                          "SELECT j.seq, j.id, j.attempt, c.parameters FROM jobs j JOIN contents c ON c.seq = j.content WHERE j.state = 'queued' AND " + of_sweep +
                              " AND (j.reuse = 0 OR NOT EXISTS (SELECT 1 FROM jobs r WHERE r.content = j.content AND r.state = 'running'))"
                              " ORDER BY j.seq LIMIT 1");
  if (sweep != kSingleJobs) first.bind(1, sweep);
  if (!first.executeStep()) return std::nullopt;
  return ClaimedJob{.seq = first.getColumn(0).getInt64(), .id = first.getColumn(1).getString(),
                    .attempt = first.getColumn(2).getInt64() + 1, .parameters = first.getColumn(3).getString()};
}

std::int64_t content_of(SQLite::Database& database, const ClaimedJob& job) {
  SQLite::Statement find(database, "SELECT content FROM jobs WHERE seq = ?");
  find.bind(1, job.seq);
  find.executeStep();
  return find.getColumn(0).getInt64();
}

/// Whether the job still is what the worker took.
bool is_current(SQLite::Database& database, const ClaimedJob& job) {
  SQLite::Statement find(database, "SELECT 1 FROM jobs WHERE seq = ? AND id = ? AND attempt = ? AND state = 'running'");
  find.bind(1, job.seq);
  find.bind(2, job.id);
  find.bind(3, job.attempt);
  return find.executeStep();
}

std::int64_t insert_result(SQLite::Database& database, std::int64_t content, const RunRecord& record) {
  SQLite::Statement add(database,
                        "INSERT INTO results (content, metrics, error_reason, error_detail, error_t_s, wall_time_s, cpu_time_s, host, cpu, version, "
                        "\"commit\", compiler) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  add.bind(1, content);
  if (record.end == RunRecord::End::kSucceeded) {
    add.bind(2, record.metrics.dump());
  } else {
    add.bind(3, record.error_reason);
    add.bind(4, record.error_detail);
    if (record.error_t_s) add.bind(5, *record.error_t_s);
  }
  add.bind(6, record.wall_time_s);
  add.bind(7, record.cpu_time_s);
  add.bind(8, host_name());
  add.bind(9, cpu_name());
  add.bind(10, std::string(kProgramVersion));
  add.bind(11, std::string(kProgramCommit));
  add.bind(12, std::string(kProgramCompiler));
  add.exec();
  return database.getLastInsertRowid();
}

void insert_trajectory(SQLite::Database& database, std::int64_t result, const std::string& blob) {
  SQLite::Statement add(database, "INSERT INTO trajectories (result, data) VALUES (?, ?)");
  add.bind(1, result);
  add.bindNoCopy(2, blob.data(), static_cast<int>(blob.size()));
  add.exec();
}

void end_job(SQLite::Database& database, const ClaimedJob& job, JobState state, std::int64_t result, std::int64_t now_ms) {
  SQLite::Statement end(database, "UPDATE jobs SET state = ?, result = ?, ended_ms = ? WHERE seq = ? AND attempt = ? AND state = 'running'");
  end.bind(1, std::string(state_name(state)));
  end.bind(2, result);
  end.bind(3, now_ms);
  end.bind(4, job.seq);
  end.bind(5, job.attempt);
  end.exec();
}

/// Gives a new result to those who waited for it.
void settle_waiting(SQLite::Database& database, std::int64_t content, std::int64_t result, std::int64_t now_ms) {
  SQLite::Statement settle(database,
                           "UPDATE jobs SET state = 'succeeded', result = ?, reused = 1, started_ms = ?, ended_ms = ? "
                           "WHERE content = ? AND state = 'queued' AND reuse = 1");
  settle.bind(1, result);
  settle.bind(2, now_ms);
  settle.bind(3, now_ms);
  settle.bind(4, content);
  settle.exec();
}

}  // namespace

std::optional<ClaimedJob> Store::claim() {
  return writer_.write(Durability::kSurvivesProcess, [&](SQLite::Database& database) -> std::optional<ClaimedJob> {
    std::vector<std::int64_t> sweeps = find_waiting_sweeps(database);
    // Never served counts as longest ago; among those the oldest sweep comes first, since the sort is stable.
    std::ranges::stable_sort(sweeps, {}, [&](std::int64_t sweep) { return served_.contains(sweep) ? served_.at(sweep) : 0; });
    for (const std::int64_t sweep : sweeps) {
      auto job = find_claimable(database, sweep);
      if (!job) continue;
      SQLite::Statement take(database, "UPDATE jobs SET state = 'running', attempt = ?, started_ms = ? WHERE seq = ?");
      take.bind(1, job->attempt);
      take.bind(2, now_unix_ms());
      take.bind(3, job->seq);
      take.exec();
      served_[sweep] = ++claims_;
      return job;
    }
    return std::nullopt;
  });
}

bool Store::record(const ClaimedJob& job, const RunRecord& record) {
  const std::string blob = encode_trajectory(record.trajectory);  // outside of the lock
  const bool succeeded = record.end == RunRecord::End::kSucceeded;
  return writer_.write(Durability::kSurvivesProcess, [&](SQLite::Database& database) {
    if (!is_current(database, job)) return false;
    const std::int64_t now_ms = now_unix_ms();
    const std::int64_t content = content_of(database, job);
    const std::int64_t result = insert_result(database, content, record);
    if (!record.trajectory.columns.empty()) insert_trajectory(database, result, blob);
    end_job(database, job, succeeded ? JobState::kSucceeded : JobState::kFailed, result, now_ms);
    if (succeeded) settle_waiting(database, content, result, now_ms);
    return true;
  });
}

void Store::give_back(const ClaimedJob& job) {
  writer_.write(Durability::kSurvivesProcess, [&](SQLite::Database& database) {
    SQLite::Statement put_back(database, "UPDATE jobs SET state = 'queued', started_ms = NULL WHERE seq = ? AND id = ? AND attempt = ? AND state = 'running'");
    put_back.bind(1, job.seq);
    put_back.bind(2, job.id);
    put_back.bind(3, job.attempt);
    put_back.exec();
  });
}

}  // namespace jobs
