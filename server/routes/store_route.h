// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "server/context/request_context.h"
#include "server/messages/message.h"

namespace server {

/// Removes the files that a process left when it died; their names are this service's own. Nobody may be
/// making any.
void remove_left_over_files(const std::filesystem::path& store);

/// Consistent copy of the whole store, as an SQLite file.
Response get_store(const RequestContext& context);
/// Results and trajectories of a sweep, as one file.
Response get_trajectories(const RequestContext& context);

}  // namespace server
