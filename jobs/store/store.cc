// SPDX-License-Identifier: Apache-2.0
#include "jobs/store/store.h"

#include <algorithm>
#include <limits>

#include "jobs/base/time_text.h"
#include "jobs/store/store_batches.h"
#include "jobs/store/store_insert.h"
#include "jobs/store/check_quota.h"
#include "jobs/store/store_rows.h"

namespace jobs {
namespace {

constexpr std::int64_t kResponsesAreKept_ms = 7LL * 24 * 3600 * 1000;

/// Adds cases to the request of a sweep. The database appends to the text, so that the cases that it has already are not read here, and
/// numbers stay as they were written.
void append_cases(SQLite::Database& database, const std::string& id, const nlohmann::ordered_json& cases) {
  constexpr std::size_t kMostAtOnce = 20;  // calls inside one another, of which SQLite's parser bears no more than some
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

void store_response(SQLite::Database& database, const std::string& key, const std::string& fingerprint, const std::string& response) {
  const std::int64_t now_ms = now_unix_ms();
  SQLite::Statement forget(database, "DELETE FROM answers WHERE created_ms < ?");
  forget.bind(1, now_ms - kResponsesAreKept_ms);
  forget.exec();
  SQLite::Statement add(database, "INSERT INTO answers (key, request, answer, created_ms) VALUES (?, ?, ?, ?)");
  add.bind(1, key);
  add.bind(2, fingerprint);
  add.bind(3, response);
  add.bind(4, now_ms);
  add.exec();
}

Store::Store(const std::filesystem::path& file, const StoreQuota& room) : file_(file), room_(room), lock_(file), writer_(file), readers_(file) {
  try {
    begin();
  } catch (const StorageError& error) {
    if (!is_damage(error.code)) throw;
    throw StorageError("the store " + file.string() + " is damaged (" + error.what() + "); it has been left as it is", error.code);
  }
  writer_.accept();
}

void Store::begin() {
  writer_.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    SQLite::Statement newest(database, "SELECT engine_version FROM contents ORDER BY seq DESC LIMIT 1");
    if (newest.executeStep()) engine_before_ = newest.getColumn(0).getString();
    database.exec("UPDATE jobs SET state = 'queued', started_ms = NULL WHERE state = 'running' AND batch IS NULL");
    release_batches_of_other_engines(database);
    rekey_queued_jobs(database);
    changes_ = database.execAndGet("SELECT coalesce(max(abs(change)), 0) FROM jobs WHERE change IS NOT NULL").getInt64();
  });
}

std::string Store::add_sweep(const SweepPlan& plan, const std::string& request, std::size_t max_queued, const IdempotencyRecord<SweepRow>& idempotency) {
  return writer_.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    const std::int64_t now_ms = now_unix_ms();
    std::string id = ids_.make(kSweepPrefix, now_ms);
    const std::int64_t sweep = insert_sweep(database, id, plan, request, now_ms);
    JobInserter inserter(database, ids_, now_ms, ++changes_);
    for (const PlannedJob& job : plan.jobs) inserter.insert(job, {sweep, plan.reuse});
    check_queue_limit(database, max_queued);
    if (!idempotency.key.empty()) store_response(database, idempotency.key, idempotency.fingerprint, idempotency.make_response(read_sweep(database, id).value()));
    check_quota_of(database);
    return id;
  });
}

std::string Store::add_job(const PlannedJob& job, std::size_t max_queued, const IdempotencyRecord<JobRow>& idempotency) {
  return writer_.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    std::string id = JobInserter(database, ids_, now_unix_ms(), ++changes_).insert(job, {});
    check_queue_limit(database, max_queued);
    if (!idempotency.key.empty()) store_response(database, idempotency.key, idempotency.fingerprint, idempotency.make_response(read_job(database, id).value()));
    check_quota_of(database);
    return id;
  });
}

bool Store::extend_sweep(const std::string& id, const std::string& former, const std::string& request, const std::vector<PlannedJob>& jobs,
                         std::size_t max_queued) {
  return writer_.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    SQLite::Statement change(database, "UPDATE sweeps SET request = ? WHERE id = ? AND request = ?");
    change.bind(1, request);
    change.bind(2, id);
    change.bind(3, former);
    return change.exec() > 0 && add_jobs(database, id, jobs, max_queued);
  });
}

bool Store::add_cases(const std::string& id, const nlohmann::ordered_json& cases, const std::vector<PlannedJob>& jobs) {
  return writer_.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    append_cases(database, id, cases);
    return add_jobs(database, id, jobs, std::numeric_limits<std::size_t>::max());
  });
}

bool Store::add_jobs(SQLite::Database& database, const std::string& id, const std::vector<PlannedJob>& jobs, std::size_t max_queued) {
  SQLite::Statement find(database, "SELECT seq, created_ms, (SELECT reuse FROM jobs WHERE sweep = s.seq LIMIT 1) FROM sweeps s WHERE id = ?");
  find.bind(1, id);
  if (!find.executeStep()) return false;
  const std::int64_t now_ms = std::max(now_unix_ms(), find.getColumn(1).getInt64());
  JobInserter inserter(database, ids_, now_ms, ++changes_);
  const JobOwner owner{.sweep = find.getColumn(0).getInt64(), .reuse = find.getColumn(2).getInt() != 0};
  for (const PlannedJob& job : jobs) inserter.insert(job, owner);
  check_queue_limit(database, max_queued);
  check_quota_of(database);
  return true;
}

void Store::check_quota_of(SQLite::Database& database) const {
  SQLite::Statement used(database, kUsedBytesQuery);
  check_quota(used, room_, file_);
}

std::optional<StoredResponse> Store::find_response(const std::string& key) const {
  return readers_.read([&](const SQLite::Database& database) -> std::optional<StoredResponse> {
    SQLite::Statement find(database, "SELECT request, answer FROM answers WHERE key = ? AND created_ms >= ?");
    find.bind(1, key);
    find.bind(2, now_unix_ms() - kResponsesAreKept_ms);
    if (!find.executeStep()) return std::nullopt;
    return StoredResponse{.fingerprint = find.getColumn(0).getString(), .text = find.getColumn(1).getString()};
  });
}

}  // namespace jobs
