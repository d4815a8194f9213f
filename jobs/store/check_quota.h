// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include <SQLiteCpp/SQLiteCpp.h>

#include "jobs/store/store_quota.h"

namespace jobs {

/// Bytes of the file that hold something: pages that deletions have freed are filled again first.
inline constexpr const char* kUsedBytesQuery =
    "SELECT (page_count - freelist_count) * page_size FROM pragma_page_count(), pragma_freelist_count(), "
    "pragma_page_size()";

/// Checks, inside the transaction that has added something, that it may stay.
/// @param used  kUsedBytesQuery, prepared
/// @param file  of the store
/// @throws StoreLimitReached if it may not
void check_quota(SQLite::Statement& used, const StoreQuota& quota, const std::filesystem::path& file);

/// Bytes that the disk of a file has left; of a disk that does not tell, the largest number: writing finds
/// out what there is.
[[nodiscard]] std::int64_t find_bytes_left(const std::filesystem::path& file);

/// Checks that the disk has so much left. @throws StoreLimitReached
void check_disk(const std::filesystem::path& file, std::int64_t reserve_bytes);

}  // namespace jobs
