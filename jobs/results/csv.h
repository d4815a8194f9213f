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

}  // namespace jobs
