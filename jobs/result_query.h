#pragma once

#include <string>
#include <vector>

#include "jobs/service.h"

namespace jobs {

/// The columns that a table has only if a query names them: parameters that the sweep does not vary, then kErrorColumns.
/// @param swept  what the sweep varies
[[nodiscard]] std::vector<std::string> find_other_columns(const ResultQuery& query, const std::vector<std::string>& swept);

/// Keeps the rows that pass every filter, orders them, cuts the table off and takes the columns that are wanted.
/// @throws InvalidRequest with every fault: a name that is no column, a comparison that a column does not know
void apply(const ResultQuery& query, ResultTable& table);

}  // namespace jobs
