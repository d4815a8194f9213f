#pragma once

#include <optional>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>

#include "jobs/store.h"

namespace jobs {

// Rows as one connection sees them, inside whatever transaction it is in.

[[nodiscard]] std::optional<SweepRow> read_sweep(const SQLite::Database& database, const std::string& id);
[[nodiscard]] std::optional<JobRow> read_job(const SQLite::Database& database, const std::string& id);

}  // namespace jobs
