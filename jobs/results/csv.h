// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "engine/analysis/quantities.h"
#include "jobs/results/result_table.h"

namespace jobs {

/// CSV of a table or a trajectory: RFC 4180, a header line, numbers that read back exactly, empty cells for
/// null. The statistics of replicates are the last columns: replicates_count, _mean, _spread, _min, _max.
[[nodiscard]] std::string to_csv(const ResultTable& table);
[[nodiscard]] std::string to_csv(const engine::Trajectory& trajectory);

// The header line and one of the rows of a trajectory's CSV.
void append_csv_head(std::string& csv, const std::vector<engine::QuantityInfo>& channels);
void append_csv_row(std::string& csv, const std::vector<std::vector<double>>& columns, std::size_t row);

}  // namespace jobs
