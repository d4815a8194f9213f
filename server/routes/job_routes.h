// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/context/request_context.h"
#include "server/messages/message.h"
#include "server/messages/problem.h"

namespace server {

Response post_job(const RequestContext& context);
Response post_assembly(const RequestContext& context);
Response get_jobs(const RequestContext& context);
Response get_job(const RequestContext& context);
Response cancel_job(const RequestContext& context);
Response delete_job(const RequestContext& context);
Response get_trajectory(const RequestContext& context);
Response get_parameters(const RequestContext& context);

/// Error for the job of the path, which is not there or has no trajectory.
[[nodiscard]] HttpError no_trajectory(const RequestContext& context);

}  // namespace server
