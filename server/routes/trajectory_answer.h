// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "jobs/trajectories/trajectory_view.h"
#include "server/context/request_context.h"
#include "server/messages/query.h"
#include "server/routes/tables.h"

namespace server {

/// Finds columns; told by a function whether they need be read.
using FindColumns = std::function<std::optional<jobs::TrajectoryView>(
    const jobs::TrajectoryQuery&, const std::function<bool(const std::string& fingerprint)>&)>;

/// Reads `?channels=&from=&to=&points=`, which the query allows.
[[nodiscard]] jobs::TrajectoryQuery read_trajectory_query(Query& query);

/// Answer with columns that do not change: with an ETag, in pieces if they are long, 304 if the client has
/// them.
/// @param file_stem  of a download
/// @returns nothing if there are no such columns
/// @throws jobs::InvalidRequest with every fault of the query
[[nodiscard]] std::optional<Response> answer_with_columns(const RequestContext& context, Query& query,
                                                          const jobs::TrajectoryQuery& wanted,
                                                          TableFormat format, const std::string& file_stem,
                                                          const FindColumns& find);

}  // namespace server
