// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/openapi/schema_parts.h"

namespace server::openapi {

/// The schemas of what is sent, by name: Parameters, SweepRequest and what stands in it. All values are those
/// of the parameter table.
[[nodiscard]] Json make_request_schemas();

}  // namespace server::openapi
