#pragma once

#include <span>
#include <string_view>

#include "server/openapi/schema_parts.h"

namespace server::openapi {

/// A key of a query string, as the document describes it.
struct QueryParameter {
  std::string_view name;
  std::string_view help;
  Json schema;
};

/// Those of all routes.
[[nodiscard]] std::span<const QueryParameter> query_parameters();

}  // namespace server::openapi
