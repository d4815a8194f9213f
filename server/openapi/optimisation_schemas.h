// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/openapi/schema_parts.h"

namespace server::openapi {

/// The schemas of what is asked and answered about optimisations, by name: OptimisationRequest, Optimisation,
/// OptimisationPage, CandidateRows and what stands in them.
[[nodiscard]] Json make_optimisation_schemas();

}  // namespace server::openapi
