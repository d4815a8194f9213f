// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/results/result_table.h"
#include "server/report/headlines.h"
#include "server/report/report_view.h"

namespace server::report {

/// Programs and machines that computed the jobs of a sweep.
struct Provenance {
  std::vector<nlohmann::json> setups;  ///< {"version", "commit", "compiler", "engine", "host", "cpu", "jobs"}
  std::size_t jobs_examined = 0;       ///< fewer than all, of large sweeps
};

/// Report of a sweep as one self-contained page: headlines, largest values, figures, tables, request,
/// provenance, and the command that repeats it.
/// @param sweep    its resource
/// @param results  all its rows
/// @throws jobs::InvalidRequest for a metric or an axis that the sweep does not have
[[nodiscard]] std::string make_report(const nlohmann::json& sweep, const jobs::ResultTable& results,
                                      const ReportQuery& query, const FailureCounts& failures,
                                      const Provenance& provenance);

/// A sweep's request with its axes, and those of its design, in the order in which they were given: points
/// depend on it.
[[nodiscard]] nlohmann::ordered_json request_in_order(const nlohmann::json& sweep);

/// The command that submits a request anew, to the service that RPSUP_URL names or the one on this machine.
[[nodiscard]] std::string make_command(const nlohmann::ordered_json& request);

}  // namespace server::report
