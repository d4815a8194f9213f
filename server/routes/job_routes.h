// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/messages/message.h"
#include "server/routing/call.h"

namespace server {

Response post_job(const Call& call);
Response get_jobs(const Call& call);
Response get_job(const Call& call);
Response cancel_job(const Call& call);
Response get_trajectory(const Call& call);
Response get_parameters(const Call& call);

}  // namespace server
