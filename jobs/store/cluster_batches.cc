// SPDX-License-Identifier: Apache-2.0
// SQL: the column place of jobs is their batch_index.
#include "jobs/store/cluster_batches.h"

#include <algorithm>
#include <set>

#include "jobs/base/time_text.h"
#include "jobs/store/store_insert.h"
#include "jobs/store/read_rows.h"
#include "jobs/store/store_results.h"
#include "jobs/store/sweep_order.h"

namespace jobs {
namespace {

constexpr std::string_view kBatchPrefix = "bat_";

/// A job that may be taken for a batch.
struct Candidate {
  std::int64_t seq = 0, content = 0;
  bool reuse = true;
};

Candidate read_candidate(const Statements::Use& found) {
  return {.seq = found->getColumn(0).getInt64(),
          .content = found->getColumn(1).getInt64(),
          .reuse = found->getColumn(2).getInt() != 0};
}

/// The first queued jobs of a sweep that need not wait for others of the same content, nor for each other.
std::vector<Candidate> find_candidates(Statements& statements, std::int64_t sweep, std::size_t most) {
  static const std::string query = std::string("SELECT j.seq, j.content, j.reuse FROM jobs j "
                                               "WHERE j.state = 'queued' AND j.batch IS NULL AND j.sweep IS "
                                               "?1 AND ") +
                                   kNobodyComputesIt + " ORDER BY j.seq LIMIT ?2";
  const auto list = statements.use(query.c_str());
  if (sweep != kSingleJobs) list->bind(1, sweep);
  list->bind(2, static_cast<std::int64_t>(most));
  std::vector<Candidate> candidates;
  std::set<std::int64_t> contents;
  while (list->executeStep()) {
    const Candidate next = read_candidate(list);
    if (contents.insert(next.content).second || !next.reuse) candidates.push_back(next);
  }
  return candidates;
}

std::string find_sweep_id(Statements& statements, std::int64_t sweep) {
  const auto find = statements.use("SELECT id FROM sweeps WHERE seq = ?");
  find->bind(1, sweep);
  return find->executeStep() ? find->getColumn(0).getString() : "";
}

BatchRow insert_batch(Statements& statements, std::string id, std::string sweep_id, std::int64_t now_ms) {
  const auto add = statements.use(
      "INSERT INTO batches (id, sweep_id, engine_version, created_ms) VALUES (?, ?, ?, ?) RETURNING seq");
  add->bind(1, id);
  if (!sweep_id.empty()) add->bind(2, sweep_id);
  add->bind(3, engine_version());
  add->bind(4, now_ms);
  add->executeStep();
  const std::int64_t seq = add->getColumn(0).getInt64();
  add->executeStep();
  return {.seq = seq, .id = std::move(id), .sweep_id = std::move(sweep_id)};
}

void set_batch_index(Statements& statements, std::int64_t job, std::int64_t batch, std::size_t batch_index) {
  const auto take = statements.use("UPDATE jobs SET batch = ?, place = ? WHERE seq = ?");
  take->bind(1, batch);
  take->bind(2, static_cast<std::int64_t>(batch_index));
  take->bind(3, job);
  take->exec();
}

/// Makes a batch of jobs of one sweep.
BatchRow make_batch(StoreCore& core, Statements& statements, std::int64_t sweep,
                    const std::vector<Candidate>& jobs) {
  const std::int64_t now_ms = now_unix_ms();
  BatchRow batch = insert_batch(statements, core.ids.make(kBatchPrefix, now_ms),
                                find_sweep_id(statements, sweep), now_ms);
  for (std::size_t k = 0; k < jobs.size(); ++k) set_batch_index(statements, jobs[k].seq, batch.seq, k);
  return batch;
}

/// A job that still has its place, and whose content is of the engine that has computed it.
struct Found {
  std::int64_t seq = 0, content = 0;
};

std::optional<Found> find_batch_job(Statements& statements, std::int64_t batch, std::uint32_t batch_index,
                                    const std::string& engine) {
  const auto find = statements.use(
      "SELECT j.seq, j.content, c.engine_version FROM jobs j JOIN contents c ON c.seq = j.content WHERE "
      "j.batch = ? AND j.place = ?");
  find->bind(1, batch);
  find->bind(2, static_cast<std::int64_t>(batch_index));
  if (!find->executeStep() || find->getColumn(2).getString() != engine) return std::nullopt;
  return Found{.seq = find->getColumn(0).getInt64(), .content = find->getColumn(1).getInt64()};
}

void end_batch_job(Statements& statements, std::int64_t job, JobState state, std::int64_t result,
                   std::int64_t now_ms, std::int64_t change) {
  const auto end = statements.use(
      "UPDATE jobs SET state = ?1, result = ?2, attempt = max(attempt, 1), started_ms = coalesce(started_ms, "
      "max(?3, created_ms)), "
      "ended_ms = max(?3, coalesce(started_ms, created_ms)), change = ?4, batch = NULL, place = NULL WHERE "
      "seq = ?5");
  end->bind(1, std::string(state_name(state)));
  end->bind(2, result);
  end->bind(3, now_ms);
  end->bind(4, change);
  end->bind(5, job);
  end->exec();
}

/// Delivery of results of a batch.
struct BatchDelivery {
  std::int64_t batch = 0;
  const Provenance& provenance;
  std::int64_t now_ms = 0;
  std::int64_t change = 0;  ///< of the jobs that end with it
};

/// Stores the result of a job. False if it is not open any more, or its content is of another engine.
bool record_result(Statements& statements, const BatchDelivery& delivery, const BatchRecord& each) {
  const auto& [batch, provenance, now_ms, change] = delivery;
  const auto found = find_batch_job(statements, batch, each.batch_index, provenance.engine);
  if (!found) return false;
  const bool succeeded = each.record->end == RunRecord::End::kSucceeded;
  const std::string metrics = succeeded ? each.record->metrics.dump() : "";
  const std::int64_t result = insert_result(statements, found->content, *each.record, metrics, provenance);
  if (!each.packed_trajectory->empty()) insert_trajectory(statements, result, *each.packed_trajectory);
  end_batch_job(statements, found->seq, succeeded ? JobState::kSucceeded : JobState::kFailed, result, now_ms,
                change);
  if (succeeded) complete_duplicates(statements, found->content, result, now_ms, change);
  return true;
}

void begin_batch_job(Statements& statements, std::int64_t batch, std::uint32_t batch_index) {
  const auto begin = statements.use(
      "UPDATE jobs SET state = 'running', attempt = attempt + 1, started_ms = max(?, created_ms) "
      "WHERE batch = ? AND place = ? AND state = 'queued'");
  begin->bind(1, now_unix_ms());
  begin->bind(2, batch);
  begin->bind(3, static_cast<std::int64_t>(batch_index));
  begin->exec();
}

void put_batch_job_back(Statements& statements, std::int64_t batch, std::uint32_t batch_index) {
  const auto wait = statements.use(
      "UPDATE jobs SET state = 'queued', started_ms = NULL WHERE batch = ? AND place = ? AND state = "
      "'running'");
  wait->bind(1, batch);
  wait->bind(2, static_cast<std::int64_t>(batch_index));
  wait->exec();
}

}  // namespace

void release_batches_of_other_engines(SQLite::Database& database) {
  SQLite::Statement release(database,
                            "UPDATE jobs SET state = 'queued', started_ms = NULL, batch = NULL, place = NULL "
                            "WHERE batch IN (SELECT seq FROM batches WHERE engine_version <> ?)");
  release.bind(1, engine_version());
  release.exec();
}

std::optional<BatchRow> ClusterBatches::claim(const ExecutorFilter& filter, std::size_t most_jobs) {
  core_.begin();
  return core_.writer.write_often(
      Durability::kSurvivesPowerLoss, [&](Statements& statements) -> std::optional<BatchRow> {
        for (const auto& [negative_priority, served, sweep] :
             order_of_sweeps(statements, filter, core_.served)) {
          const auto candidates = find_candidates(statements, sweep, most_jobs);
          if (candidates.empty()) continue;
          const BatchRow batch = make_batch(core_, statements, sweep, candidates);
          core_.served[sweep] = ++core_.claims;
          return batch;
        }
        return std::nullopt;
      });
}

std::vector<BatchRow> ClusterBatches::list() const {
  return core_.readers.read([&](const SQLite::Database& database) {
    SQLite::Statement list(database, "SELECT seq, id, coalesce(sweep_id, '') FROM batches ORDER BY seq");
    std::vector<BatchRow> batches;
    while (list.executeStep()) {
      batches.push_back({.seq = list.getColumn(0).getInt64(), .id = list.getColumn(1).getString(),
                         .sweep_id = list.getColumn(2).getString()});
    }
    return batches;
  });
}

std::vector<std::uint32_t> ClusterBatches::find_open_indices(std::int64_t batch) const {
  return core_.readers.read([&](const SQLite::Database& database) {
    SQLite::Statement list(database, "SELECT place FROM jobs WHERE batch = ? ORDER BY place");
    list.bind(1, batch);
    std::vector<std::uint32_t> indices;
    while (list.executeStep()) indices.push_back(list.getColumn(0).getUInt());
    return indices;
  });
}

std::vector<BatchJob> ClusterBatches::find_open_jobs(std::int64_t batch) const {
  return core_.readers.read([&](const SQLite::Database& database) {
    SQLite::Statement list(database,
                           "SELECT j.place, c.parameters, j.kind, json_extract(c.parameters, '$.duration_s') "
                           "FROM jobs j "
                           "JOIN contents c ON c.seq = j.content WHERE j.batch = ? ORDER BY j.place");
    list.bind(1, batch);
    std::vector<BatchJob> jobs;
    while (list.executeStep()) {
      jobs.push_back({.batch_index = list.getColumn(0).getUInt(), .parameters = list.getColumn(1).getString(),
                      .kind = list.getColumn(2).getString(),
                        .duration_s = list.getColumn(3).getDouble()});
    }
    return jobs;
  });
}

std::size_t ClusterBatches::record(std::int64_t batch, const Provenance& provenance,
                                   const std::vector<BatchRecord>& records) {
  const auto store = [&](Statements& statements) {
    const BatchDelivery delivery{
        .batch = batch, .provenance = provenance, .now_ms = now_unix_ms(), .change = ++core_.changes};
    std::size_t stored = 0;
    for (const BatchRecord& each : records) stored += record_result(statements, delivery, each) ? 1 : 0;
    core_.check_quota(*statements.use(kUsedBytesQuery).operator->());
    return stored;
  };
  return core_.refusal.watch(
      [&] { return core_.writer.write_often(Durability::kSurvivesPowerLoss, store); });
}

void ClusterBatches::set_running(std::int64_t batch, const std::vector<std::uint32_t>& running,
                                 const std::vector<std::uint32_t>& waiting) {
  core_.writer.write_often(Durability::kSurvivesProcess, [&](Statements& statements) {
    for (const std::uint32_t batch_index : running) begin_batch_job(statements, batch, batch_index);
    for (const std::uint32_t batch_index : waiting) put_batch_job_back(statements, batch, batch_index);
  });
}

void ClusterBatches::end(std::int64_t batch) {
  core_.writer.write_often(Durability::kSurvivesPowerLoss, [&](Statements& statements) {
    core_.writer.invalidate_order();
    const auto release = statements.use(
        "UPDATE jobs SET state = 'queued', started_ms = NULL, batch = NULL, place = NULL WHERE batch = ?");
    release->bind(1, batch);
    release->exec();
    const auto forget = statements.use("DELETE FROM batches WHERE seq = ?");
    forget->bind(1, batch);
    forget->exec();
  });
}

std::map<std::string, double> ClusterBatches::find_cost_rates() const {
  return core_.readers.read([](const SQLite::Database& database) { return read_cost_rates(database); });
}

std::string ClusterBatches::find_identity() const {
  return core_.readers.read([&](const SQLite::Database& database) {
    SQLite::Statement find(database, "SELECT id FROM identity");
    find.executeStep();
    return find.getColumn(0).getString();
  });
}

}  // namespace jobs
