// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/results/result_table.h"

namespace server::report {

/// How jobs of a sweep were run, each way once.
struct Provenance {
  std::vector<nlohmann::json> ways;  ///< {"version", "commit", "compiler", "engine", "host", "cpu", "jobs"}
  std::size_t looked_at = 0;         ///< jobs; of large sweeps not all
};

/// A study on one page that stands by itself: what was asked for, figures, tables, how it was computed, and the one command that does it again.
/// @param sweep    its resource
/// @param results  all its rows
[[nodiscard]] std::string make_report(const nlohmann::json& sweep, const jobs::ResultTable& results, const Provenance& provenance);

/// A sweep's request with its axes, and those of its design, in the order in which they were given: points depend on it.
[[nodiscard]] nlohmann::ordered_json request_in_order(const nlohmann::json& sweep);

/// The command that submits a request anew, to the service that RPSUP_URL names or the one on this machine.
[[nodiscard]] std::string make_command(const nlohmann::ordered_json& request);

}  // namespace server::report
