// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include "jobs/store/store.h"

namespace jobs {
namespace {

/// Makes the file, for its owner only: SQLite would make it readable for all.
void make_empty_file(const std::filesystem::path& file) {
  const int made = ::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (made < 0)
    throw StorageError("cannot make " + file.string() + ": " + std::strerror(errno), 0, disk_state(errno));
  ::close(made);
}

int ask_whether_to_stop(void* stop) { return (*static_cast<const std::function<bool()>*>(stop))() ? 1 : 0; }

}  // namespace

bool copy_store(const std::filesystem::path& store, const std::filesystem::path& file,
                const std::function<bool()>& stop) {
  constexpr int kBusyTimeout_ms = 5000;
  constexpr int kStepsBetweenQuestions = 1000;
  make_empty_file(file);
  try {
    return with_storage_errors([&] {
      // A read-only connection of its own: it holds one snapshot of the store, while the others go on.
      SQLite::Database database(store.string(), SQLite::OPEN_READONLY, kBusyTimeout_ms);
      auto question = stop;
      sqlite3_progress_handler(database.getHandle(), kStepsBetweenQuestions, ask_whether_to_stop, &question);
      SQLite::Statement copy(database, "VACUUM INTO ?");
      copy.bind(1, file.string());
      if (copy.tryExecuteStep() != SQLITE_INTERRUPT) {
        if (database.getErrorCode() != SQLITE_DONE) throw SQLite::Exception(database.getHandle());
        return true;
      }
      std::filesystem::remove(file);
      return false;
    });
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    throw;
  }
}

}  // namespace jobs
