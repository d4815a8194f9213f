// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/openapi/schema_parts.h"

namespace server::openapi {

/// The schemas of what is asked and answered about fits, by name: FitRequest, Fit, FitPage,
/// FitPointRows, FitSignalRows and what stands in them.
[[nodiscard]] Json make_fit_schemas();

}  // namespace server::openapi
