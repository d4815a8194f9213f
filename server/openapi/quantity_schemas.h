// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "engine/analysis/quantities.h"
#include "server/openapi/schema_parts.h"

namespace server::openapi {

/// Unit of a metric or channel, by the end of its name: "m/s²" of slider_acceleration_m_s2, "1" of a pure
/// number.
[[nodiscard]] std::string_view unit_of(std::string_view key);

/// Makes the schema of a quantity's values.
using ValueSchema = std::function<Json(const engine::QuantityInfo&)>;

/// Metrics of the RPSUP linkage as properties of a schema, each with its definition, unit (x-unit) and the
/// paper's symbol (x-symbol).
[[nodiscard]] Json metric_properties(const ValueSchema& value);

/// Channels of the RPSUP linkage, likewise.
[[nodiscard]] Json channel_properties(const ValueSchema& value);

/// Metrics of described linkages as patternProperties, likewise. x-name is the name with placeholders for the
/// names of bodies, joints, coordinates and springs: "peak_{joint}_reaction_n".
[[nodiscard]] Json linkage_metric_patterns(const ValueSchema& value);

/// Channels of described linkages, likewise.
[[nodiscard]] Json linkage_channel_patterns(const ValueSchema& value);

}  // namespace server::openapi
