// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/statistics/replicate_statistics.h"

namespace jobs {

/// Flat rows, one a job, in the order in which the sweep was expanded. Columns are the same for JSON and CSV:
/// job_id, state, replicate (if the sweep has any), the swept parameters, every metric.
struct ResultTable {
  std::vector<std::string> columns;
  std::vector<std::vector<nlohmann::json>> rows;  ///< null where a job has no value
  /// Of each row's set, one a row; empty unless sets were run more than once
  std::vector<ReplicateStatistics> replicates{};
  bool ended = false;  ///< whether the sweep had ended
};

}  // namespace jobs
