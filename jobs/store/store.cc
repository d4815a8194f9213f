// SPDX-License-Identifier: Apache-2.0
#include "jobs/store/store.h"

#include <algorithm>
#include <limits>

#include "jobs/base/time_text.h"
#include "jobs/store/store_batches.h"
#include "jobs/store/store_insert.h"
#include "jobs/store/store_quota.h"
#include "jobs/store/store_rows.h"

namespace jobs {
namespace {

constexpr std::int64_t kAnswersAreKept_ms = 7LL * 24 * 3600 * 1000;

/// Adds cases to the request of a sweep. The database appends to the text, so that the cases that it has already are not read here, and
/// numbers stay as they were written.
void append_cases(SQLite::Database& database, const std::string& id, const nlohmann::ordered_json& cases) {
  constexpr std::size_t kMostAtOnce = 20;  // calls inside one another, of which SQLite's parser bears no more than some
  for (std::size_t first = 0; first < cases.size(); first += kMostAtOnce) {
    const std::size_t end = std::min(cases.size(), first + kMostAtOnce);
    std::string request = "request";
    for (std::size_t k = first; k < end; ++k) request = "json_insert(" + request + ", '$.cases[#]', json(?))";
    SQLite::Statement append(database, "UPDATE sweeps SET request = " + request + " WHERE id = ?");
    int place = 1;
    for (std::size_t k = first; k < end; ++k) append.bind(place++, cases[k].dump());
    append.bind(place, id);
    append.exec();
  }
}

}  // namespace

void keep_answer(SQLite::Database& database, const std::string& key, const std::string& request, const std::string& answer) {
  const std::int64_t now_ms = now_unix_ms();
  SQLite::Statement forget(database, "DELETE FROM answers WHERE created_ms < ?");
  forget.bind(1, now_ms - kAnswersAreKept_ms);
  forget.exec();
  SQLite::Statement add(database, "INSERT INTO answers (key, request, answer, created_ms) VALUES (?, ?, ?, ?)");
  add.bind(1, key);
  add.bind(2, request);
  add.bind(3, answer);
  add.bind(4, now_ms);
  add.exec();
}

Store::Store(const std::filesystem::path& file, const StoreRoom& room) : file_(file), room_(room), lock_(file), writer_(file), readers_(file) {
  try {
    begin();
  } catch (const StorageError& error) {
    if (!is_damage(error.code)) throw;
    throw StorageError("the store " + file.string() + " is damaged (" + error.what() + "); it has been left as it is", error.code, false);
  }
  writer_.accept();
}

void Store::begin() {
  writer_.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    SQLite::Statement newest(database, "SELECT engine_version FROM contents ORDER BY seq DESC LIMIT 1");
    if (newest.executeStep()) engine_before_ = newest.getColumn(0).getString();
    database.exec("UPDATE jobs SET state = 'queued', started_ms = NULL WHERE state = 'running' AND batch IS NULL");
    release_batches_of_other_engines(database);
    rename_queued_contents(database);
    changes_ = database.execAndGet("SELECT coalesce(max(abs(change)), 0) FROM jobs WHERE change IS NOT NULL").getInt64();
  });
}

std::string Store::add_sweep(const SweepPlan& plan, const std::string& request, std::size_t max_queued, const KeptAnswer<SweepRow>& kept) {
  return writer_.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    const std::int64_t now_ms = now_unix_ms();
    std::string id = ids_.make(kSweepPrefix, now_ms);
    const std::int64_t sweep = insert_sweep(database, id, plan, request, now_ms);
    JobInserter inserter(database, ids_, now_ms, ++changes_);
    for (const PlannedJob& job : plan.jobs) inserter.insert(job, sweep, plan.reuse);
    check_room(database, max_queued);
    if (!kept.key.empty()) keep_answer(database, kept.key, kept.request, kept.make_text(read_sweep(database, id).value()));
    check_quota_of(database);
    return id;
  });
}

std::string Store::add_job(const PlannedJob& job, std::size_t max_queued, const KeptAnswer<JobRow>& kept) {
  return writer_.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    std::string id = JobInserter(database, ids_, now_unix_ms(), ++changes_).insert(job, std::nullopt, true);
    check_room(database, max_queued);
    if (!kept.key.empty()) keep_answer(database, kept.key, kept.request, kept.make_text(read_job(database, id).value()));
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
  for (const PlannedJob& job : jobs) inserter.insert(job, find.getColumn(0).getInt64(), find.getColumn(2).getInt() != 0);
  check_room(database, max_queued);
  check_quota_of(database);
  return true;
}

void Store::check_quota_of(SQLite::Database& database) const {
  SQLite::Statement used(database, kUsedBytesQuery);
  check_quota(used, room_, file_);
}

std::optional<FoundAnswer> Store::find_answer(const std::string& key) const {
  return readers_.read([&](const SQLite::Database& database) -> std::optional<FoundAnswer> {
    SQLite::Statement find(database, "SELECT request, answer FROM answers WHERE key = ? AND created_ms >= ?");
    find.bind(1, key);
    find.bind(2, now_unix_ms() - kAnswersAreKept_ms);
    if (!find.executeStep()) return std::nullopt;
    return FoundAnswer{.request = find.getColumn(0).getString(), .text = find.getColumn(1).getString()};
  });
}

std::string_view sweep_state(const StateCounts& counts) {
  const auto count = [&](JobState state) { return counts[static_cast<std::size_t>(state)]; };
  if (!has_ended(counts)) {
    const bool untouched = count(JobState::kRunning) + count(JobState::kSucceeded) + count(JobState::kFailed) + count(JobState::kCancelled) == 0;
    return state_name(untouched ? JobState::kQueued : JobState::kRunning);
  }
  if (count(JobState::kCancelled) > 0) return state_name(JobState::kCancelled);
  return state_name(count(JobState::kFailed) > 0 ? JobState::kFailed : JobState::kSucceeded);
}

bool has_ended(const StateCounts& counts) {
  return counts[static_cast<std::size_t>(JobState::kQueued)] + counts[static_cast<std::size_t>(JobState::kRunning)] == 0;
}

}  // namespace jobs
