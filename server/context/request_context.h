// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "jobs/service.h"
#include "server/context/long_poll_limit.h"
#include "server/context/metrics.h"
#include "server/context/store_copy_limit.h"
#include "server/context/work_limit.h"
#include "server/messages/message.h"

namespace server {

/// Context in which a route's handler answers one request.
struct RequestContext {
  jobs::Service& service;
  const Request& request;
  std::string id;  ///< segment of the path in the place of {id} in the route's pattern
  bool draining;
  const Metrics& metrics;
  LongPollLimit& long_poll_limit;
  StoreCopyLimit& store_copy_limit;
  WorkLimit& stream_limit;  ///< of long trajectories that are being sent
  WorkLimit& export_limit;  ///< of files with the trajectories of a sweep, until they have been sent
  WorkPermit& permit;       ///< of this request, if it may take much memory
};

}  // namespace server
