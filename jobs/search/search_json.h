// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/results/result_table.h"
#include "jobs/search/search_request.h"
#include "jobs/store/rows.h"

namespace jobs {

/// Resource as users see it. @param threads  how many jobs are computed at a time
[[nodiscard]] nlohmann::json search_json(const StudyRow& row, const SearchRequest& search,
                                         const SweepResults& results, int threads);

/// Entry of a listing: has no limits, and is made without a look at the jobs.
[[nodiscard]] nlohmann::json search_summary_json(const StudyRow& row);
[[nodiscard]] const std::vector<std::string>& search_listing_keys();

/// Flat rows, one a combination: the axes, what was looked for, the limit and its band.
[[nodiscard]] ResultTable limit_table(const StudyRow& row, const SearchRequest& search,
                                      const SweepResults& results);

}  // namespace jobs
