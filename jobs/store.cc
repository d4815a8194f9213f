#include "jobs/store.h"

#include <algorithm>

#include "jobs/store_batches.h"
#include "jobs/store_insert.h"
#include "jobs/store_quota.h"
#include "jobs/store_rows.h"
#include "jobs/time_text.h"

namespace jobs {
namespace {

constexpr std::int64_t kAnswersAreKept_ms = 7LL * 24 * 3600 * 1000;

/// Keeps the answer for those who send the same request again, and forgets old ones.
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

}  // namespace

Store::Store(const std::filesystem::path& file, const StoreRoom& room) : file_(file), room_(room), lock_(file), writer_(file), readers_(file) {
  writer_.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    database.exec("UPDATE jobs SET state = 'queued', started_ms = NULL WHERE state = 'running' AND batch IS NULL");
    release_batches_of_other_engines(database);
    rename_queued_contents(database);
    changes_ = database.execAndGet("SELECT coalesce(max(change), 0) FROM jobs WHERE change IS NOT NULL").getInt64();
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
    SQLite::Statement change(database, "UPDATE sweeps SET request = ? WHERE id = ? AND request = ? RETURNING seq, created_ms, (SELECT reuse FROM jobs WHERE sweep = seq LIMIT 1)");
    change.bind(1, request);
    change.bind(2, id);
    change.bind(3, former);
    if (!change.executeStep()) return false;
    const std::int64_t sweep = change.getColumn(0).getInt64();
    const std::int64_t now_ms = std::max(now_unix_ms(), change.getColumn(1).getInt64());
    const bool reuse = change.getColumn(2).getInt() != 0;
    change.executeStep();
    JobInserter inserter(database, ids_, now_ms, ++changes_);
    for (const PlannedJob& job : jobs) inserter.insert(job, sweep, reuse);
    check_room(database, max_queued);
    check_quota_of(database);
    return true;
  });
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
