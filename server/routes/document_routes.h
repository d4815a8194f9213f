// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/messages/message.h"
#include "server/routing/call.h"

namespace server {

Response get_openapi(const Call& call);  ///< the OpenAPI document
/// A file of the page to try the interface with, by its path. 404 if the program was built without it: its parts come from npm.
Response get_docs(const Call& call);

}  // namespace server
