// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <nlohmann/json.hpp>

#include "server/context/route.h"

namespace server::openapi {

/// The OpenAPI 3.1 document of the service, made of the tables that the service works with: routes,
/// parameters, metrics, channels.
[[nodiscard]] nlohmann::ordered_json make_document(std::span<const Route> routes);

}  // namespace server::openapi
