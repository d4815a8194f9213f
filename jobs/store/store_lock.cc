// SPDX-License-Identifier: Apache-2.0
#include "jobs/store/store_lock.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sqlite3.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

namespace jobs {
namespace {

constexpr mode_t kOwnerOnly = 0600;

StorageError system_error(const std::string& what) {
  return StorageError(what + ": " + std::strerror(errno), 0, disk_state(errno));
}

bool has_content(const std::filesystem::path& file) {
  std::error_code missing;
  const auto size = std::filesystem::file_size(file, missing);
  return !missing && size > 0;
}

/// SQLite would delete a log that lies beside no store, and with it what had not been moved into the store
/// yet.
void check_log_has_store(const std::filesystem::path& store) {
  const std::string log = store.string() + "-wal";
  if (has_content(store) || !has_content(log)) return;
  throw StorageError("the store " + store.string() + " is missing or empty, but its log " + log +
                         " is there and may hold results: put the store back beside it, or move the log "
                         "away; it has been left as it is",
                     SQLITE_CORRUPT);
}

/// A store that was copied or restored may be open to all who use the machine.
void keep_from_others(const std::string& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode) || (status.st_mode & 077U) == 0) return;
  if (::chmod(file.c_str(), kOwnerOnly) == 0) return;
  throw system_error("others than its owner may read or write " + file +
                     ", and its mode cannot be changed to 0600");
}

/// SQLite would make the file readable for all; its log and index files copy the file's mode.
/// @returns whether there was none
bool make_for_owner(const std::filesystem::path& store) {
  check_log_has_store(store);
  const int file = ::open(store.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kOwnerOnly);
  if (file >= 0) {
    ::close(file);
  } else if (errno != EEXIST) {
    throw system_error("cannot make the store " + store.string());
  }
  for (const char* suffix : {"", "-wal", "-shm"}) keep_from_others(store.string() + suffix);
  return file >= 0;
}

/// One byte far beyond those that SQLite locks, from 2^30 on.
struct flock lock_of_file(short type) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = off_t{1} << 62;
  lock.l_len = 1;
  return lock;
}

/// @returns whether another descriptor holds the lock of a file; nothing is locked by asking
bool is_locked(int file) {
  struct flock lock = lock_of_file(F_RDLCK);
  return ::fcntl(file, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

/// Closes a file that could not be locked. @throws StorageError that says why
[[noreturn]] void throw_not_locked(int file, const std::string& path, const std::filesystem::path& store) {
  const StorageError error =
      errno == EWOULDBLOCK
          ? StorageError("the store " + store.string() + " is in use by another process", SQLITE_BUSY)
          : system_error("cannot lock " + path);
  ::close(file);
  throw error;
}

/// @throws StorageError if another descriptor has locked the file
void lock_file(int file, const std::filesystem::path& store) {
  struct flock lock = lock_of_file(F_WRLCK);
  if (::fcntl(file, F_OFD_SETLK, &lock) == 0) return;
  if (errno != EAGAIN && errno != EACCES) throw system_error("cannot lock " + store.string());
  throw StorageError("the store " + store.string() + " is in use by another process, under another name",
                     SQLITE_BUSY);
}

/// Checks that nobody has locked a file but under this name, whose lock file then is locked, too.
void check_not_locked_elsewhere(int file, const std::filesystem::path& store) {
  const std::string path = std::filesystem::weakly_canonical(store).string() + ".lock";
  const int own = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool other_name = own < 0 ? errno == ENOENT : !is_locked(own);
  if (own >= 0) ::close(own);
  if (is_locked(file) && other_name)
    throw StorageError("the store " + store.string() +
                           " is in use by another process, under another name, which its log belongs to: "
                           "export it under that one",
                       SQLITE_BUSY);
}

/// With several names the log of a process that was killed may lie beside another one, unseen.
void check_has_one_name(int file, const std::filesystem::path& store) {
  struct stat status {};
  if (::fstat(file, &status) != 0 || !S_ISREG(status.st_mode) || status.st_nlink < 2) return;
  throw StorageError("the store " + store.string() + " has " + std::to_string(status.st_nlink) +
                         " names (hard links), and its log belongs to one of them: keep one name, or make "
                         "the others copies (cp, rpsup export); it has been left as it is",
                     SQLITE_CANTOPEN);
}

/// Extended attribute of a store that is open: inode of its folder and name, which its log is named after.
/// The attribute belongs to the file, whatever its name; a copy by cp has none, and some file systems keep
/// none.
constexpr const char* kLogMark = "user.rpsup.log_of";

std::string log_mark_of(const std::filesystem::path& store) {
  const std::filesystem::path path = std::filesystem::weakly_canonical(store);
  struct stat folder {};
  ::stat(path.parent_path().c_str(), &folder);
  return std::to_string(folder.st_ino) + " " + path.string();
}

/// Folder's inode and file name of a mark.
std::pair<std::string, std::string> place_of(const std::string& mark) {
  return {mark.substr(0, mark.find(' ')), mark.substr(mark.rfind('/') + 1)};
}

/// A process that was killed leaves its log beside the name that it used: under another name, as of a bind
/// mount, the store would be opened without it.
void check_log_is_here(int file, const std::filesystem::path& store) {
  constexpr std::size_t kLongestMark = 4096;
  std::string mark(kLongestMark, '\0');
  const ssize_t length = ::fgetxattr(file, kLogMark, mark.data(), mark.size());
  if (length <= 0 || has_content(store.string() + "-wal")) return;
  mark.resize(static_cast<std::size_t>(length));
  if (place_of(mark) == place_of(log_mark_of(store))) return;
  throw StorageError("the store " + store.string() + " was not closed when it was last used, as " +
                         mark.substr(mark.find(' ') + 1) +
                         ", and its log lies beside that name: start once under that name, or, if the log is "
                         "lost, use a copy (cp); it has been left as it is",
                     SQLITE_CANTOPEN);
}

/// @returns whether a name leads to the file that a descriptor has
bool is_named(int file, const std::string& path) {
  struct stat opened {};
  struct stat named {};
  return ::fstat(file, &opened) == 0 && ::stat(path.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
         opened.st_ino == named.st_ino;
}

}  // namespace

Disk disk_state(int system_error) {
  return system_error == ENOSPC || system_error == EDQUOT || system_error == EFBIG ? Disk::kFull
                                                                                   : Disk::kHasRoom;
}

// One lock for one file, whichever of its names is used.
StoreLock::StoreLock(const std::filesystem::path& store)
    : path_(std::filesystem::weakly_canonical(store).string() + ".lock") {
  // Again if the file was removed in between, by a start that was refused: its lock would keep nobody out.
  for (bool locked = false; !locked;) {
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kOwnerOnly);
    made_ = file_ >= 0;
    if (!made_ && errno == EEXIST) file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kOwnerOnly);
    if (file_ < 0) throw system_error("cannot open " + path_);
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) throw_not_locked(file_, path_, store);
    locked = is_named(file_, path_);
    if (!locked) ::close(file_);
  }
  struct flock lock = lock_of_file(F_WRLCK);  // for is_locked()
  static_cast<void>(::fcntl(file_, F_OFD_SETLK, &lock));
}

StoreLock::~StoreLock() {
  if (made_ && !kept_) ::unlink(path_.c_str());
  ::close(file_);
}

bool StoreLock::hold_room() {
  constexpr off_t kRoom = 2 << 20;
  const std::lock_guard lock(room_mutex_);
  if (lent_ > 0) return false;
  if (has_room_) return true;
  // A file system that cannot set room aside is no full one.
  has_room_ = disk_state(::posix_fallocate(file_, 0, kRoom)) != Disk::kFull;
  if (!has_room_) static_cast<void>(::ftruncate(file_, 0));
  return has_room_;
}

bool StoreLock::has_room() {
  const std::lock_guard lock(room_mutex_);
  return has_room_;
}

void StoreLock::release_room(int lent) {
  const std::lock_guard lock(room_mutex_);
  lent_ += lent;
  has_room_ = false;
  struct stat status {};
  if (::fstat(file_, &status) == 0 && status.st_blocks > 0) static_cast<void>(::ftruncate(file_, 0));
}

StoreFileLock::StoreFileLock(const std::filesystem::path& store)
    : path_(store.string()), made_(make_for_owner(store)) {
  file_ = ::open(store.c_str(), O_RDWR | O_CLOEXEC);
  if (file_ < 0) return;  // SQLite tells why when it opens the file
  try {
    lock_file(file_, store);
    check_has_one_name(file_, store);
    check_log_is_here(file_, store);
    const std::string mark = log_mark_of(store);
    static_cast<void>(::fsetxattr(file_, kLogMark, mark.data(), mark.size(), 0));
    log_ = std::filesystem::weakly_canonical(store).string() + "-wal";
  } catch (...) {
    ::close(file_);
    throw;
  }
}

StoreFileLock::~StoreFileLock() {
  if (made_ && !kept_) {
    for (const char* suffix : {"-wal", "-shm", ""}) ::unlink((path_ + suffix).c_str());
  }
  if (file_ < 0) return;
  if (!has_content(log_)) static_cast<void>(::fremovexattr(file_, kLogMark));
  ::close(file_);
}

void StoreFileLock::check() const {
  if (file_ < 0 || is_named(file_, path_)) return;
  throw StorageError("the store's file " + path_ +
                         " was removed, moved or replaced while it was in use; nothing is written until it "
                         "is back",
                     SQLITE_READONLY_DBMOVED);
}

void check_name_of_store(const std::filesystem::path& store) {
  const int file = ::open(store.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) throw system_error("cannot read the store " + store.string());
  try {
    check_not_locked_elsewhere(file, store);
    check_has_one_name(file, store);
    check_log_is_here(file, store);
  } catch (...) {
    ::close(file);
    throw;
  }
  ::close(file);
}

}  // namespace jobs
