// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/results/result_table.h"
#include "jobs/store/rows.h"

namespace jobs {

/// A condition on the rows of a table.
struct ResultFilter {
  std::string key;    ///< a column, for equality, or a column with _gt, _lt, _ge or _le
  std::string value;
};

/// Query of the results of a sweep. Columns are those of its table, all other parameters, and kErrorColumns.
struct ResultQuery {
  /// Columns, with commas between, in the order in which they are wanted; empty: all
  std::string fields{};
  std::vector<ResultFilter> filters{};  ///< rows that have no value of the column pass none
  /// Columns, with commas between; one with a leading '-' has its largest values first. Null comes last
  std::string order_by{};
  std::optional<std::size_t> limit{};  ///< rows
  std::string metric{};                ///< of replicates' statistics; empty: see choose_metric()
};

/// Columns of why a job failed, as a word and as a sentence. Tables have them only if a query names them.
inline constexpr std::array<std::string_view, 2> kErrorColumns{"error_reason", "error_detail"};

[[nodiscard]] inline bool is_error_column(std::string_view column) {
  return std::ranges::find(kErrorColumns, column) != kErrorColumns.end();
}

/// The columns that a table has only if a query names them: parameters that the sweep does not vary, then
/// kErrorColumns.
/// @param swept  what the sweep varies
[[nodiscard]] std::vector<std::string> find_other_columns(const ResultQuery& query,
                                                          const std::vector<std::string>& swept);

/// Parameters of its jobs that the table needs for these columns.
[[nodiscard]] RowParameters needed_parameters(const std::vector<std::string>& others);

inline constexpr std::string_view kSweepColumns =
    "GET /v1/parameters and GET /v1/sweeps/{id}/results; error_reason and error_detail are two more";
inline constexpr std::string_view kStudyColumns = "its results without fields";

/// Keeps the rows that pass every filter, orders them, cuts the table off and takes the columns that are
/// wanted.
/// @param listed  where columns are listed, for messages
/// @throws InvalidRequest with every fault: a name that is no column, a comparison that a column does not
///     know
void apply(const ResultQuery& query, ResultTable& table, std::string_view listed);

}  // namespace jobs
