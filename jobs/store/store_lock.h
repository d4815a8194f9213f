// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <mutex>
#include <string>

#include "jobs/base/errors.h"

namespace jobs {

/// The lock that a process holds as long as it has a store open: <store>.lock. The kernel drops it when the
/// process dies. The file also holds room on the disk, so that a store can be opened and made smaller when
/// the disk is full.
class StoreLock {
 public:
  /// @throws StorageError if another process (or another store of this one) holds it
  explicit StoreLock(const std::filesystem::path& store);
  ~StoreLock();  ///< removes the file, if it was made here and is not kept
  StoreLock(const StoreLock&) = delete;
  StoreLock& operator=(const StoreLock&) = delete;

  /// Keeps or gives up a file that was made here: a refused start leaves nothing behind.
  void keep(bool kept) { kept_ = kept; }

  /// Takes the room, unless the file has it. False if the disk is full, or the room is lent.
  bool hold_room();
  [[nodiscard]] bool has_room();

  /// The room is free on the disk, for one who makes the store smaller. As long as this lives nobody takes
  /// the room back, as the end of a job or a probe would in between.
  class LentRoom {
   public:
    explicit LentRoom(StoreLock& lock) : lock_(lock) { lock_.release_room(+1); }
    ~LentRoom() { lock_.release_room(-1); }
    LentRoom(const LentRoom&) = delete;
    LentRoom& operator=(const LentRoom&) = delete;

   private:
    StoreLock& lock_;
  };

 private:
  void release_room(int lent);

  const std::string path_;
  bool made_ = false;
  bool kept_ = false;
  int file_ = -1;
  std::mutex room_mutex_;  // guards has_room_ and lent_
  bool has_room_ = false;
  int lent_ = 0;  ///< to so many at once
};

/// Lock of the store's file itself, whatever its name: a hard link and a bind mount are the same file, but
/// SQLite names the log after the name, so that two who use two names lose each other's work. Open file
/// description lock of one byte beyond those that SQLite locks.
class StoreFileLock {
 public:
  /// Makes the file if there is none.
  /// @throws StorageError if the file is in use under another name, or has several, or was not closed when it
  ///     was in use under another one, which its log lies beside
  explicit StoreFileLock(const std::filesystem::path& store);
  ~StoreFileLock();  ///< removes a store that was made here and is not kept
  StoreFileLock(const StoreFileLock&) = delete;
  StoreFileLock& operator=(const StoreFileLock&) = delete;

  void keep(bool kept) { kept_ = kept; }

  /// Checks that the store's name still leads to the file that was opened, which may have been removed or
  /// replaced: what is written to it then is lost with the process. @throws StorageError
  void check() const;

 private:
  const std::string path_;
  bool made_ = false;
  bool kept_ = false;
  std::filesystem::path log_;
  int file_ = -1;
};

/// Checks that a file that somebody else may serve is not served under another name, has one name only, and
/// has its log beside this name.
/// Not for a file that this process serves: closing it takes away SQLite's locks.
void check_name_of_store(const std::filesystem::path& store);

/// Disk after a failed system call: full if the disk, or the share of this user or process, was the cause.
[[nodiscard]] Disk disk_state(int system_error);

}  // namespace jobs
