// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/openapi/schema_parts.h"

namespace server::openapi {

/// The schemas of what is answered, by name: Sweep, Job, their pages, ResultRows, Trajectory, Problem and
/// what stands in them.
[[nodiscard]] Json make_resource_schemas();

}  // namespace server::openapi
