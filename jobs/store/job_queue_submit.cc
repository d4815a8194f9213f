// SPDX-License-Identifier: Apache-2.0
// Sweeps and jobs that are submitted or extended.

#include <algorithm>
#include <limits>

#include "jobs/base/time_text.h"
#include "jobs/store/job_queue.h"
#include "jobs/store/read_rows.h"
#include "jobs/store/store_insert.h"

namespace jobs {
namespace {

/// Adds cases to the request of a sweep. The database appends to the text, so that the cases that it has
/// already are not read here, and numbers stay as they were written.
void append_cases(SQLite::Database& database, const std::string& id, const nlohmann::ordered_json& cases) {
  // Calls inside one another, of which SQLite's parser bears no more than some
  constexpr std::size_t kMostAtOnce = 20;
  for (std::size_t first = 0; first < cases.size(); first += kMostAtOnce) {
    const std::size_t end = std::min(cases.size(), first + kMostAtOnce);
    std::string request = "request";
    for (std::size_t k = first; k < end; ++k) request = "json_insert(" + request + ", '$.cases[#]', json(?))";
    SQLite::Statement append(database, "UPDATE sweeps SET request = " + request + " WHERE id = ?");
    int parameter = 1;
    for (std::size_t k = first; k < end; ++k) append.bind(parameter++, cases[k].dump());
    append.bind(parameter, id);
    append.exec();
  }
}

}  // namespace

std::string JobQueue::add_sweep(const SweepPlan& plan, const std::string& request, std::size_t max_queued,
                                const IdempotencyRecord<SweepRow>& idempotency) {
  return core_.writer.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    const std::int64_t now_ms = now_unix_ms();
    std::string id = core_.ids.make(kSweepPrefix, now_ms);
    const std::int64_t sweep =
        insert_sweep(database, core_.ids, id, plan, request, {now_ms, ++core_.changes, max_queued});
    core_.turns.add(plan.executor, {.negative_priority = -plan.priority, .sweep = sweep},
                    core_.writer.order_version());
    respond(database, idempotency, [&] { return read_sweep(database, id, core_.active).value(); });
    core_.check_quota(database);
    return id;
  });
}

void JobQueue::check_sweep(const SweepPlan& plan, const std::string& request, std::size_t max_queued) {
  struct Undo {};
  try {
    core_.writer.write(Durability::kSurvivesProcess, [&](SQLite::Database& database) {
      const std::int64_t now_ms = now_unix_ms();
      insert_sweep(database, core_.ids, core_.ids.make(kSweepPrefix, now_ms), plan, request,
                   {now_ms, core_.changes, max_queued});
      core_.check_quota(database);
      throw Undo{};
    });
  } catch (const Undo&) {
  }
}

bool JobQueue::describe_sweep(const std::string& id, const SweepDescription& changes) {
  return core_.writer.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    SQLite::Statement change(
        database,
        "UPDATE sweeps SET name = coalesce(?, name), notes = coalesce(?, notes), tags = coalesce(?, tags) "
        "WHERE id = ?");
    if (changes.name) change.bind(1, *changes.name);
    if (changes.notes) change.bind(2, *changes.notes);
    if (changes.tags) change.bind(3, nlohmann::json(*changes.tags).dump());
    change.bind(4, id);
    if (change.exec() == 0) return false;
    core_.check_quota(database);
    return true;
  });
}

std::string JobQueue::add_job(const PlannedJob& job, std::size_t max_queued,
                              const IdempotencyRecord<JobRow>& idempotency) {
  return core_.writer.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    const auto served = core_.served.find(kSingleJobs);
    core_.turns.add("", {.served = served == core_.served.end() ? 0 : served->second},
                    core_.writer.order_version());
    std::string id = JobInserter(database, core_.ids, now_unix_ms(), ++core_.changes).insert(job, {});
    check_queue_limit(database, max_queued);
    respond(database, idempotency, [&] { return read_job(database, id).value(); });
    core_.check_quota(database);
    return id;
  });
}

bool JobQueue::extend_sweep(const std::string& id, const std::string& former, const std::string& request,
                            const std::vector<PlannedJob>& jobs, std::size_t max_queued) {
  return core_.writer.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    SQLite::Statement change(database, "UPDATE sweeps SET request = ? WHERE id = ? AND request = ?");
    change.bind(1, request);
    change.bind(2, id);
    change.bind(3, former);
    if (change.exec() == 0 || !add_jobs(database, id, jobs, max_queued)) return false;
    restart_study(database, find_sweep_seq(database, id).value());
    return true;
  });
}

bool JobQueue::add_cases(const std::string& id, const nlohmann::ordered_json& cases,
                         const std::vector<PlannedJob>& jobs) {
  return core_.writer.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    append_cases(database, id, cases);
    return add_jobs(database, id, jobs, std::numeric_limits<std::size_t>::max());
  });
}

bool JobQueue::add_jobs(SQLite::Database& database, const std::string& id,
                        const std::vector<PlannedJob>& jobs, std::size_t max_queued) {
  SQLite::Statement find(
      database,
      "SELECT seq, created_ms, (SELECT reuse FROM jobs WHERE sweep = s.seq LIMIT 1) FROM sweeps s WHERE id = "
      "?");
  find.bind(1, id);
  if (!find.executeStep()) return false;
  const std::int64_t now_ms = std::max(now_unix_ms(), find.getColumn(1).getInt64());
  JobInserter inserter(database, core_.ids, now_ms, ++core_.changes);
  const JobOwner owner{.sweep = find.getColumn(0).getInt64(), .reuse = find.getColumn(2).getInt() != 0};
  for (const PlannedJob& job : jobs) inserter.insert(job, owner);
  check_queue_limit(database, max_queued);
  core_.check_quota(database);
  return true;
}

}  // namespace jobs
