// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>

#include "jobs/store/rows.h"

namespace jobs {

class ActiveSweepCache;

[[nodiscard]] inline std::optional<std::int64_t> optional_int(const SQLite::Column& column) {
  return column.isNull() ? std::nullopt : std::optional(column.getInt64());
}
[[nodiscard]] inline std::optional<double> optional_double(const SQLite::Column& column) {
  return column.isNull() ? std::nullopt : std::optional(column.getDouble());
}

// Rows as one connection sees them, inside whatever transaction it is in.

[[nodiscard]] std::optional<SweepRow> read_sweep(const SQLite::Database& database, const std::string& id,
                                                 ActiveSweepCache& cache);
[[nodiscard]] std::optional<JobRow> read_job(const SQLite::Database& database, const std::string& id);
[[nodiscard]] std::optional<SweepResults> read_results(const SQLite::Database& database,
                                                       const std::string& sweep_id, RowParameters parameters,
                                                       ActiveSweepCache& cache);
/// As ClusterBatches::find_cost_rates().
[[nodiscard]] std::map<std::string, double> read_cost_rates(const SQLite::Database& database);
[[nodiscard]] std::optional<StudyRow> read_study(const SQLite::Database& database, const std::string& id);

}  // namespace jobs
