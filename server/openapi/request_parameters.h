// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "server/openapi/schema_parts.h"

namespace server::openapi {

/// A key of a query string or a header of a request, as the document describes it.
struct RequestParameter {
  std::string_view id;  ///< name in the routes; some keys mean one thing here and another there
  std::string_view in;  ///< "query" or "header"
  std::string_view name;
  std::string_view help;
  Json schema;
};

/// Parameters of all routes.
[[nodiscard]] std::span<const RequestParameter> request_parameters();

}  // namespace server::openapi
