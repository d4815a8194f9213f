// SPDX-License-Identifier: Apache-2.0
#include "jobs/store/store_connection.h"

#include <limits>
#include <utility>

#include <sqlite3.h>

#include "jobs/store/store_schema.h"

namespace jobs {
namespace {

constexpr int kBusyTimeout_ms = 5000;

/// Settings of both kinds of connection: nothing in the file may run code of its own.
void harden(SQLite::Database& database) {
  for (const auto& [option, value] : {std::pair{SQLITE_DBCONFIG_DEFENSIVE, 1},
                                      {SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
                                      {SQLITE_DBCONFIG_DQS_DML, 0}, {SQLITE_DBCONFIG_DQS_DDL, 0}}) {
    sqlite3_db_config(database.getHandle(), option, value, nullptr);
  }
  database.exec("PRAGMA cell_size_check = ON; PRAGMA mmap_size = 0; PRAGMA temp_store = MEMORY");
}

/// System error of the last write to a store's log. For the whole connection SQLite tells only later ones.
int last_error_of_log(const SQLite::Database& database) {
  sqlite3_file* log = nullptr;
  int system_error = 0;
  sqlite3_file_control(database.getHandle(), "main", SQLITE_FCNTL_JOURNAL_POINTER, &log);
  if (log != nullptr && log->pMethods != nullptr)
    log->pMethods->xFileControl(log, SQLITE_FCNTL_LAST_ERRNO, &system_error);
  return system_error;
}

/// @param flags  SQLite::OPEN_READWRITE or SQLite::OPEN_READONLY
SQLite::Database open_database(const std::filesystem::path& store, int flags, LogIndex index) {
  return SQLite::Database(store.string(), flags, kBusyTimeout_ms,
                          index == LogIndex::kMemory ? "unix-excl" : "");
}

SQLite::Database open_for_writing(const std::filesystem::path& store, LogIndex index) {
  return with_storage_errors([&] { return open_database(store, SQLite::OPEN_READWRITE, index); });
}

}  // namespace

bool is_damage(int sqlite_code) {
  const int primary = sqlite_code & 0xff;
  return primary == SQLITE_CORRUPT || primary == SQLITE_NOTADB;
}

Disk disk_state(const SQLite::Exception& error, const SQLite::Database* database) {
  if (error.getErrorCode() == SQLITE_FULL) return Disk::kFull;
  if (error.getErrorCode() != SQLITE_IOERR || database == nullptr) return Disk::kHasRoom;
  return disk_state(last_error_of_log(*database));
}

void roll_back_unfinished(SQLite::Database& database) noexcept {
  if (sqlite3_get_autocommit(database.getHandle()) == 0) database.tryExec("ROLLBACK");
}

Writer::Writer(const std::filesystem::path& store, LogIndex index)
    : file_lock_(store), index_(index), database_(open_for_writing(store, index)) {
  with_storage_errors([&] {
    harden(database_);
    // A store that is refused stays as it is: nothing is added to its log before all is known to go well, and
    // closing must not move it into the file.
    database_.exec("PRAGMA cache_spill = OFF");
    sqlite3_db_config(database_.getHandle(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
    prepare_schema(database_, store);
    // Freed pages are not wiped: results are no secrets, and wiping makes deleting slow.
    database_.exec(
        "PRAGMA foreign_keys = ON; PRAGMA secure_delete = OFF; PRAGMA synchronous = FULL; PRAGMA "
        "journal_size_limit = 67108864");
  });
}

Writer::~Writer() {
  // Nothing is lost if this fails: the log is read at the next start.
  if (accepted_) database_.tryExec("PRAGMA wal_checkpoint(TRUNCATE)");
}

void Writer::accept() {
  with_storage_errors([&] { database_.exec("PRAGMA cache_spill = ON"); });
  sqlite3_db_config(database_.getHandle(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 0, nullptr);
  accepted_ = true;
}

void Writer::set_durability(Durability durability) {
  if (durability == durability_) return;
  database_.exec(durability == Durability::kSurvivesPowerLoss ? "PRAGMA synchronous = FULL"
                                                              : "PRAGMA synchronous = NORMAL");
  durability_ = durability;
}

void Writer::empty_log() {
  const std::lock_guard lock(mutex_);
  if (accepted_) database_.tryExec("PRAGMA wal_checkpoint(TRUNCATE)");
}

void Writer::release_free_pages(Disk disk) {
  const char* const release =
      disk == Disk::kFull ? "PRAGMA incremental_vacuum(32)" : "PRAGMA incremental_vacuum(2048)";
  int before = std::numeric_limits<int>::max();
  for (int now = before - 1; now > 0 && now < before;) {
    const std::lock_guard lock(mutex_);
    with_storage_errors([&] {
      database_.exec(release);
      before = std::exchange(now, database_.execAndGet("PRAGMA freelist_count").getInt());
      if (disk == Disk::kFull) database_.tryExec("PRAGMA wal_checkpoint(TRUNCATE)");
    }, &database_);
  }
}

ReaderPool::Connection::Connection(const std::filesystem::path& store, LogIndex index)
    : database(open_database(store, SQLite::OPEN_READONLY, index)) {
  harden(database);
  database.exec("PRAGMA query_only = ON");
}

std::unique_ptr<ReaderPool::Connection> ReaderPool::take() {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      auto connection = std::move(idle_.back());
      idle_.pop_back();
      return connection;
    }
  }
  return std::make_unique<Connection>(store_, index_);
}

void ReaderPool::put_back(std::unique_ptr<Connection> connection) noexcept {
  const std::lock_guard lock(mutex_);
  if (idle_.size() < kMostIdle) idle_.push_back(std::move(connection));
}

}  // namespace jobs
