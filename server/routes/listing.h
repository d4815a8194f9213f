// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <nlohmann/json.hpp>

#include "jobs/results/page_query.h"
#include "jobs/results/result_query.h"
#include "server/messages/message.h"
#include "server/messages/query.h"

namespace server {

/// The page of a listing that `?state=&limit=&cursor=&fields=` asks for.
/// @param list  the service's listing
/// @throws jobs::InvalidRequest with every fault of the query
[[nodiscard]] nlohmann::json list_page(const Request& request,
                                       const std::function<nlohmann::json(const jobs::PageQuery&)>& list);

/// The same for a listing of what has no state: `?limit=&cursor=&fields=`.
[[nodiscard]] nlohmann::json list_stateless_page(
    const Request& request, const std::function<nlohmann::json(const jobs::PageQuery&)>& list);

/// The rows and columns of a table of results that `?fields=&order_by=&limit=` and filters ask for.
/// @param query  which keeps its others
[[nodiscard]] jobs::ResultQuery read_result_query(Query& query);

}  // namespace server
