// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>

#include "jobs/base/ids.h"
#include "jobs/store/active_sweeps.h"
#include "jobs/store/check_quota.h"
#include "jobs/store/store_connection.h"
#include "jobs/store/sweep_order.h"

namespace jobs {

/// Parts that the interfaces of a store share.
struct StoreCore {
  StoreCore(const std::filesystem::path& path, const StoreQuota& limits)
      : file(path), quota(limits), lock(path), writer(path), readers(path) {}

  /// Checks, inside a transaction that has added something, that it may stay. @throws StoreLimitReached
  void check_quota(SQLite::Database& database) const {
    SQLite::Statement used(database, kUsedBytesQuery);
    jobs::check_quota(used, quota, file);
  }

  const std::filesystem::path file;
  const StoreQuota quota;
  StoreLock lock;
  // Readers close before the writer, which is then the one that empties the log.
  Writer writer;
  ReaderPool readers;
  IdMaker ids;
  ActiveSweepCache active;
  // The rest is guarded by the writer's lock.
  /// Number of the claim that last served a sweep; see kSingleJobs
  std::map<std::int64_t, std::uint64_t> served;
  std::uint64_t claims = 0;
  SweepTurns turns;
  std::int64_t changes = 0;  ///< the last EndedJob::change
};

}  // namespace jobs
