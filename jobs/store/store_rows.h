// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>

#include "jobs/store/store.h"

namespace jobs {

// Rows as one connection sees them, inside whatever transaction it is in.

[[nodiscard]] std::optional<SweepRow> read_sweep(const SQLite::Database& database, const std::string& id);
[[nodiscard]] std::optional<JobRow> read_job(const SQLite::Database& database, const std::string& id);
[[nodiscard]] std::optional<SweepResults> read_results(const SQLite::Database& database, const std::string& sweep_id,
                                                       RowParameters parameters);
[[nodiscard]] std::optional<StudyRow> read_study(const SQLite::Database& database, const std::string& id);

/// Stores the response to a request under its key, and deletes those that are too old.
void store_response(SQLite::Database& database, const std::string& key, const std::string& fingerprint,
                    const std::string& response);

}  // namespace jobs
