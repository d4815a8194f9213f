// SPDX-License-Identifier: Apache-2.0
#include "jobs/store/store.h"

#include <algorithm>
#include <cstdint>
#include <string>

#include <sqlite3.h>

#include "jobs/base/ids.h"
#include "jobs/store/store_insert.h"

namespace jobs {
namespace {

[[noreturn]] void throw_disk_full() {
  throw StoreLimitReached(
      "the disk that holds the store is full; make room on it, or delete sweeps that are not needed any "
      "more");
}

/// Makes later ids greater than those of the store, which a clock may have made that was ahead. Each maximum
/// is the end of an index. Studies and batches are not looked at: their ids are of the time of their jobs'.
void follow_ids(const SQLite::Database& database, IdMaker& ids) {
  SQLite::Statement newest(database,
                           "SELECT max(id) FROM sweeps UNION ALL SELECT max(id) FROM jobs UNION ALL SELECT "
                           "max(id) FROM measurements");
  while (newest.executeStep()) ids.follow(newest.getColumn(0).getString());
}

}  // namespace

Store::Store(const std::filesystem::path& file, const StoreQuota& quota) : core_(file, quota) {
  try {
    open();
  } catch (const StorageError& error) {
    if (!is_damage(error.code)) throw;
    throw StorageError(
        "the store " + file.string() + " is damaged (" + error.what() + "); it has been left as it is",
        error.code);
  }
  core_.writer.accept();
  keep(true);
  core_.lock.hold_room();
}

void Store::open() {
  core_.readers.read([&](const SQLite::Database& database) {
    SQLite::Statement newest(database, "SELECT engine_version FROM contents ORDER BY seq DESC LIMIT 1");
    if (newest.executeStep()) engine_before_ = newest.getColumn(0).getString();
    SQLite::Statement last(database,
                           "SELECT coalesce(max(abs(change)), 0) FROM jobs WHERE change IS NOT NULL");
    last.executeStep();
    core_.changes = last.getColumn(0).getInt64();
    follow_ids(database, core_.ids);
  });
  try {
    core_.with_held_room([&] { core_.begin(); });
  } catch (const StorageError& error) {
    if (!error.full) throw;
  }
}

void Store::release_free_pages() {
  try {
    if (core_.lock.has_room()) return core_.writer.release_free_pages(Disk::kHasRoom);
  } catch (const StorageError& error) {
    if (!error.full) throw;
    core_.writer.empty_log();
  }
  {
    const StoreLock::LentRoom lent(core_.lock);
    core_.writer.release_free_pages(Disk::kFull);
  }
  core_.lock.hold_room();
}

void Store::check_room() {
  constexpr std::int64_t kLeast_bytes = 1 << 18;  // one write takes some
  if (jobs::find_bytes_left(core_.file) < kLeast_bytes) throw_disk_full();
  core_.check_room();
  core_.begin();
  check_disk(core_.file, core_.quota.reserve_bytes);
  if (const std::string reason = refusal(); !reason.empty()) throw StoreLimitReached(reason);
}

std::int64_t Store::find_bytes_left() {
  const std::int64_t on_disk =
      std::max<std::int64_t>(0, jobs::find_bytes_left(core_.file) - core_.quota.reserve_bytes);
  if (core_.quota.most_bytes <= 0) return on_disk;
  const std::int64_t used = core_.readers.read([](const SQLite::Database& database) {
    SQLite::Statement query(database, kUsedBytesQuery);
    query.executeStep();
    return query.getColumn(0).getInt64();
  });
  return std::clamp<std::int64_t>(core_.quota.most_bytes - used, 0, on_disk);
}

Writer StoreCore::open(const std::filesystem::path& path, StoreLock& lock) {
  try {
    return Writer(path, LogIndex::kFile);
  } catch (const StorageError& error) {
    // SQLite does not tell why it could not make its index.
    if (!error.full && (error.code & 0xff) != SQLITE_IOERR) throw;
  }
  const StoreLock::LentRoom lent(lock);
  try {
    return Writer(path, LogIndex::kFile);
  } catch (const StorageError& error) {
    if (!error.full && error.code != SQLITE_IOERR_SHMSIZE) throw;
  }
  return Writer(path, LogIndex::kMemory);
}

void StoreCore::check_room() {
  if (!lock.hold_room()) throw_disk_full();
}

void StoreCore::begin() {
  if (begun_) return;
  writer.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    if (begun_) return;
    database.exec(
        "UPDATE jobs SET state = 'queued', started_ms = NULL WHERE state = 'running' AND batch IS NULL");
    release_batches_of_other_engines(database);
    rekey_queued_jobs(database);
    // For listings; it belongs to no form of the store, which former programs can use with it and without.
    database.exec(
        "CREATE INDEX IF NOT EXISTS unsuccessful_jobs ON jobs (state, id) WHERE state = 'failed' OR state = "
        "'cancelled'");
  });
  begun_ = true;
}

}  // namespace jobs
