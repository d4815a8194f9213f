// SPDX-License-Identifier: Apache-2.0
#include "tests/jobs/store/losing_disk.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <new>
#include <stdexcept>
#include <utility>

namespace jobs_tests {
namespace {

constexpr std::size_t kSector = 512;
constexpr const char* kName = "losing-disk";

LosingDisk* current = nullptr;
sqlite3_vfs* below = nullptr;

/// A file of SQLite's; that of the real system follows it in memory.
struct WatchedFile {
  sqlite3_file base;
  std::string* path;  ///< null: of no interest (temporary)

  static WatchedFile& of(sqlite3_file* file) { return *reinterpret_cast<WatchedFile*>(file); }
  static sqlite3_file* real(sqlite3_file* file) {
    return reinterpret_cast<sqlite3_file*>(reinterpret_cast<WatchedFile*>(file) + 1);
  }
};

/// Calls a method of the real file with the same arguments.
template <auto Method, typename... Arguments>
int pass_on(sqlite3_file* file, Arguments... arguments) {
  sqlite3_file* const real = WatchedFile::real(file);
  return (real->pMethods->*Method)(real, arguments...);
}

int close_file(sqlite3_file* file) {
  delete std::exchange(WatchedFile::of(file).path, nullptr);
  return pass_on<&sqlite3_io_methods::xClose>(file);
}

int write_file(sqlite3_file* file, const void* bytes, int size, sqlite3_int64 offset) {
  const int code = pass_on<&sqlite3_io_methods::xWrite>(file, bytes, size, offset);
  const std::string* const path = WatchedFile::of(file).path;
  if (code == SQLITE_OK && path != nullptr) {
    current->written(*path, static_cast<std::size_t>(offset),
                     std::string(static_cast<const char*>(bytes), static_cast<std::size_t>(size)));
  }
  return code;
}

int truncate_file(sqlite3_file* file, sqlite3_int64 size) {
  const int code = pass_on<&sqlite3_io_methods::xTruncate>(file, size);
  const std::string* const path = WatchedFile::of(file).path;
  if (code == SQLITE_OK && path != nullptr) current->cut(*path, static_cast<std::size_t>(size));
  return code;
}

int sync_file(sqlite3_file* file, int flags) {
  const int code = pass_on<&sqlite3_io_methods::xSync>(file, flags);
  const std::string* const path = WatchedFile::of(file).path;
  if (code == SQLITE_OK && path != nullptr) current->synced(*path);
  return code;
}

sqlite3_io_methods make_methods() {
  sqlite3_io_methods methods{};
  methods.iVersion = 2;
  methods.xClose = close_file;
  methods.xRead = pass_on<&sqlite3_io_methods::xRead>;
  methods.xWrite = write_file;
  methods.xTruncate = truncate_file;
  methods.xSync = sync_file;
  methods.xFileSize = pass_on<&sqlite3_io_methods::xFileSize>;
  methods.xLock = pass_on<&sqlite3_io_methods::xLock>;
  methods.xUnlock = pass_on<&sqlite3_io_methods::xUnlock>;
  methods.xCheckReservedLock = pass_on<&sqlite3_io_methods::xCheckReservedLock>;
  methods.xFileControl = pass_on<&sqlite3_io_methods::xFileControl>;
  methods.xSectorSize = pass_on<&sqlite3_io_methods::xSectorSize>;
  methods.xDeviceCharacteristics = pass_on<&sqlite3_io_methods::xDeviceCharacteristics>;
  methods.xShmMap = pass_on<&sqlite3_io_methods::xShmMap>;
  methods.xShmLock = pass_on<&sqlite3_io_methods::xShmLock>;
  methods.xShmBarrier = [](sqlite3_file* file) {
    WatchedFile::real(file)->pMethods->xShmBarrier(WatchedFile::real(file));
  };
  methods.xShmUnmap = pass_on<&sqlite3_io_methods::xShmUnmap>;
  return methods;
}

int open_file(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags, int* out_flags) {
  static const sqlite3_io_methods methods = make_methods();
  file->pMethods = nullptr;
  WatchedFile::of(file).path = nullptr;
  const int code = below->xOpen(below, name, WatchedFile::real(file), flags, out_flags);
  if (code != SQLITE_OK) return code;
  file->pMethods = &methods;
  if (name != nullptr) {
    WatchedFile::of(file).path = new std::string(name);
    current->opened(name);
  }
  return code;
}

int delete_file(sqlite3_vfs*, const char* name, int sync_directory) {
  const int code = below->xDelete(below, name, sync_directory);
  if (code == SQLITE_OK) current->deleted(name);
  return code;
}

sqlite3_vfs& shim() {
  static sqlite3_vfs vfs{};
  below = sqlite3_vfs_find("unix");
  vfs = *below;
  vfs.pNext = nullptr;
  vfs.zName = kName;
  vfs.szOsFile = static_cast<int>(sizeof(WatchedFile)) + below->szOsFile;
  vfs.xOpen = open_file;
  vfs.xDelete = delete_file;
  return vfs;
}

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

LosingDisk::LosingDisk(std::function<void()> on_sync) : on_sync_(std::move(on_sync)) {
  current = this;
  if (sqlite3_vfs_register(&shim(), 1) != SQLITE_OK)
    throw std::runtime_error("SQLite takes no other file system");
}

LosingDisk::~LosingDisk() {
  sqlite3_vfs_unregister(sqlite3_vfs_find(kName));
  sqlite3_vfs_register(below, 1);
  current = nullptr;
}

void LosingDisk::opened(const std::string& path) {
  files_.try_emplace(path, File{.safe = content_of(path), .changes = {}});
}

void LosingDisk::written(const std::string& path, std::size_t offset, std::string bytes) {
  // The disk writes sectors, each of them whole or not at all.
  for (std::size_t start = 0; start < bytes.size();) {
    const std::size_t size = std::min(kSector - (offset + start) % kSector, bytes.size() - start);
    files_.at(path).changes.push_back({.offset = offset + start, .bytes = bytes.substr(start, size)});
    start += size;
  }
}

void LosingDisk::cut(const std::string& path, std::size_t size) {
  files_.at(path).changes.push_back({.offset = size, .bytes = {}, .cuts = true});
}

void LosingDisk::synced(const std::string& path) {
  on_sync_();
  File& file = files_.at(path);
  for (const Change& change : file.changes) apply(change, file.safe);
  file.changes.clear();
}

void LosingDisk::deleted(const std::string& path) { files_.erase(path); }

void LosingDisk::apply(const Change& change, std::string& content) {
  if (change.cuts) return content.resize(change.offset);
  content.resize(std::max(content.size(), change.offset + change.bytes.size()));
  content.replace(change.offset, change.bytes.size(), change.bytes);
}

std::string LosingDisk::remains_of(const std::string& path, std::mt19937_64& dice) const {
  const auto file = files_.find(path);
  if (file == files_.end()) return {};
  std::string content = file->second.safe;
  const std::uint64_t kept_of_four = dice() % 5;  // none of it, all of it, or what chance leaves
  for (const Change& change : file->second.changes) {
    if (dice() % 4 < kept_of_four) apply(change, content);
  }
  return content;
}

void LosingDisk::leave(const std::filesystem::path& store, const std::filesystem::path& to,
                       std::mt19937_64& dice) const {
  for (const char* suffix : {"", "-wal"}) {
    std::ofstream(to.string() + suffix, std::ios::binary) << remains_of(store.string() + suffix, dice);
  }
}

}  // namespace jobs_tests
