#pragma once

#include <cstdint>

#include <SQLiteCpp/SQLiteCpp.h>

namespace jobs {

/// Bytes of the file that hold something: pages that deletions have freed are filled again first.
inline constexpr const char* kUsedBytesQuery =
    "SELECT (page_count - freelist_count) * page_size FROM pragma_page_count(), pragma_freelist_count(), pragma_page_size()";

/// Checks, inside the transaction that has added something, that it may stay.
/// @param used   kUsedBytesQuery, prepared
/// @param limit  in bytes; 0: none
/// @throws StoreLimitReached if it may not
void check_quota(SQLite::Statement& used, std::int64_t limit);

}  // namespace jobs
