// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/openapi/schema_parts.h"

namespace server::openapi {

/// The schemas of what is asked and answered about wear studies, by name: WearStudyRequest, WearStudy,
/// WearStudyPage, WearCycleRows and what stands in them.
[[nodiscard]] Json make_wear_schemas();

}  // namespace server::openapi
