// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "jobs/results/result_table.h"

namespace jobs {

/// Sensitivity of a metric to each parameter of a sweep's design: a row for each parameter and each
/// combination of what else is swept. The response at a point is the mean over its replicates. Blocks of the
/// design with a point that has no value are left out.
///
///     morris:    effect_mean, effect_size with _low and _high, effect_deviation: of a whole range, in the
///                metric's unit
///     saltelli:  first_order and total with _low and _high: parts of the metric's variance
///
/// `noise` is the part of the variance that lies between the replicates of a point: what no parameter
/// explains.
/// @param sweep  the resource of a sweep with a design of one of these types
/// @param results  all its rows, in their order
/// @throws InvalidRequest ("/metric"); WrongState if the sweep has no such design
[[nodiscard]] ResultTable calc_sensitivity(const nlohmann::json& sweep, const ResultTable& results,
                                           const std::string& metric);

}  // namespace jobs
