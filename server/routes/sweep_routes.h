// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/context/request_context.h"
#include "server/messages/message.h"

namespace server {

Response post_sweep(const RequestContext& context);
Response get_sweeps(const RequestContext& context);
Response get_sweep(const RequestContext& context);
Response describe_sweep(const RequestContext& context);
Response delete_sweep(const RequestContext& context);
Response get_results(const RequestContext& context);
Response get_events(const RequestContext& context);
Response cancel_sweep(const RequestContext& context);
Response retry_sweep(const RequestContext& context);
Response extend_sweep(const RequestContext& context);
Response move_sweep(const RequestContext& context);
Response get_executors(const RequestContext& context);

}  // namespace server
