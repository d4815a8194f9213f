// SPDX-License-Identifier: Apache-2.0
// States of a store as it is opened, one after the other:
// - locked: StoreLock keeps out others that open the store by its name, StoreFileLock those that open it by
//   another name.
// - opened: Writer has brought it to the newest form. Its file is as it was, what is new stands in the log.
// - begun: StoreCore::begin() has queued again what was running. On a full disk this waits for room, and
//   until then no job is claimed.
// - accepted: all that a start reads could be read. From Writer::accept() on the log is moved into the file.
// - kept: files that were made here stay when it is closed. keep(false) gives them up again.
// - room held: StoreLock::hold_room() has set aside room on the disk, in the lock's file. LentRoom lends it
//   to one who makes the store smaller. On a full disk there may be none.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "jobs/base/errors.h"
#include "jobs/base/ids.h"
#include "jobs/store/active_sweeps.h"
#include "jobs/store/check_quota.h"
#include "jobs/store/store_connection.h"
#include "jobs/store/store_lock.h"
#include "jobs/store/sweep_order.h"

namespace jobs {

/// Reason for the refusal of the last result by a store that is as large as it may be; empty if it was
/// stored. (The room left on the disk is looked at whenever somebody asks.)
class ResultRefusal {
 public:
  /// Calls store(), and remembers whether there was room. @throws whatever store() does
  template <typename Store>
  auto watch(Store&& store) {
    try {
      auto stored = store();
      set("");
      return stored;
    } catch (const StoreSizeReached& refusal) {
      set(refusal.what());
      throw;
    }
  }
  /// @returns empty if there was room for the last result
  [[nodiscard]] std::string reason() const {
    const std::lock_guard lock(mutex_);
    return reason_;
  }

 private:
  void set(const std::string& reason) {
    const std::lock_guard lock(mutex_);
    reason_ = reason;
  }

  mutable std::mutex mutex_;
  std::string reason_;
};

/// Parts that the interfaces of a store share.
struct StoreCore {
  StoreCore(const std::filesystem::path& path, const StoreQuota& limits)
      : file(path), quota(limits), lock(path), writer(open(path, lock)), readers(path, writer.log_index()) {}

  /// Checks, inside a transaction that has added something, that it may stay. @throws StoreLimitReached
  void check_quota(SQLite::Database& database) {
    SQLite::Statement used(database, kUsedBytesQuery);
    check_quota(used);
  }
  /// @param used  kUsedBytesQuery, prepared
  void check_quota(SQLite::Statement& used) {
    check_room();
    jobs::check_quota(used, quota, file);
  }

  /// Checks that the disk has the room that deletions may need. @throws StoreLimitReached
  void check_room();

  /// Runs a write that makes the store smaller, on a full disk once more with the room that is held for it.
  template <typename Write>
  auto with_held_room(Write&& write) {
    try {
      return write();
    } catch (const StorageError& error) {
      if (!error.full) throw;
    }
    writer.empty_log();
    const StoreLock::LentRoom lent(lock);
    return write();
  }
  template <typename Work>
  auto write_in_held_room(Work&& work) {
    return with_held_room([&] { return writer.write(Durability::kSurvivesPowerLoss, work); });
  }

  /// Queues again what was running when the last process ended, and gives queued jobs the content ids of this
  /// program, unless that is done. On a full disk it is tried again before each claim. @throws StorageError
  void begin();

  const std::filesystem::path file;
  const StoreQuota quota;
  StoreLock lock;
  // Readers close before the writer, which is then the one that empties the log.
  Writer writer;
  ReaderPool readers;
  IdMaker ids;
  ActiveSweepCache active;
  ResultRefusal refusal;
  // The rest is guarded by the writer's lock.
  /// Number of the claim that last served a sweep; see kSingleJobs
  std::map<std::int64_t, std::uint64_t> served;
  std::uint64_t claims = 0;
  SweepTurns turns;
  std::int64_t changes = 0;  ///< the last EndedJob::change

 private:
  /// Opens the store; on a full disk in the room that is held for it, else with the log's index in memory.
  static Writer open(const std::filesystem::path& path, StoreLock& lock);

  std::atomic<bool> begun_ = false;
};

}  // namespace jobs
