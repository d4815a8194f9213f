// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/openapi/schema_parts.h"

namespace server::openapi {

/// The schemas of what is asked and answered about measurements, by name: MeasurementRequest, Measurement,
/// MeasurementPage and what stands in them.
[[nodiscard]] Json make_measurement_schemas();

}  // namespace server::openapi
