// SPDX-License-Identifier: Apache-2.0
#include "jobs/store/store.h"

#include "jobs/store/store_insert.h"

namespace jobs {

Store::Store(const std::filesystem::path& file, const StoreQuota& quota) : core_(file, quota) {
  try {
    begin();
  } catch (const StorageError& error) {
    if (!is_damage(error.code)) throw;
    throw StorageError(
        "the store " + file.string() + " is damaged (" + error.what() + "); it has been left as it is",
        error.code);
  }
  core_.writer.accept();
  keep(true);
}

void Store::begin() {
  core_.writer.write(Durability::kSurvivesPowerLoss, [&](SQLite::Database& database) {
    SQLite::Statement newest(database, "SELECT engine_version FROM contents ORDER BY seq DESC LIMIT 1");
    if (newest.executeStep()) engine_before_ = newest.getColumn(0).getString();
    database.exec(
        "UPDATE jobs SET state = 'queued', started_ms = NULL WHERE state = 'running' AND batch IS NULL");
    release_batches_of_other_engines(database);
    rekey_queued_jobs(database);
    core_.changes =
        database.execAndGet("SELECT coalesce(max(abs(change)), 0) FROM jobs WHERE change IS NOT NULL")
            .getInt64();
  });
}

}  // namespace jobs
