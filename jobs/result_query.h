#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "jobs/service.h"

namespace jobs {

/// The columns that a table has only if a query names them: parameters that the sweep does not vary, then kErrorColumns.
/// @param swept  what the sweep varies
[[nodiscard]] std::vector<std::string> find_other_columns(const ResultQuery& query, const std::vector<std::string>& swept);

/// Whether the table needs the parameters of its jobs for these columns.
[[nodiscard]] bool need_parameters(const std::vector<std::string>& others);

inline constexpr std::string_view kSweepColumns = "GET /v1/parameters and GET /v1/sweeps/{id}/results; error_reason and error_detail are two more";
inline constexpr std::string_view kStudyColumns = "its results without fields";

/// Keeps the rows that pass every filter, orders them, cuts the table off and takes the columns that are wanted.
/// @param listed  where columns are listed, for messages
/// @throws InvalidRequest with every fault: a name that is no column, a comparison that a column does not know
void apply(const ResultQuery& query, ResultTable& table, std::string_view listed);

}  // namespace jobs
