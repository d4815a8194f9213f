#pragma once

#include <functional>

#include <nlohmann/json.hpp>

#include "jobs/service.h"
#include "server/message.h"

namespace server {

/// The page of a listing that `?state=&limit=&cursor=&fields=` asks for.
/// @param list  the service's listing
/// @throws jobs::InvalidRequest with every fault of the query
[[nodiscard]] nlohmann::json list_page(const Request& request, const std::function<nlohmann::json(const jobs::PageQuery&)>& list);

}  // namespace server
