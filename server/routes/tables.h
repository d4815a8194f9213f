// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "jobs/results/result_table.h"
#include "server/messages/formats.h"
#include "server/messages/message.h"
#include "server/messages/query.h"

namespace server {

/// The format that a request for rows asks for: `?format=csv|json|ndjson` first, then the Accept header, then
/// JSON.
/// @param query  one that allows the key `format`; a wrong word is a fault of it
[[nodiscard]] TableFormat find_row_format(const Request& request, Query& query);
/// The same for a trajectory: `?format=csv|json|npz`.
[[nodiscard]] TableFormat find_column_format(const Request& request, Query& query);
/// The same for the trajectories of a sweep: `?format=h5|mat|npz`, else HDF5.
[[nodiscard]] TableFormat find_trajectories_format(const Request& request, Query& query);

/// A JSON array of flat objects, one a row; every object has every column. Where sets have replicates each
/// has, after the metrics, replicates_count, _mean, _spread, _min and _max of its set.
[[nodiscard]] std::string to_json_rows(const jobs::ResultTable& table);

/// The same objects, each on a line of its own and nothing between them: NDJSON.
[[nodiscard]] std::string to_json_lines(const jobs::ResultTable& table);

/// A table as text in one of the formats of rows.
[[nodiscard]] std::string to_text(const jobs::ResultTable& table, TableFormat format);

/// A table as an answer: JSON as text, CSV and NumPy's format as a download with a name.
/// @param file_stem  of the download; letters, digits, '-' and '_'
[[nodiscard]] Response make_table(TableFormat format, std::string text, const std::string& file_stem);

}  // namespace server
