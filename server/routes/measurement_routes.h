// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/context/request_context.h"
#include "server/messages/message.h"

namespace server {

Response post_measurement(const RequestContext& context);
Response get_measurements(const RequestContext& context);
Response get_measurement(const RequestContext& context);
Response get_measurement_data(const RequestContext& context);
Response delete_measurement(const RequestContext& context);

}  // namespace server
