// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/base/errors.h"

namespace jobs {

/// Faults that are collected before a reader of files gives up: a file may have millions.
inline constexpr std::size_t kMostFileFaults = 20;

inline constexpr const char* kNoGaps = "gaps (NaN, empty cells) are not allowed in this version";

/// Fault of the name of a measurement; empty if there is none.
[[nodiscard]] std::string describe_measurement_name_fault(const std::string& name);

/// Fault of the name of a channel: characters, length, unit. Empty if there is none.
[[nodiscard]] std::string describe_channel_name_fault(std::string_view name);

/// Text of a file, shortened between characters, without control characters.
[[nodiscard]] std::string shown_text(std::string_view text);
/// The same in quotes.
[[nodiscard]] std::string quoted_text(std::string_view text);

/// Fault of a time column whose name ends in a unit other than seconds. Empty if there is none.
[[nodiscard]] std::string describe_time_name_fault(std::string_view name);

/// Adds the faults of finite times: too few, not strictly increasing.
/// @param fault_at  makes the fault of one sample from its number, from 0, and its text
/// @param fault_of_all  fault of the column as a whole
void add_time_faults(std::span<const double> time_s,
                     const std::function<Fault(std::size_t, const std::string&)>& fault_at,
                     const Fault& fault_of_all, std::vector<Fault>& faults);

/// @throws InvalidRequest if there are faults
void throw_if_any(std::vector<Fault> faults);

/// Fault of a body as a whole.
[[noreturn]] void refuse_body(std::string detail);

/// @throws InvalidRequest if a measurement has more numbers than kMostMeasuredValues
void check_value_count(std::size_t values);

}  // namespace jobs
