// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/openapi/schema_parts.h"

namespace server::openapi {

/// The schemas of what is answered about searches, by name: Search, SearchPage, LimitRows and what stands in
/// them.
[[nodiscard]] Json make_search_schemas();

}  // namespace server::openapi
