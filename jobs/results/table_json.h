// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "engine/analysis/quantities.h"
#include "jobs/results/result_table.h"

namespace jobs {

/// A JSON array of flat objects, one a row; every object has every column. Where sets have replicates each
/// has, after the metrics, replicates_count, _mean, _spread, _min and _max of its set.
[[nodiscard]] std::string to_json_rows(const ResultTable& table);

/// The same objects, each on a line of its own and nothing between them: NDJSON.
[[nodiscard]] std::string to_json_lines(const ResultTable& table);

/// {"channels": [key, ...], "columns": {key: [number, ...], ...}}; null for what is not finite.
[[nodiscard]] std::string to_json_columns(const engine::Trajectory& trajectory);

/// Appends the beginning of those columns, up to the first one.
void append_json_channels(std::string& text, const std::vector<engine::QuantityInfo>& channels);

/// Appends a number as JSON that reads back exactly; null for what is not finite.
void append_json_number(std::string& text, double value);

}  // namespace jobs
