// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <SQLiteCpp/SQLiteCpp.h>

namespace jobs {

/// @returns whether a database is a store of this program, of whatever version. An empty file is none.
[[nodiscard]] bool is_store(SQLite::Database& database);

/// Makes a new file a store, or brings an older one to the newest form; each step is one transaction.
/// @throws StorageError if the file is not ours, is of a newer program, or is damaged. Such a file stays as
///     it is; its log does if closing the database leaves it alone.
void prepare_schema(SQLite::Database& database, const std::filesystem::path& store);

}  // namespace jobs
