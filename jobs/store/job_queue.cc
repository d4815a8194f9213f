// SPDX-License-Identifier: Apache-2.0
#include "jobs/store/job_queue.h"

#include <iterator>
#include <utility>

#include "jobs/base/time_text.h"
#include "jobs/store/store_results.h"
#include "jobs/store/sweep_order.h"
#include "jobs/trajectories/trajectory_codec.h"

namespace jobs {
namespace {

/// The first queued job of a sweep that need not wait for another one of the same content.
std::optional<ClaimedJob> find_claimable(Statements& statements, std::int64_t sweep) {
  static const std::string query =
      std::string(
          "SELECT j.seq, j.id, j.attempt, c.parameters FROM jobs j JOIN contents c ON c.seq = j.content "
          "WHERE j.state = 'queued' AND j.batch IS NULL AND j.sweep IS ?1 AND ") +
      kNobodyComputesIt + " ORDER BY j.seq LIMIT 1";
  const auto first = statements.use(query.c_str());
  if (sweep != kSingleJobs) first->bind(1, sweep);
  if (!first->executeStep()) return std::nullopt;
  return ClaimedJob{.seq = first->getColumn(0).getInt64(),
                    .id = first->getColumn(1).getString(),
                    .attempt = first->getColumn(2).getInt64() + 1,
                    .parameters = first->getColumn(3).getString()};
}

bool has_queued_jobs(Statements& statements, std::int64_t sweep) {
  const auto first =
      statements.use("SELECT 1 FROM jobs WHERE state = 'queued' AND batch IS NULL AND sweep IS ?1 LIMIT 1");
  if (sweep != kSingleJobs) first->bind(1, sweep);
  return first->executeStep();
}

void begin_job(Statements& statements, const ClaimedJob& job) {
  const auto take = statements.use(
      "UPDATE jobs SET state = 'running', attempt = ?, started_ms = max(?, created_ms) WHERE seq = ?");
  take->bind(1, job.attempt);
  take->bind(2, now_unix_ms());
  take->bind(3, job.seq);
  take->exec();
}

/// Moves a sweep that has been served behind the others of its priority. @param claim  its number
void move_behind(std::set<SweepTurn>& turns, std::set<SweepTurn>::iterator turn, std::uint64_t claim) {
  auto served = turns.extract(turn);
  served.value().served = claim;
  turns.insert(std::move(served));
}

/// The content of a job; empty if the job no longer is what the worker took.
std::optional<std::int64_t> content_if_current(Statements& statements, const ClaimedJob& job) {
  const auto find = statements.use(
      "SELECT content FROM jobs WHERE seq = ? AND id = ? AND attempt = ? AND state = 'running'");
  find->bind(1, job.seq);
  find->bindNoCopy(2, job.id);
  find->bind(3, job.attempt);
  return find->executeStep() ? std::optional(find->getColumn(0).getInt64()) : std::nullopt;
}

void end_job(Statements& statements, const ClaimedJob& job, JobState state, std::int64_t result,
             std::int64_t now_ms, std::int64_t change) {
  const auto end = statements.use(
      "UPDATE jobs SET state = ?, result = ?, ended_ms = max(?, started_ms), change = ? WHERE seq = ? AND "
      "attempt = ? AND state = 'running'");
  end->bind(1, std::string(state_name(state)));
  end->bind(2, result);
  end->bind(3, now_ms);
  end->bind(4, change);
  end->bind(5, job.seq);
  end->bind(6, job.attempt);
  end->exec();
}

}  // namespace

struct JobQueue::Outcome {
  explicit Outcome(const RunRecord& run)
      : record(run),
        succeeded(run.end == RunRecord::End::kSucceeded),
        sampled(!run.trajectory.columns.empty()),
        trajectory(sampled ? encode_trajectory(run.trajectory) : ""),
        metrics(succeeded ? run.metrics.dump() : "") {}

  const RunRecord& record;
  const bool succeeded, sampled;
  const std::string trajectory, metrics;
};

std::optional<ClaimedJob> JobQueue::claim(const ExecutorFilter& filter, const OnClaim& on_claim) {
  core_.begin();
  return core_.writer.write_often(Durability::kSurvivesProcess, [&](Statements& statements) {
    return claim(statements, filter, on_claim);
  });
}

bool JobQueue::record(const ClaimedJob& job, const RunRecord& record) {
  const Outcome outcome(record);  // outside of the lock: other threads compute in the meantime
  return core_.refusal.watch([&] {
    return core_.writer.write_often(Durability::kSurvivesProcess, [&](Statements& statements) {
      return this->record(statements, job, outcome);
    });
  });
}

std::optional<ClaimedJob> JobQueue::record_and_claim(const ClaimedJob& job, const RunRecord& record,
                                                     const ExecutorFilter& filter, const OnClaim& on_claim) {
  const Outcome outcome(record);
  return core_.refusal.watch([&] {
    return core_.writer.write_often(Durability::kSurvivesProcess, [&](Statements& statements) {
      this->record(statements, job, outcome);
      return claim(statements, filter, on_claim);
    });
  });
}

std::optional<ClaimedJob> JobQueue::claim(Statements& statements, const ExecutorFilter& filter,
                                          const OnClaim& on_claim) {
  std::set<SweepTurn>& turns = find_turns(statements, filter);
  for (auto turn = turns.begin(); turn != turns.end();) {
    if (auto job = find_claimable(statements, turn->sweep)) {
      begin_job(statements, *job);
      core_.served[turn->sweep] = ++core_.claims;
      move_behind(turns, turn, core_.claims);
      if (on_claim) on_claim(*job);
      return job;
    }
    // Jobs that wait for the result of another job keep their turn.
    turn = has_queued_jobs(statements, turn->sweep) ? std::next(turn) : turns.erase(turn);
  }
  return std::nullopt;
}

std::set<SweepTurn>& JobQueue::find_turns(Statements& statements, const ExecutorFilter& filter) {
  SweepTurns& turns = core_.turns;
  if (turns.order_version != core_.writer.order_version()) turns.of_executor.clear();
  turns.order_version = core_.writer.order_version();
  turns.default_executor = filter.default_executor;
  const auto found = turns.of_executor.find(filter.executor);
  if (found != turns.of_executor.end()) return found->second;
  return turns.of_executor[filter.executor] = order_of_sweeps(statements, filter, core_.served);
}

bool JobQueue::record(Statements& statements, const ClaimedJob& job, const Outcome& outcome) {
  const auto content = content_if_current(statements, job);
  if (!content) return false;
  const std::int64_t now_ms = now_unix_ms();
  const std::int64_t result =
      insert_result(statements, *content, outcome.record, outcome.metrics, own_provenance());
  if (outcome.sampled) insert_trajectory(statements, result, outcome.trajectory);
  end_job(statements, job, outcome.succeeded ? JobState::kSucceeded : JobState::kFailed, result, now_ms,
          ++core_.changes);
  if (outcome.succeeded) complete_duplicates(statements, *content, result, now_ms, core_.changes);
  core_.check_quota(*statements.use(kUsedBytesQuery).operator->());
  return true;
}

void JobQueue::requeue(const ClaimedJob& job) {
  core_.writer.write_often(Durability::kSurvivesProcess, [&](Statements& statements) {
    core_.writer.invalidate_order();
    const auto put_back = statements.use(
        "UPDATE jobs SET state = 'queued', started_ms = NULL WHERE seq = ? AND id = ? AND attempt = ? AND "
        "state = 'running'");
    put_back->bind(1, job.seq);
    put_back->bind(2, job.id);
    put_back->bind(3, job.attempt);
    put_back->exec();
  });
}

}  // namespace jobs
