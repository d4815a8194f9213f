#pragma once

#include "server/message.h"
#include "server/routes.h"

namespace server {

Response get_page_file(const Call& call);  ///< a file of the page, by its path; it is part of the program
Response get_health(const Call& call);     ///< 200 as long as the program answers at all
Response get_readiness(const Call& call);  ///< 200 if requests can be served: the store reads, and the service is not ending
Response get_metrics(const Call& call);    ///< what Metrics has counted, for Prometheus

}  // namespace server
