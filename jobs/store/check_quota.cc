// SPDX-License-Identifier: Apache-2.0
#include "jobs/store/check_quota.h"

#include <cstdint>
#include <limits>

#include <sys/statvfs.h>

#include "jobs/base/errors.h"
#include "jobs/base/size_text.h"

namespace jobs {

namespace {

void check_store(SQLite::Statement& used, std::int64_t most_bytes) {
  used.executeStep();
  if (used.getColumn(0).getInt64() <= most_bytes) return;
  throw StoreSizeReached("the store may hold " + size_text(static_cast<double>(most_bytes)) +
                         " and has no room for this; delete sweeps that are not needed any more");
}

}  // namespace

std::int64_t find_bytes_left(const std::filesystem::path& file) {
  struct statvfs disk {};
  if (::statvfs(file.c_str(), &disk) != 0) return std::numeric_limits<std::int64_t>::max();
  return static_cast<std::int64_t>(disk.f_bavail * disk.f_frsize);
}

void check_disk(const std::filesystem::path& file, std::int64_t reserve_bytes) {
  const std::int64_t left = find_bytes_left(file);
  if (left >= reserve_bytes) return;
  throw StoreLimitReached(
      "the disk that holds the store has " + size_text(static_cast<double>(left)) + " left, and " +
      size_text(static_cast<double>(reserve_bytes)) +
      " of it are kept free; make room on it, or delete sweeps that are not needed any more");
}

void check_quota(SQLite::Statement& used, const StoreQuota& quota, const std::filesystem::path& file) {
  if (quota.most_bytes > 0) check_store(used, quota.most_bytes);
  if (quota.reserve_bytes > 0) check_disk(file, quota.reserve_bytes);
}

}  // namespace jobs
