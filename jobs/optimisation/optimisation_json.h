// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/optimisation/optimiser.h"
#include "jobs/results/result_table.h"
#include "jobs/store/rows.h"

namespace jobs {

/// Resource as users see it. @param threads  how many jobs are computed at a time
[[nodiscard]] nlohmann::json optimisation_json(const StudyRow& row, const Optimiser& optimiser,
                                               const SweepResults& results, int threads);

/// Entry of a listing: has no candidates, and is made without a look at the jobs.
[[nodiscard]] nlohmann::json optimisation_summary_json(const StudyRow& row);
[[nodiscard]] const std::vector<std::string>& optimisation_listing_keys();

/// Columns of a table of candidates that are neither variables nor metrics.
[[nodiscard]] const std::vector<std::string>& candidate_columns();
/// Column of a bound: "peak_contact_force_n_at_most".
[[nodiscard]] std::string column_of(const MetricBound& bound);

/// Flat rows, one a candidate, in the order in which they were asked for: values of the variables, start,
/// state, objectives and bounds.
[[nodiscard]] ResultTable candidate_table(const StudyRow& row, const Optimiser& optimiser);

}  // namespace jobs
