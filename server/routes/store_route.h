// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "server/context/request_context.h"
#include "server/messages/message.h"

namespace server {

/// Removes the copy that a process left when it died; its name is this service's own. Nobody may be copying.
void remove_left_over_copy(const std::filesystem::path& store);

Response get_store(
    const RequestContext& context);  ///< a consistent copy of the whole store, as an SQLite file

}  // namespace server
