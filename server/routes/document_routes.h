// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/context/request_context.h"
#include "server/messages/message.h"

namespace server {

Response get_openapi(const RequestContext& context);  ///< the OpenAPI document
/// A file of the page to try the interface with, by its path. 404 if the program was built without it: its
/// parts come from npm.
Response get_docs(const RequestContext& context);

}  // namespace server
