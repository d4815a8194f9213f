#pragma once

#include <nlohmann/json.hpp>

namespace server::openapi {

/// The OpenAPI 3.1 document of the service, made of the tables that the service works with: routes, parameters, metrics, channels.
[[nodiscard]] nlohmann::ordered_json make_document();

}  // namespace server::openapi
