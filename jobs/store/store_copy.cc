// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include "jobs/base/errors.h"
#include "jobs/base/size_text.h"
#include "jobs/store/check_quota.h"
#include "jobs/store/store.h"
#include "jobs/store/store_connection.h"
#include "jobs/store/store_lock.h"
#include "jobs/store/store_schema.h"

namespace jobs {
namespace {

constexpr int kCopyBusyTimeout_ms = 5000;

/// Makes the file, for its owner only: SQLite would make it readable for all.
void make_empty_file(const std::filesystem::path& file) {
  const int made = ::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (made < 0)
    throw StorageError("cannot make " + file.string() + ": " + std::strerror(errno), 0, disk_state(errno));
  ::close(made);
}

/// @param file  where the copy is to be. @throws StoreLimitReached
void check_room_for_copy(SQLite::Database& store, const std::filesystem::path& file) {
  const std::int64_t needed = store.execAndGet(kUsedBytesQuery).getInt64();
  const std::int64_t left = find_bytes_left(file);
  if (needed < left) return;
  throw StoreLimitReached("the copy takes " + size_text(static_cast<double>(needed)) + " and the disk has " +
                          size_text(static_cast<double>(left)) + " left; make room on it");
}

int ask_whether_to_stop(void* stop) { return (*static_cast<const std::function<bool()>*>(stop))() ? 1 : 0; }

/// Writes what the store holds now to an empty file. @returns whether stop() let it go on to the end
bool vacuum_into(const std::filesystem::path& store, const std::filesystem::path& file,
                 std::function<bool()> stop) {
  constexpr int kStepsBetweenQuestions = 1000;
  // A read-only connection of its own: it holds one snapshot of the store, while the others go on. Those of
  // one process share the log's index, wherever it is.
  SQLite::Database database(store.string(), SQLite::OPEN_READONLY, kCopyBusyTimeout_ms);
  sqlite3_progress_handler(database.getHandle(), kStepsBetweenQuestions, ask_whether_to_stop, &stop);
  check_room_for_copy(database, file);
  SQLite::Statement copy(database, "VACUUM INTO ?");
  copy.bind(1, file.string());
  if (copy.tryExecuteStep() == SQLITE_INTERRUPT) return false;
  if (database.getErrorCode() != SQLITE_DONE) throw SQLite::Exception(database.getHandle());
  return true;
}

}  // namespace

void check_can_be_copied(const std::filesystem::path& store) {
  check_name_of_store(store);
  bool is_ours = false;
  try {
    SQLite::Database database(store.string(), SQLite::OPEN_READONLY, kCopyBusyTimeout_ms);
    is_ours = is_store(database);
  } catch (const SQLite::Exception& error) {
    if (!is_damage(error.getErrorCode()))
      throw StorageError("cannot read " + store.string() + ": " + error.what(), error.getExtendedErrorCode());
  }
  if (!is_ours) throw InvalidRequest(std::vector<Fault>{{store.string(), "is no store of this program"}});
}

bool copy_store(const std::filesystem::path& store, const std::filesystem::path& file,
                const std::function<bool()>& stop) {
  make_empty_file(file);
  try {
    const bool is_whole = with_storage_errors([&] { return vacuum_into(store, file, stop); });
    if (!is_whole) std::filesystem::remove(file);
    return is_whole;
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    throw;
  }
}

}  // namespace jobs
