// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "jobs/measurements/measurement.h"

namespace jobs {

/// Description of a measurement, which the store keeps beside the samples and the resource shows:
///
///     {"samples", "duration_s",
///      "channels": [{"name", "unit", "column", "sign", "gain", "offset", "delay_s", "low_pass_hz"}, ...],
///      "runs": [{"parameters", "samples", "start_s", "end_s",
///                "sampling": {"rate_hz", "least_step_s", "largest_step_s"},
///                "statistics": [{"channel", "min", "max", "rms"}, ...]}, ...]}
///
/// The statistics are those of the samples as they were sent, without correction. rate_hz is the mean one.
[[nodiscard]] nlohmann::json measurement_json(const Measurement& measurement);

/// The same read back: a measurement without name and samples.
[[nodiscard]] Measurement measurement_of(const nlohmann::json& description);

}  // namespace jobs
