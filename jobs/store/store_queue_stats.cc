// SPDX-License-Identifier: Apache-2.0
#include "jobs/store/store.h"

#include <system_error>

#include "jobs/store/queue_stats.h"
#include "jobs/store/store_insert.h"

namespace jobs {
namespace {

/// By its name alone: to open and close a file takes away SQLite's locks on it.
std::int64_t size_or_zero(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  return error ? 0 : static_cast<std::int64_t>(size);
}

}  // namespace

QueueStats Store::read_queue_stats() const {
  return readers_.read([&](const SQLite::Database& database) {
    SQLite::Statement count(database, std::string("SELECT (") + kQueuedCount + "), (SELECT count(*) FROM jobs WHERE state = 'running')");
    count.executeStep();
    const std::filesystem::path file = database.getFilename();
    return QueueStats{.queued = count.getColumn(0).getInt64(), .running = count.getColumn(1).getInt64(),
                .store_bytes = size_or_zero(file) + size_or_zero(file.string() + "-wal")};
  });
}

}  // namespace jobs
