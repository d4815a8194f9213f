// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/openapi/schema_parts.h"

namespace server::openapi {

/// The schemas of what is worked out of results, by name: SensitivityRows, Surrogate, FlexibilityRows,
/// BifurcationRows, LyapunovRows, Columns, WearRows.
[[nodiscard]] Json make_analysis_schemas();

}  // namespace server::openapi
