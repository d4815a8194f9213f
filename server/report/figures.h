// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "jobs/results/result_table.h"

namespace server::report {

/// Metrics over the first number that a sweep varies, a line for each combination of what else it varies:
/// means with the least and the largest of what lies together. Empty if it varies no number.
[[nodiscard]] std::string make_figures(const nlohmann::json& sweep, const jobs::ResultTable& results);

}  // namespace server::report
