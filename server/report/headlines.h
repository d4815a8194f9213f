// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "server/report/report_view.h"

namespace server::report {

/// Number of failed jobs by their error_reason.
using FailureCounts = std::map<std::string, std::size_t>;

/// Sentences on the sweep: largest and least value with their parameters, scatter of replicates, failures.
[[nodiscard]] std::string make_headlines(const ReportView& view, const FailureCounts& failures);

/// Table of the jobs with the largest values: value, time, parameters, link to the job in the dashboard.
[[nodiscard]] std::string make_largest(const ReportView& view);

}  // namespace server::report
