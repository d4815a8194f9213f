// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/messages/message.h"
#include "server/routing/call.h"

namespace server {

Response post_sweep(const Call& call);
Response get_sweeps(const Call& call);
Response get_sweep(const Call& call);
Response delete_sweep(const Call& call);
Response get_results(const Call& call);
Response get_events(const Call& call);
Response cancel_sweep(const Call& call);
Response retry_sweep(const Call& call);
Response extend_sweep(const Call& call);
Response move_sweep(const Call& call);
Response get_executors(const Call& call);

}  // namespace server
