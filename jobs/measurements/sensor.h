// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "jobs/base/errors.h"
#include "jobs/measurements/measurement.h"

namespace jobs {

/// Keys of the correction of a sensor.
inline constexpr std::array<std::string_view, 5> kSensorKeys{"sign", "gain", "offset", "delay_s",
                                                             "low_pass_hz"};

/// Adds a fault for each key that is not known.
void check_measured_keys(const nlohmann::ordered_json& object, const std::string& pointer,
                         std::span<const std::string_view> known, std::vector<Fault>& faults);

/// Reads kSensorKeys into a channel, and adds their faults.
void read_sensor(const nlohmann::ordered_json& given, const std::string& pointer, MeasuredChannel& channel,
                 std::vector<Fault>& faults);

/// Adds the faults of what is known of a run's parameters. @returns them
[[nodiscard]] nlohmann::json read_run_parameters(const nlohmann::ordered_json& given,
                                                 const std::string& pointer, std::vector<Fault>& faults);

}  // namespace jobs
