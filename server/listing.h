#pragma once

#include "jobs/service.h"
#include "server/message.h"

namespace server {

/// Reads `?state=&limit=&cursor=&fields=` of a listing.
/// @throws jobs::InvalidRequest with every fault of the query's form; what the values mean is checked by the service.
[[nodiscard]] jobs::PageQuery read_page_query(const Request& request);

}  // namespace server
