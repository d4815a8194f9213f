// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include <nlohmann/json.hpp>

#include "jobs/measurements/measurement.h"

namespace jobs {

inline constexpr std::array<std::string_view, 3> kMeasurementKeys{"name", "channels", "runs"};
inline constexpr std::array<std::string_view, 7> kMeasuredChannelKeys{
    "name", "column", "sign", "gain", "offset", "delay_s", "low_pass_hz"};
inline constexpr std::array<std::string_view, 3> kMeasuredRunKeys{"parameters", "time_s", "values"};

/// Measurement from the JSON of a request.
/// @throws InvalidRequest with the faults; pointers lead into the request
[[nodiscard]] Measurement read_measurement_json(const nlohmann::ordered_json& request);

}  // namespace jobs
