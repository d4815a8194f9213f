#include <algorithm>

#include "jobs/machine.h"
#include "jobs/program_info.h"
#include "jobs/store.h"
#include "jobs/store_quota.h"
#include "jobs/time_text.h"
#include "jobs/trajectory_codec.h"

namespace jobs {
namespace {

constexpr std::int64_t kSingleJobs = 0;

/// A sweep that has queued jobs.
struct WaitingSweep {
  std::int64_t seq = kSingleJobs;
  std::int64_t priority = 0;
};

/// The sweeps that have queued jobs; kSingleJobs if single jobs wait. Jumps from one sweep to the next in the index of
/// queued jobs, so its cost is that of their number, however many jobs each has.
std::vector<WaitingSweep> find_waiting_sweeps(Statements& statements) {
  const auto waiting = statements.use(
      "WITH RECURSIVE next (sweep) AS ("
      "  SELECT min(sweep) FROM jobs WHERE state = 'queued' AND sweep > 0"
      "  UNION ALL"
      "  SELECT (SELECT min(j.sweep) FROM jobs j WHERE j.state = 'queued' AND j.sweep > next.sweep) FROM next WHERE next.sweep IS NOT NULL)"
      " SELECT next.sweep, s.priority FROM next JOIN sweeps s ON s.seq = next.sweep"
      " UNION ALL SELECT 0, 0 WHERE EXISTS (SELECT 1 FROM jobs WHERE state = 'queued' AND sweep IS NULL)");
  std::vector<WaitingSweep> sweeps;
  while (waiting->executeStep()) sweeps.push_back({.seq = waiting->getColumn(0).getInt64(), .priority = waiting->getColumn(1).getInt64()});
  return sweeps;
}

/// The first queued job of a sweep that need not wait for another one of the same content.
std::optional<ClaimedJob> find_claimable(Statements& statements, std::int64_t sweep) {
  const auto first = statements.use(
      sweep == kSingleJobs
          ? "SELECT j.seq, j.id, j.attempt, c.parameters FROM jobs j JOIN contents c ON c.seq = j.content WHERE j.state = 'queued' AND j.sweep IS NULL"
            " AND (j.reuse = 0 OR NOT EXISTS (SELECT 1 FROM jobs r WHERE r.content = j.content AND r.state = 'running')) ORDER BY j.seq LIMIT 1"
          : "SELECT j.seq, j.id, j.attempt, c.parameters FROM jobs j JOIN contents c ON c.seq = j.content WHERE j.state = 'queued' AND j.sweep = ?1"
            " AND (j.reuse = 0 OR NOT EXISTS (SELECT 1 FROM jobs r WHERE r.content = j.content AND r.state = 'running')) ORDER BY j.seq LIMIT 1");
  if (sweep != kSingleJobs) first->bind(1, sweep);
  if (!first->executeStep()) return std::nullopt;
  return ClaimedJob{.seq = first->getColumn(0).getInt64(), .id = first->getColumn(1).getString(),
                    .attempt = first->getColumn(2).getInt64() + 1, .parameters = first->getColumn(3).getString()};
}

/// The content of a job; empty if the job no longer is what the worker took.
std::optional<std::int64_t> content_if_current(Statements& statements, const ClaimedJob& job) {
  const auto find = statements.use("SELECT content FROM jobs WHERE seq = ? AND id = ? AND attempt = ? AND state = 'running'");
  find->bind(1, job.seq);
  find->bindNoCopy(2, job.id);
  find->bind(3, job.attempt);
  return find->executeStep() ? std::optional(find->getColumn(0).getInt64()) : std::nullopt;
}

/// @param metrics  JSON text
std::int64_t insert_result(Statements& statements, std::int64_t content, const RunRecord& record, const std::string& metrics) {
  const auto add = statements.use(
      "INSERT INTO results (content, metrics, error_reason, error_detail, error_t_s, wall_time_s, cpu_time_s, host, cpu, version, "
      "\"commit\", compiler) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?) RETURNING seq");
  add->bind(1, content);
  if (record.end == RunRecord::End::kSucceeded) {
    add->bindNoCopy(2, metrics);
  } else {
    add->bind(3, record.error_reason);
    add->bind(4, record.error_detail);
    if (record.error_t_s) add->bind(5, *record.error_t_s);
  }
  add->bind(6, record.wall_time_s);
  add->bind(7, record.cpu_time_s);
  add->bind(8, host_name());
  add->bind(9, cpu_name());
  add->bind(10, std::string(kProgramVersion));
  add->bind(11, std::string(kProgramCommit));
  add->bind(12, std::string(kProgramCompiler));
  add->executeStep();
  const std::int64_t result = add->getColumn(0).getInt64();
  add->executeStep();
  return result;
}

void insert_trajectory(Statements& statements, std::int64_t result, const std::string& blob) {
  const auto add = statements.use("INSERT INTO trajectories (result, data) VALUES (?, ?)");
  add->bind(1, result);
  add->bindNoCopy(2, blob.data(), static_cast<int>(blob.size()));
  add->exec();
}

void end_job(Statements& statements, const ClaimedJob& job, JobState state, std::int64_t result, std::int64_t now_ms, std::int64_t change) {
  const auto end = statements.use("UPDATE jobs SET state = ?, result = ?, ended_ms = max(?, started_ms), change = ? WHERE seq = ? AND attempt = ? AND state = 'running'");
  end->bind(1, std::string(state_name(state)));
  end->bind(2, result);
  end->bind(3, now_ms);
  end->bind(4, change);
  end->bind(5, job.seq);
  end->bind(6, job.attempt);
  end->exec();
}

/// Gives a new result to those who waited for it.
void settle_waiting(Statements& statements, std::int64_t content, std::int64_t result, std::int64_t now_ms, std::int64_t change) {
  const auto settle = statements.use(
      "UPDATE jobs SET state = 'succeeded', result = ?, reused = 1, started_ms = max(?, created_ms), ended_ms = max(?, created_ms), change = ? "
      "WHERE content = ? AND state = 'queued' AND reuse = 1");
  settle->bind(1, result);
  settle->bind(2, now_ms);
  settle->bind(3, now_ms);
  settle->bind(4, change);
  settle->bind(5, content);
  settle->exec();
}

}  // namespace

std::optional<ClaimedJob> Store::claim() {
  return writer_.write_often(Durability::kSurvivesProcess, [&](Statements& statements) -> std::optional<ClaimedJob> {
    std::vector<WaitingSweep> sweeps = find_waiting_sweeps(statements);
    // Never served counts as longest ago; among those the oldest sweep comes first, since the sort is stable.
    std::ranges::stable_sort(sweeps, {}, [&](const WaitingSweep& sweep) {
      return std::pair(-sweep.priority, served_.contains(sweep.seq) ? served_.at(sweep.seq) : 0);
    });
    for (const auto& [sweep, priority] : sweeps) {
      auto job = find_claimable(statements, sweep);
      if (!job) continue;
      const auto take = statements.use("UPDATE jobs SET state = 'running', attempt = ?, started_ms = max(?, created_ms) WHERE seq = ?");
      take->bind(1, job->attempt);
      take->bind(2, now_unix_ms());
      take->bind(3, job->seq);
      take->exec();
      served_[sweep] = ++claims_;
      return job;
    }
    return std::nullopt;
  });
}

bool Store::record(const ClaimedJob& job, const RunRecord& record) {
  // Outside of the lock: other threads compute in the meantime.
  const bool sampled = !record.trajectory.columns.empty();
  const std::string blob = sampled ? encode_trajectory(record.trajectory) : "";
  const bool succeeded = record.end == RunRecord::End::kSucceeded;
  const std::string metrics = succeeded ? record.metrics.dump() : "";
  return writer_.write_often(Durability::kSurvivesProcess, [&](Statements& statements) {
    const auto content = content_if_current(statements, job);
    if (!content) return false;
    const std::int64_t now_ms = now_unix_ms();
    const std::int64_t result = insert_result(statements, *content, record, metrics);
    if (sampled) insert_trajectory(statements, result, blob);
    end_job(statements, job, succeeded ? JobState::kSucceeded : JobState::kFailed, result, now_ms, ++changes_);
    if (succeeded) settle_waiting(statements, *content, result, now_ms, changes_);
    check_quota(*statements.use(kUsedBytesQuery).operator->(), room_, file_);
    return true;
  });
}

void Store::give_back(const ClaimedJob& job) {
  writer_.write_often(Durability::kSurvivesProcess, [&](Statements& statements) {
    const auto put_back = statements.use("UPDATE jobs SET state = 'queued', started_ms = NULL WHERE seq = ? AND id = ? AND attempt = ? AND state = 'running'");
    put_back->bind(1, job.seq);
    put_back->bind(2, job.id);
    put_back->bind(3, job.attempt);
    put_back->exec();
  });
}

}  // namespace jobs
