// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>

#include "jobs/base/errors.h"
#include "jobs/store/store_lock.h"

namespace jobs {

/// Disk after a failure of SQLite: full if the disk, or the share of this user or process, was the cause.
/// SQLite's codes know the disk only; the error of its last system call tells of the others.
/// @param database  that failed; null: unknown
[[nodiscard]] Disk disk_state(const SQLite::Exception& error, const SQLite::Database* database);

/// @returns whether a code of SQLite's, extended or not, says that the file is damaged or no database
[[nodiscard]] bool is_damage(int sqlite_code);

/// Runs database work and throws StorageError in the place of SQLite's exceptions.
/// @param database  that the work is done with; null: one of its own
template <typename Work>
auto with_storage_errors(Work&& work, const SQLite::Database* database = nullptr) {
  try {
    return std::forward<Work>(work)();
  } catch (const SQLite::Exception& error) {
    throw StorageError(std::string("the store failed: ") + error.what(), error.getExtendedErrorCode(),
                       disk_state(error, database));
  }
}

/// Guarantee of a commit when it returns.
enum class Durability {
  kSurvivesProcess,    ///< of what can be computed again
  kSurvivesPowerLoss,  ///< of what has been promised to a user
};

/// The statements of a connection that are run again and again, each prepared once.
class Statements {
 public:
  explicit Statements(SQLite::Database& database) : database_(database) {}

  /// A statement that is being run, with null for every parameter at first. Done with at the end of its
  /// scope: one that waits for its next row would keep the log from being moved into the file.
  class Use {
   public:
    explicit Use(SQLite::Statement& statement) : statement_(statement) { statement_.clearBindings(); }
    ~Use() { statement_.tryReset(); }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    SQLite::Statement* operator->() const { return &statement_; }

   private:
    SQLite::Statement& statement_;
  };

  /// @param sql  a literal: it is told from others by its address
  [[nodiscard]] Use use(const char* sql) {
    return Use(prepared_.try_emplace(sql, database_, sql).first->second);
  }

 private:
  SQLite::Database& database_;
  std::map<const char*, SQLite::Statement> prepared_;
};

/// Rolls back a transaction that has not been committed, if there is one. SQLite itself has done it after
/// some failures; without memory even this may fail, and is then for whoever uses the connection next.
void roll_back_unfinished(SQLite::Database& database) noexcept;

/// Like SQLite::Transaction, for connections that must go on whatever fails.
class Transaction {
 public:
  /// @param begin  the statement that begins it
  Transaction(SQLite::Database& database, const char* begin) : database_(database) {
    roll_back_unfinished(database_);
    database_.exec(begin);
  }
  ~Transaction() { roll_back_unfinished(database_); }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  void commit() { database_.exec("COMMIT"); }

 private:
  SQLite::Database& database_;
};

/// Place of the index of a store's log, which all of a store's connections share.
enum class LogIndex {
  kFile,    ///< <store>-shm, for other processes as well
  kMemory,  ///< of this process, which keeps all others out: for a disk that has no room for the file
};

/// The one connection that writes, and that moves the log into the file (checkpoints): with SQLite before
/// 3.51.3 a checkpoint beside another connection's commit can damage a store, so no second connection may do
/// either.
class Writer {
 public:
  explicit Writer(const std::filesystem::path& store, LogIndex index);
  ~Writer();  ///< moves the log into the file, if accept() was called
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Runs work(database) in one transaction: all of it, or nothing if it throws.
  template <typename Work>
  auto write(Durability durability, Work&& work) {
    return write_with(durability, std::forward<Work>(work), database_, Order::kInvalidated);
  }

  /// Version of the scheduling order, for who keeps one. Grows with each write(), and with each write_often()
  /// that fails or calls invalidate_order(). The transaction at hand counts. Under the writer's lock, within
  /// work.
  [[nodiscard]] std::uint64_t order_version() const { return order_version_; }
  /// Marks the transaction at hand as one that queues jobs. Within work of write_often().
  void invalidate_order() { ++order_version_; }

  /// The same for work(statements), which is done often.
  template <typename Work>
  auto write_often(Durability durability, Work&& work) {
    return write_with(durability, std::forward<Work>(work), statements_, Order::kKept);
  }

  /// Says that the store has shown no damage. Until then its file is left as it is, however this ends.
  void accept();

  /// Keeps or gives up a store that was made here.
  void keep(bool kept) { file_lock_.keep(kept); }

  [[nodiscard]] LogIndex log_index() const { return index_; }

  /// See StoreFileLock::check(). Every write checks it, too.
  void check_file() const { file_lock_.check(); }

  /// Gives pages that deletions have freed back to the file system, some at a time so that others get their
  /// turn.
  /// @param disk  kFull: few at a time, which the log has room for, and it is emptied each time
  void release_free_pages(Disk disk);

  /// Moves the log into the file and gives its room back, as far as that is possible now.
  void empty_log();

 private:
  enum class Order { kInvalidated, kKept };

  /// Counts the transaction unless it did not fail.
  struct FailureCount {
    std::uint64_t& order_version;
    bool failed = true;
    ~FailureCount() {
      if (failed) ++order_version;
    }
  };

  template <typename Work, typename With>
  auto write_with(Durability durability, Work&& work, With& with, Order order) {
    const std::lock_guard lock(mutex_);
    if (order == Order::kInvalidated) ++order_version_;
    return with_storage_errors([&] { return run_transaction(durability, work, with); }, &database_);
  }

  template <typename Work, typename With>
  auto run_transaction(Durability durability, Work& work, With& with) {
    FailureCount count{.order_version = order_version_};
    file_lock_.check();
    roll_back_unfinished(database_);
    set_durability(durability);
    Transaction transaction(database_, "BEGIN IMMEDIATE");
    if constexpr (std::is_void_v<decltype(work(with))>) {
      work(with);
      commit(transaction, count);
    } else {
      auto result = work(with);
      commit(transaction, count);
      return result;
    }
  }

  void commit(Transaction& transaction, FailureCount& count) {
    file_lock_.check();
    transaction.commit();
    count.failed = false;
  }

  void set_durability(Durability durability);

  /// Closed last: closing any descriptor of the file takes away SQLite's own locks on it.
  StoreFileLock file_lock_;
  const LogIndex index_;
  std::mutex mutex_;  // guards the rest
  SQLite::Database database_;
  Statements statements_{database_};
  Durability durability_ = Durability::kSurvivesPowerLoss;
  std::uint64_t order_version_ = 1;
  bool accepted_ = false;
};

/// Read-only connections, kept for the next who needs one.
class ReaderPool {
 public:
  ReaderPool(std::filesystem::path store, LogIndex index) : store_(std::move(store)), index_(index) {
    idle_.reserve(kMostIdle);
  }

  /// Runs work(database) on one consistent snapshot of the store.
  template <typename Work>
  auto read(Work&& work) {
    return with_storage_errors([&] {
      Lease lease(*this);
      Transaction transaction(lease.connection->database, "BEGIN");
      return work(static_cast<const SQLite::Database&>(lease.connection->database));
    });
  }

  /// The same for work(statements), which is done often, and reads one thing.
  template <typename Work>
  auto read_often(Work&& work) {
    return with_storage_errors([&] {
      Lease lease(*this);
      roll_back_unfinished(lease.connection->database);
      return work(lease.connection->statements);
    });
  }

 private:
  struct Connection {
    Connection(const std::filesystem::path& store, LogIndex index);

    SQLite::Database database;
    Statements statements{database};
  };
  struct Lease {
    explicit Lease(ReaderPool& owner) : pool(owner), connection(owner.take()) {}
    ~Lease() { pool.put_back(std::move(connection)); }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;

    ReaderPool& pool;
    std::unique_ptr<Connection> connection;
  };

  std::unique_ptr<Connection> take();
  /// Takes no memory: it is called while exceptions are on their way.
  void put_back(std::unique_ptr<Connection> connection) noexcept;

  static constexpr std::size_t kMostIdle = 8;

  const std::filesystem::path store_;
  const LogIndex index_;
  std::mutex mutex_;  // guards idle_
  std::vector<std::unique_ptr<Connection>> idle_;
};

}  // namespace jobs
