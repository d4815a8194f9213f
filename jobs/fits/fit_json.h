// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/fits/fit_observer.h"
#include "jobs/fits/fit_problem.h"
#include "jobs/fits/fit_summary.h"
#include "jobs/results/result_table.h"
#include "jobs/store/rows.h"

namespace jobs {

/// Resource as users see it. @param threads  how many jobs are computed at a time
[[nodiscard]] nlohmann::json fit_json(const StudyRow& row, const FitProblem& problem,
                                      const FitSummary& summary, const SweepResults& results, int threads);

/// Entry of a listing: made without a look at the jobs.
[[nodiscard]] nlohmann::json fit_summary_json(const StudyRow& row);
[[nodiscard]] const std::vector<std::string>& fit_listing_keys();

/// Columns of a table of points that are no parameters.
[[nodiscard]] const std::vector<std::string>& fit_point_columns();

/// Flat rows, one a point, in the order in which they were asked for.
[[nodiscard]] ResultTable fit_point_table(const StudyRow& row, const FitProblem& problem,
                                          const FitSummary& summary);

/// Measured and predicted signals with the best values. Of a signal with more samples than
/// kMostSignalRows, evenly chosen ones.
[[nodiscard]] ResultTable fit_signal_table(const StudyRow& row, const FitObserver& observer,
                                           const FitSummary& summary);
inline constexpr std::size_t kMostSignalRows = 10'000;
[[nodiscard]] const std::vector<std::string>& fit_signal_columns();

}  // namespace jobs
