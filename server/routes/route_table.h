// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "server/context/route.h"

namespace server {

/// All routes.
[[nodiscard]] std::span<const Route> route_table();

}  // namespace server
