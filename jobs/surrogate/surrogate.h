// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "jobs/results/result_table.h"

namespace jobs {

/// A part of the surrogate that is to be drawn.
struct SurrogateQuery {
  std::string metric;
  std::string x, y;  ///< inputs; empty: the first, and the second if there is one
};

/// A surrogate of a metric over the numbers that a sweep varies (its inputs), for each combination of what
/// else it varies, and its values on a grid over two of the inputs, the others in the middle of their ranges.
/// With it goes every point that it stands on, and the error of cross-validation. The response at a point is
/// the mean over its replicates.
///
///     {"metric", "x", "y", "inputs": [{"parameter", "from", "to", "scale", "middle"}],
///      "surfaces": [{"where": {...}, "points", "degree", "terms", "cross_validation_error",
///                    "predicted_part", "x_values", "y_values", "values": [[...]],
///                    "at": [{parameter: value, ..., "value", "left_out_prediction"}]}]}
///
/// `degree` and what follows from it are null where there are fewer than 6 points with values.
/// @throws InvalidRequest ("/metric", "/x", "/y"); WrongState if the sweep varies no numbers, or more than 8
[[nodiscard]] nlohmann::json make_surrogate(const nlohmann::json& sweep, const ResultTable& results,
                                            const SurrogateQuery& query);

}  // namespace jobs
